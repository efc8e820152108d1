// Notes of `neritic sonar` about images that give a poor or silent picture, and its refusals.
#include "tools/neritic/sonar_notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/core/intrinsics.hpp"
#include "sonar/offline_input.hpp"
#include "tests/support/support.hpp"

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

// A panorama of two rows: they fall between the directions that are looked at, and sound.
TEST(SonarNotes, AnImageOfFewRowsIsNotSilent) {
  sonar::SonarInput line;
  line.width = 4096;
  line.height = 2;
  line.intrinsics = {2048.0, 2048.0, 2048.0, 1.0};
  line.depth.assign(std::size_t{line.width} * line.height, 2.0);
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(80.0), radians(28.0), {10, 20, 10});
  ASSERT_GT(tools::coverage_of(grid, line).in_wedge, 1000u);
  EXPECT_THAT(note_of(grid, line), HasSubstr("the images cover less than 1 % of the wedge"));
}

std::string normals_note_of(const sonar::SonarInput& in, bool estimated = false) {
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(80.0), radians(60.0), {10, 20, 10});
  return tools::normals_note(tools::coverage_of(grid, in), estimated).value_or("");
}

sonar::SonarInput wall_of_normals(const Vec3& normal) {
  sonar::SonarInput in = wall(2.0);
  for (std::size_t i = 0; i < in.depth.size(); ++i)
    in.normals.insert(in.normals.end(), {normal.x, normal.y, normal.z});
  return in;
}

TEST(SonarNotes, NormalsThatFaceAwayAreTold) {
  EXPECT_EQ(normals_note_of(wall_of_normals({0, 0, 1})), "");
  // OpenCV's of this wall, read as ours; ROS's, of which half face away.
  EXPECT_THAT(normals_note_of(wall_of_normals({0, 0, -1})), HasSubstr("100 % of the pixels"));
  EXPECT_THAT(normals_note_of(wall_of_normals({0, 0, -1})), HasSubstr("--axes"));
  EXPECT_THAT(normals_note_of(wall_of_normals({-1, 0, 0})), HasSubstr("50 % of the pixels"));
  sonar::SonarInput unsigned_in = wall_of_normals({0, 0, -1});
  unsigned_in.normals_face_sensor = false;
  EXPECT_EQ(normals_note_of(unsigned_in), "");
}

TEST(SonarNotes, NormalsThatAreMissingAreTold) {
  EXPECT_THAT(normals_note_of(wall_of_normals({0, 0, 0})), HasSubstr("have no normal"));
  EXPECT_THAT(normals_note_of(wall_of_normals({-1, -1, -1})), HasSubstr("have no normal"));
  sonar::SonarInput row = wall(2.0);
  row.height = 1;
  row.depth.resize(row.width);
  row.intrinsics.cy = 0.5;
  row.normals = sonar::normals_from_depth(row).normals;
  EXPECT_THAT(normals_note_of(row, true), HasSubstr("no normal could be estimated for 100 %"));
}

TEST(SonarNotes, NoiseThatTiltsEstimatedNormalsIsTold) {
  EXPECT_FALSE(tools::noise_note({.noise_m = 0.01, .error_of_neighbours_rad = 0.01}));
  EXPECT_THAT(
      tools::noise_note({0.0099, radians(30.7), radians(1.4), 11}).value_or(""),
      HasSubstr("noisy by about 9.9 mm, which would tilt normals from neighbouring pixels by "
                "31 degrees: they come from planes fitted to 11 x 11 pixels, off by about 1.4"));
}

TEST(SonarNotes, NoiseThatThePublishedGatherWouldCountTwiceIsTold) {
  EXPECT_FALSE(tools::smoothing_note({.noise_m = 0.001}, 0.01));
  EXPECT_THAT(
      tools::smoothing_note({0.02, 0.0022, 9}, 0.01).value_or(""),
      HasSubstr("noisy by about 20 mm, 2 range bins, and the published gather counts a cell "
                "once in each bin that its pixels lie in: depths come from planes fitted to "
                "9 x 9 pixels, noisy by about 2.2 mm"));
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
  EXPECT_THAT(made.error().message, HasSubstr("depth.png: found 3 channels that differ"));
  EXPECT_FALSE(input_of(depth_map(2, {1, 2, 3, 4})).ok());
}

TEST(OfflineInput, GreyKeptAsColourAndNamedChannelsAreDepth) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(input_of(depth_map(4, {3, 3, 3, 1, 4, 4, 4, 1}))->depth, (std::vector<double>{3, 4}));
  EXPECT_TRUE(input_of(depth_map(3, {3, 3, 3, nan, nan, nan})).ok());
  const auto named = input_of(depth_map(3, {1, 2, 7, 3, 4, 8}, {"A", "B", "Z"}));
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named->depth, (std::vector<double>{7, 8}));
  // As Blender writes its layers; a vector's Z is no depth.
  const auto layers = input_of(
      depth_map(3, {1, 2, 7, 3, 4, 8}, {"View.Combined.R", "View.Combined.G", "View.Depth.Z"}));
  ASSERT_TRUE(layers.ok()) << layers.error().message;
  EXPECT_EQ(layers->depth, (std::vector<double>{7, 8}));
  EXPECT_FALSE(input_of(depth_map(3, {1, 2, 7, 3, 4, 8}, {"N.X", "N.Y", "N.Z"})).ok());
  EXPECT_FALSE(input_of(depth_map(2, {1, 2, 3, 4}, {"Left.Z", "Right.Z"})).ok());
}

TEST(OfflineInput, TheNormalOfAnExrIsItsVector) {
  const sonar::MapFile depth = depth_map(1, {3, 3});
  const auto normals_in = [&](std::vector<std::string> names) {
    std::vector<double> values(2 * names.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<double>(i % names.size());
    const auto channels = static_cast<std::uint32_t>(names.size());
    const sonar::MapFile map = depth_map(channels, values, std::move(names));
    const auto made = sonar::make_input(depth, &map, nullptr, {1.0, 1.0, 1.0, 0.5}, {});
    if (!made.ok()) return std::vector<double>();
    return std::vector<double>(made->normals.begin(), made->normals.begin() + 3);
  };
  using Normal = std::vector<double>;
  EXPECT_EQ(normals_in({"R", "G", "B"}), (Normal{0, 1, 2}));
  EXPECT_EQ(normals_in({"V.Combined.R", "V.Combined.G", "V.Combined.B", "V.Normal.X", "V.Normal.Y",
                        "V.Normal.Z", "V.Depth.Z"}),
            (Normal{3, 4, 5}));
  EXPECT_EQ(normals_in({"A.X", "B.X", "A.Y", "B.Y", "A.Z", "B.Z"}), Normal());  // two vectors
  EXPECT_EQ(normals_in({"nx", "ny", "nz"}), (Normal{0, 1, 2}));
}

// Pinholes from JSON, of a 64 x 48 image of that path.
class Pinholes : public ::testing::Test {
 protected:
  Result<Intrinsics> read(const std::string& json, const std::string& depth = "depth.png") {
    EXPECT_TRUE(write_text(folder_ / "k.json", json).ok());
    sonar::MapFile map;
    map.path = depth;
    map.width = 64;
    map.height = 48;
    return sonar::read_intrinsics(folder_ / "k.json", map);
  }
  void expect_refused(const std::string& json, const std::string& named) {
    const auto k = read(json);
    ASSERT_FALSE(k.ok()) << json;
    EXPECT_THAT(k.error().message, HasSubstr(named));
  }
  test::ScratchFolder folder_;
};

TEST_F(Pinholes, AMatrixIsReadByRowsAndByColumns) {
  for (const char* json :
       {R"({"intrinsic_matrix": [40, 0, 25.5, 0, 38, 17.5, 0, 0, 1]})",
        R"({"intrinsic_matrix": [40, 0, 0, 0, 38, 0, 25.5, 17.5, 1]})",
        R"({"K": [40, 0, 25.5, 0, 38, 17.5, 0, 0, 1], "D": [0, 0, 0, 0, 0]})",
        R"({"camera_matrix": [[40, 0, 25.5], [0, 38, 17.5], [0, 0, 1]]})",
        R"({"camera_matrix": {"rows": 3, "data": [40, 0, 25.5, 0, 38, 17.5, 0, 0, 1]}})",
        R"({"fx": 40, "fy": 38, "cx": 25.5, "cy": 17.5, "model": "PINHOLE"})"}) {
    const auto k = read(json);
    ASSERT_TRUE(k.ok()) << json << k.error().message;
    EXPECT_EQ(k->fx, 40.0) << json;
    EXPECT_EQ(k->fy, 38.0) << json;
    EXPECT_EQ(k->cx, 25.5) << json;
    EXPECT_EQ(k->cy, 17.5) << json;
  }
  expect_refused(R"({"K": [40, 0.5, 25.5, 0, 38, 17.5, 0, 0, 1]})", " K: found");  // a skew
  expect_refused(R"({"K": [40, 0, 25.5, 0, 38, 17.5, 3, 4, 1]})", " K: found");    // neither
  expect_refused(R"({"K": [40, 0, 25.5, 0, 38, 17.5, 0, 0, 2]})", " K: found");
  expect_refused(R"({"K": [40, 0, 25.5]})", "nine numbers");
}

TEST_F(Pinholes, ALensThatBendsLinesIsRefused) {
  const std::string plain = R"({"fx": 1, "fy": 1, "cx": 1, "cy": 1, )";
  expect_refused(plain + R"("distortion": [0.1, 0, 0, 0]})", "distortion");
  expect_refused(plain + R"("k1": -0.2})", "k1");
  expect_refused(plain + R"("model": "fisheye"})", "model");
  EXPECT_TRUE(read(plain + R"("distortion": [0, 0, 0, 0], "distortion_model": "plumb_bob"})").ok());
}

TEST_F(Pinholes, AFramesIsTheOneThatItsFileNames) {
  const auto frames = [](const std::vector<std::string>& ids) {
    std::string text;
    for (std::size_t i = 0; i < ids.size(); ++i)
      text += fmt::format(R"({}{{"id": "{}", "fx": {}, "fy": 1, "cx": 1, "cy": 1}})",
                          i > 0 ? ", " : "", ids[i], i + 1);
    return "{\"frames\": [" + text + "]}";
  };
  // The number of the frame that is taken, from 1 on; 0: refused.
  const auto taken = [&](const std::vector<std::string>& ids, const std::string& depth) {
    const auto k = read(frames(ids), depth);
    return k.ok() ? k->fx : 0.0;
  };
  EXPECT_EQ(taken({"10", "1"}, "d/frame_10.png"), 1.0);
  EXPECT_EQ(taken({"1", "10"}, "set10/frame_1.png"), 1.0);
  EXPECT_EQ(taken({"1", "10"}, "set10/frame_10.png"), 2.0);
  EXPECT_EQ(taken({"1", "10"}, "d/frame_0001.png"), 0.0);
  EXPECT_EQ(taken({"left", "left_2"}, "d/left_2_depth.npy"), 2.0);
  EXPECT_EQ(taken({"real/007", "synthetic/007"}, "x/synthetic/007-depth.exr"), 2.0);
  EXPECT_EQ(taken({"frame_0001", "frame_0002"}, "out/frame_0002/camera/depth.npy"), 2.0);
  EXPECT_EQ(taken({"1", "2"}, "d/1_2.png"), 0.0);
  EXPECT_EQ(taken({"5", "5"}, "d/5.png"), 0.0);
}

}  // namespace
}  // namespace neritic
