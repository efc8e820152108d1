// Panels stay within the window and off each other at any size of it.
#include "testbed/view/panel_layout.hpp"

#include <gtest/gtest.h>

namespace neritic::testbed {
namespace {

std::vector<PanelRect> all_of(const PanelLayout& layout) {
  std::vector<PanelRect> out{layout.status, layout.readout, layout.hint};
  out.insert(out.end(), layout.fans.begin(), layout.fans.end());
  out.insert(out.end(), layout.extras.begin(), layout.extras.end());
  return out;
}

void expect_apart_and_inside(const PanelLayout& layout, float width, float height) {
  const auto rects = all_of(layout);
  for (std::size_t i = 0; i < rects.size(); ++i) {
    const PanelRect& a = rects[i];
    if (a.empty()) continue;
    EXPECT_GE(a.x, 0.0f) << i << " at " << width << " x " << height;
    EXPECT_GE(a.y, 0.0f) << i << " at " << width << " x " << height;
    EXPECT_LE(a.right(), width) << i << " at " << width << " x " << height;
    EXPECT_LE(a.bottom(), height) << i << " at " << width << " x " << height;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(overlap(a, rects[j])) << i << " on " << j << " at " << width << " x " << height;
  }
}

// Fans of 90 and 130 degrees, of an acoustic camera, and a row of eight.
const std::vector<std::vector<float>> kFans{
    {}, {0.68f}, {0.68f, 0.55f, 2.0f}, {0.68f, 0.55f, 2.0f, 0.68f, 0.55f, 0.7f, 0.6f, 0.5f}};

// Gauges, a plot, a map, an inset.
const std::vector<PanelWish> kWishes{{170, 110}, {200, 150}, {300, 200}, {213, 213}};

TEST(PanelLayout, NoPanelLeavesTheWindowOrCoversAnother) {
  for (const auto& fans : kFans)
    for (float width = 160; width <= 3840; width += 92)
      for (float height = 90; height <= 2160; height += 61)
        for (const float status : {90.0f, 240.0f, 1500.0f})
          for (std::size_t wishes = 0; wishes <= kWishes.size(); ++wishes)
            expect_apart_and_inside(
                lay_out(width, height, status, fans, std::span(kWishes).first(wishes)), width,
                height);
}

TEST(PanelLayout, FromTheSmallestWindowOnAllHavePlacesAndWideOnesShowEverySonar) {
  for (const auto& fans : kFans)
    for (const auto& [width, height] : {std::pair(640.0f, 480.0f),
                                        {800, 600},
                                        {1280, 720},
                                        {1920, 1080},
                                        {2560, 1080},
                                        {3840, 2160}}) {
      const PanelLayout layout = lay_out(width, height, 200.0f, fans);
      for (const PanelRect& rect : {layout.status, layout.readout, layout.hint})
        EXPECT_FALSE(rect.empty()) << width;
      EXPECT_GE(layout.status.height, 200.0f) << width;
      const std::size_t least = width < 1280 ? 1 : 3;
      EXPECT_GE(layout.fans.size(), std::min(least, fans.size())) << width;
      // A diver looks at the middle of the picture.
      const PanelRect middle{0.4f * width, 0.4f * height, 0.1f * width, 0.2f * height};
      for (const PanelRect& rect : all_of(layout))
        EXPECT_FALSE(width >= 1280 && overlap(rect, middle)) << width;
    }
}

TEST(PanelLayout, ADiversInstrumentKeepsItsCorner) {
  for (const auto& fans : kFans)
    for (const auto& [width, height] : {std::pair(640.0f, 480.0f), {1280, 720}, {1920, 1080}}) {
      const TakenCorner taken{height - 235.0f, 307.0f};
      const PanelLayout layout = lay_out(width, height, 200.0f, fans, kWishes, taken);
      const PanelRect corner{width - taken.width, taken.top, taken.width, height - taken.top};
      for (const PanelRect& rect : all_of(layout)) EXPECT_FALSE(overlap(rect, corner)) << width;
      EXPECT_GT(layout.readout.width, 250.0f) << width;
    }
}

TEST(PanelLayout, PanelsOnDemandComeBeforeFansAndFitTheSmallestWindowByOne) {
  for (const auto& wish : kWishes) {
    const PanelLayout layout = lay_out(640, 480, 130, kFans[2], std::span(&wish, 1));
    ASSERT_EQ(layout.extras.size(), 1u);
    EXPECT_GE(layout.extras[0].height, wish.least);
    EXPECT_LE(layout.extras[0].height, wish.wanted);
  }
  const PanelLayout wide = lay_out(1920, 1080, 200, kFans[1], kWishes);
  for (std::size_t i = 0; i < kWishes.size(); ++i)
    EXPECT_EQ(wide.extras[i].height, kWishes[i].wanted) << i;
  EXPECT_EQ(wide.fans.size(), 1u);
}

}  // namespace
}  // namespace neritic::testbed
