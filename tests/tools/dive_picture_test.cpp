// The data of the picture of a dive: what endangers a diver is in it however short it was, and the
// picture shows it.
#include "tools/neritic/dive_picture.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "engine/scene/image_file.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tools/common/picture.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

// A log of this many rows, one a second; the diver rises by 1 cm a row.
std::vector<HumanRow> slow_rise(std::size_t count) {
  std::vector<HumanRow> rows(count);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = static_cast<double>(i);
    rows[i].world_from_body.position_m.y = -20.0 + 0.01 * static_cast<double>(i % 1000);
  }
  return rows;
}

PlotRows plotted(const PhysicsWorld& world, const std::vector<HumanRow>& rows) {
  PlotRows out(world);
  for (const HumanRow& row : rows) out.add({{}, {row}});
  return out;
}

TestDive one_diver() {
  return dive_of(std::string(kStillWater) + diver_text("position_m = [0, -12, 0]\n"));
}

TEST(DivePicture, AnAlarmOfOneRowOutlivesTheThinning) {
  const TestDive dive = one_diver();
  std::vector<HumanRow> rows = slow_rise(20001);
  rows[7777].ascent.view.alarm = diver::AscentAlarm::kDangerous;
  const nlohmann::json data =
      dive_picture_data("long", *dive.world, plotted(*dive.world, rows), {HumanFigures()});
  const auto& diver = data["humans"][0];
  const auto times = diver["time_s"].get<std::vector<double>>();
  EXPECT_LT(times.size(), 2000u);
  EXPECT_GT(times.size(), 800u);
  EXPECT_EQ(times.back(), 20000.0);
  const auto alarms = diver["ascent_alarm"].get<std::vector<int>>();
  ASSERT_EQ(alarms.size(), times.size());
  const auto alarm = std::ranges::find(alarms, 2);
  ASSERT_NE(alarm, alarms.end());
  EXPECT_EQ(times[static_cast<std::size_t>(alarm - alarms.begin())], 7777.0);
  EXPECT_EQ(std::ranges::count(alarms, 2), 1);  // it ends in the next row
}

TEST(DivePicture, EachDiverHasItsOwnRows) {
  const TestDive dive =
      dive_of(std::string(kStillWater) + diver_text("position_m = [0, -12, 0]\n") +
              std::regex_replace(diver_text("position_m = [5, -12, 0]\n"),
                                 std::regex("\"diver\"\nclass"), "\"buddy\"\nclass"));
  std::vector<HumanRow> rows = slow_rise(100);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].human = i % 2;
  const nlohmann::json data = dive_picture_data("two", *dive.world, plotted(*dive.world, rows),
                                                {HumanFigures(), HumanFigures()});
  ASSERT_EQ(data["humans"].size(), 2u);
  EXPECT_EQ(data["humans"][1]["name"], "buddy");
  for (std::size_t human : {0u, 1u}) {
    const auto times = data["humans"][human]["time_s"].get<std::vector<double>>();
    ASSERT_EQ(times.size(), 50u);
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_EQ(times[i], static_cast<double>(2 * i + human));
  }
}

// Pixels of the red of a rise that is dangerously fast.
std::size_t red_pixels(const PhysicsWorld& world, const std::vector<HumanRow>& rows) {
  const test::ScratchFolder folder;
  const auto drawn = write_picture(
      folder / "dive.png", dive_picture_data("", world, plotted(world, rows), {HumanFigures()}));
  EXPECT_TRUE(drawn.ok() && *drawn);
  const ImageU8 image = scene::read_image8(folder / "dive.png", 3).value();
  constexpr std::uint8_t kRed[] = {0xc0, 0x1a, 0x1a};
  std::size_t red = 0;
  for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i)
    red += std::equal(kRed, kRed + 3, image.data.data() + 3 * i) ? 1 : 0;
  return red;
}

TEST(DivePicture, AFastRiseIsRed) {
  const TestDive dive = one_diver();
  std::vector<HumanRow> rows = slow_rise(600);
  const std::size_t without = red_pixels(*dive.world, rows);
  for (std::size_t i = 100; i <= 200; ++i)
    rows[i].ascent.view.alarm = diver::AscentAlarm::kDangerous;
  EXPECT_GT(red_pixels(*dive.world, rows), without + 1000);
}

}  // namespace
}  // namespace neritic::tools
