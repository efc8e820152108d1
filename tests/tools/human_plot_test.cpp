// The plot of a diver's dive: what endangers is marked where it did, and is not where it did not.
#include "tools/common/human_plot.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "engine/scene/image_file.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tools/common/dive_plot.hpp"

namespace neritic::tools {
namespace {

constexpr std::uint32_t kWide_px = 1600;
// Of the dots of a rise that is dangerously fast.
constexpr std::uint8_t kRed[] = {204, 0, 26};

// Columns of the first panel, the depth's, that hold pixels of the alarm's colour, its legend at
// the right edge left out.
std::vector<std::uint32_t> red_columns(const PhysicsWorld& world,
                                       const std::vector<HumanRow>& rows) {
  sonar::Canvas canvas(kWide_px, static_cast<std::uint32_t>(kHumanPanels_px), kPaper);
  draw_human_panels(canvas, kWide_px, 0.0, world.humans()[0], 0, rows);
  const ImageU8 image = canvas.take();
  std::vector<std::uint32_t> columns;
  for (std::uint32_t x = 0; x < 560; ++x)
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(kHumanPanel_px); ++y) {
      const std::uint8_t* p = image.data.data() + 3 * (std::size_t{y} * image.width + x);
      if (std::equal(p, p + 3, kRed, [](int a, int b) { return std::abs(a - b) <= 1; })) {
        columns.push_back(x);
        break;
      }
    }
  return columns;
}

TEST(HumanPlot, DangersAreMarkedWhereTheyWere) {
  const TestDive dive =
      dive_of(std::string(kStillWater) + diver_text("position_m = [0, -12, 0]\n"));
  std::vector<HumanRow> rows(601);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = static_cast<double>(i);
    rows[i].world_from_body.position_m.y = -20.0 + 0.01 * static_cast<double>(i);
  }
  EXPECT_TRUE(red_columns(*dive.world, rows).empty());
  for (std::size_t i = 100; i <= 200; ++i)
    rows[i].ascent.view.alarm = diver::AscentAlarm::kDangerous;
  const std::vector<std::uint32_t> red = red_columns(*dive.world, rows);
  ASSERT_FALSE(red.empty());
  // Time runs over the box's inside with 7.5 % of room at either side.
  const Box in = inside({10.0, 0.0, 0.5 * kWide_px, kHumanPanel_px - 10.0});
  const auto column = [&](double time_s) {
    return place({"", 300.0 - 345.0, 300.0 + 345.0}, time_s, in.left, in.right);
  };
  EXPECT_NEAR(red.front(), column(100.0), 6.0);
  EXPECT_NEAR(red.back(), column(200.0), 6.0);
}

// Each diver has panels, with dangers of each; none of tanks where there are none.
TEST(HumanPlot, EachDiverHasPanels) {
  const TestDive dive =
      dive_of(std::string(kStillWater) + diver_text("position_m = [0, -12, 0]\n") +
              std::regex_replace(diver_text("position_m = [5, -12, 0]\n"),
                                 std::regex("\"diver\"\nclass"), "\"buddy\"\nclass"));
  ASSERT_EQ(dive.world->humans().size(), 2u);
  std::vector<HumanRow> rows(100);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = static_cast<double>(i / 2);
    rows[i].human = i % 2;
    rows[i].world_from_body.position_m.y = -20.0;
    if (rows[i].human == 1) rows[i].ascent.view.alarm = diver::AscentAlarm::kDangerous;
  }
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_dive_plot(folder / "two.png", *dive.world, {}, rows).ok());
  const ImageU8 image = scene::read_image8(folder / "two.png").value();
  const auto half = [&](std::size_t human) {
    std::size_t red = 0;
    const auto top =
        image.height - static_cast<std::uint32_t>((2.0 - double(human)) * kHumanPanels_px);
    for (std::size_t i = std::size_t{top} * image.width;
         i < (top + static_cast<std::size_t>(kHumanPanels_px)) * image.width; ++i)
      red += std::equal(kRed, kRed + 3, image.data.data() + 3 * i) ? 1 : 0;
    return red;
  };
  EXPECT_EQ(half(0), 0u);
  EXPECT_GT(half(1), 100u);
}

}  // namespace
}  // namespace neritic::tools
