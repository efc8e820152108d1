// What `neritic sonar` notes about images that give a poor or silent picture, and what it refuses.
#include "tools/neritic/sonar_notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sonar/offline_input.hpp"

namespace neritic {
namespace {

using ::testing::HasSubstr;
using tools::Coverage;

// A wall across the view, 90 degrees wide and high, planar depth in metres.
sonar::SonarInput wall(double depth_m, std::uint32_t side = 100) {
  sonar::SonarInput in;
  in.width = in.height = side;
  in.intrinsics = {side / 2.0, side / 2.0, side / 2.0, side / 2.0};
  in.depth.assign(std::size_t{side} * side, depth_m);
  return in;
}

std::string note_of(const sonar::BeamGrid& grid, const sonar::SonarInput& in,
                    bool published = true) {
  return tools::coverage_note(grid, tools::coverage_of(grid, in), published).value_or("");
}

TEST(SonarNotes, CoverageCountsThePixelsOfTheWedge) {
  sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {10, 20, 10});
  const Coverage all = tools::coverage_of(grid, wall(2.0));
  // 90 degrees of azimuth are the whole width; asin(y / r) = 14 degrees bends upwards at the sides,
  // from 2 tan 14 degrees of the width in the middle to 2 sqrt 2 tan 14 degrees at the edges.
  EXPECT_GT(all.in_aperture, 100u * 24u);
  EXPECT_LT(all.in_aperture, 100u * 36u);
  EXPECT_EQ(all.in_wedge, all.in_aperture);
  EXPECT_DOUBLE_EQ(all.pixels_per_cell, static_cast<double>(all.in_aperture) / 200.0);
  EXPECT_NEAR(all.nearest_m, 2.0, 1e-3);
  EXPECT_NEAR(all.farthest_m, 2.0 * std::sqrt(3.0), 0.05);
  EXPECT_EQ(note_of(grid, wall(2.0)), "");
}

TEST(SonarNotes, AWallOutOfRangeIsToldWithTheRangesOfTheImage) {
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {10, 20, 10});
  EXPECT_THAT(note_of(grid, wall(2000.0)), HasSubstr("between 1 and 5 m"));
  EXPECT_THAT(note_of(grid, wall(2000.0)), HasSubstr("2e+03"));
}

TEST(SonarNotes, AnEmptyImageIsTold) {
  const sonar::BeamGrid grid;
  EXPECT_THAT(note_of(grid, wall(0.0)), HasSubstr("no pixel has a depth"));
}

TEST(SonarNotes, AWedgeWiderThanTheImageIsToldWithWhatTheImageCovers) {
  const sonar::BeamGrid wide =
      sonar::symmetric_grid(1.0, 5.0, radians(130.0), radians(20.0), {10, 20, 10});
  const std::string note = note_of(wide, wall(2.0), false);
  // 90 of 130 degrees across; upwards all of it, but that edges bend.
  EXPECT_THAT(note, HasSubstr("the images cover 69 % of the wedge of 130 x 20 degrees"));
  EXPECT_THAT(note, HasSubstr("they look -45 to 45 degrees across and -45 to 45 upwards"));
  // As much as the image covers is no note, nor are the corners of a cone.
  const sonar::BeamGrid cone =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(70.0), {10, 20, 10});
  EXPECT_EQ(note_of(cone, wall(2.0), false), "");
  // An image that looks elsewhere than ahead covers less.
  sonar::SonarInput aside = wall(2.0);
  aside.intrinsics.cx = 0.0;
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(20.0), {10, 20, 10});
  EXPECT_THAT(note_of(grid, aside, false), HasSubstr("cover 50 %"));
}

TEST(SonarNotes, ASwathThinnerThanAPixelIsSilentForThePublishedGatherOnly) {
  const sonar::BeamGrid thin =
      sonar::symmetric_grid(1.0, 5.0, radians(80.0), radians(0.5), {10, 20, 2});
  EXPECT_THAT(note_of(thin, wall(2.0)), HasSubstr("hears nothing"));
  EXPECT_EQ(note_of(thin, wall(2.0), false), "");
  sonar::BeamGrid above = thin;
  above.limits.elevation_min_rad = radians(60.0);
  above.limits.elevation_max_rad = radians(60.5);
  EXPECT_THAT(note_of(above, wall(2.0), false), HasSubstr("hears nothing"));
}

TEST(SonarNotes, FewPixelsACellAreToldForThePublishedGatherOnly) {
  const sonar::BeamGrid grid;  // 500 x 500 cells
  EXPECT_THAT(note_of(grid, wall(2.0)), HasSubstr("--gather plane"));
  EXPECT_EQ(note_of(grid, wall(2.0), false), "");
}

sonar::MapFile depth_map(std::uint32_t channels, std::vector<double> values,
                         std::vector<std::string> names = {}) {
  sonar::MapFile map;
  map.path = "depth.png";
  map.width = 2;
  map.height = 1;
  map.channels = channels;
  map.values = std::move(values);
  map.channel_names = std::move(names);
  return map;
}

Result<sonar::SonarInput> input_of(const sonar::MapFile& depth) {
  return sonar::make_input(depth, nullptr, nullptr, {1.0, 1.0, 1.0, 0.5}, {});
}

TEST(OfflineInput, AColourPictureIsRefusedAsDepth) {
  const auto made = input_of(depth_map(3, {1, 2, 3, 4, 5, 6}));
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("depth.png: 3 channels that differ"));
  EXPECT_FALSE(input_of(depth_map(2, {1, 2, 3, 4})).ok());
}

TEST(OfflineInput, GreyKeptAsColourAndNamedChannelsAreDepth) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(input_of(depth_map(4, {3, 3, 3, 1, 4, 4, 4, 1}))->depth, (std::vector<double>{3, 4}));
  EXPECT_TRUE(input_of(depth_map(3, {3, 3, 3, nan, nan, nan})).ok());
  const auto named = input_of(depth_map(3, {1, 2, 7, 3, 4, 8}, {"A", "B", "Z"}));
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named->depth, (std::vector<double>{7, 8}));
}

}  // namespace
}  // namespace neritic
