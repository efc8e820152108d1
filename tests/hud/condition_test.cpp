// The diver's condition on the operator's console: there alone, where the scene models it, and over
// nothing else that the console shows.
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/hud/dives.hpp"
#include "tests/support/support.hpp"

namespace neritic::hud {
namespace {

DiveData slowed_dive() {
  DiveData d = calm_dive();
  d.saturation = 0.79;
  d.co2_mmhg = 44.0;
  d.narcotic_depth_m = 38.2;
  d.core_c = 36.4;
  d.slowing = 1.31;
  d.strength = 0.86;
  return d;
}

Shown shown(LayoutKind layout, const DiveData& data, Units units = Units::kMetric) {
  return shown_of(layout, units, data, {}, {}, {}, data.time_s);
}

ImageU8 picture(const DiveData& data) {
  Hud hud(LayoutKind::kConsole, Units::kMetric, 720);
  hud.update(data, data.time_s);
  return hud.picture();
}

TEST(HudCondition, TheDiversOwnInstrumentsDoNotShowIt) {
  for (const LayoutKind kind : {LayoutKind::kWrist, LayoutKind::kMask, LayoutKind::kCorner})
    EXPECT_EQ(shown(kind, slowed_dive()), shown(kind, calm_dive()));
  EXPECT_TRUE(shown(LayoutKind::kConsole, slowed_dive()).condition.known);
  EXPECT_FALSE(shown(LayoutKind::kConsole, calm_dive()).condition.known);
}

TEST(HudCondition, NumbersOfEffectsThatAreNotModelledAreDashes) {
  const ShownCondition c = shown(LayoutKind::kConsole, slowed_dive()).condition;
  EXPECT_EQ(c.saturation.view(), "79");
  EXPECT_EQ(c.oxygen.view(), "--");  // no dose in this dive
  EXPECT_EQ(c.slowing.view(), "1.31");
  EXPECT_EQ(c.core.view(), "36.4");
  EXPECT_EQ(shown(LayoutKind::kConsole, slowed_dive(), Units::kImperial).condition.core.view(),
            "97.5");
  // Saturation, narcosis, slowing, strength; neither CO2 nor the core yet.
  EXPECT_EQ(c.cautions, 0b1100101);
}

TEST(HudCondition, ItsPlateCoversNothingElse) {
  const ImageU8 without = picture(calm_dive()), with = picture(slowed_dive());
  DiveData lost = slowed_dive();
  lost.unconscious = true;
  const ImageU8 rescue = picture(lost);
  ASSERT_EQ(without.width, 1280u);
  std::size_t outside = 0, inside = 0, told = 0;
  for (std::size_t y = 0; y < without.height; ++y)
    for (std::size_t x = 0; x < without.width; ++x) {
      const std::size_t at = 4 * (y * without.width + x);
      const auto differs = [&](const ImageU8& a, const ImageU8& b) {
        return !std::equal(&a.data[at], &a.data[at] + 4, &b.data[at]);
      };
      const bool in_plate = x >= 332 && x < 948 && y >= 462 && y < 552;
      // There was nothing before.
      if (in_plate) {
        EXPECT_EQ(without.data[at + 3], 0) << x << " " << y;
      }
      (in_plate ? inside : outside) += differs(without, with);
      told += in_plate && differs(with, rescue);
    }
  EXPECT_EQ(outside, 0u);
  EXPECT_GT(inside, 50000u);
  EXPECT_GT(told, 3000u);
  if (const char* folder = std::getenv("NERITIC_CONDITION_PICTURES")) {
    ASSERT_TRUE(
        scene::write_png8(std::filesystem::path(folder) / "slowed.png", straight_alpha(with)).ok());
    ASSERT_TRUE(
        scene::write_png8(std::filesystem::path(folder) / "lost.png", straight_alpha(rescue)).ok());
  }
}

}  // namespace
}  // namespace neritic::hud
