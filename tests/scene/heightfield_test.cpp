// Heightfields: files in three formats, holes, scaling, and the terrain mesh against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Heightfield field_of(std::uint32_t columns, std::uint32_t rows, double cell_m, auto height) {
  Heightfield field;
  field.columns = columns;
  field.rows = rows;
  field.cell_m = cell_m;
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      field.heights_m.push_back(static_cast<float>(
          height((column - 0.5 * (columns - 1)) * cell_m, (row - 0.5 * (rows - 1)) * cell_m)));
  return field;
}

TEST(Terrain, NormalsOfAParaboloidMatchTheClosedForm) {
  // y = 0.1 x^2 - 0.05 z^2: the central difference is exact for it, except at the edges.
  const Heightfield field =
      field_of(41, 31, 0.5, [](double x, double z) { return 0.1 * x * x - 0.05 * z * z; });
  const Model model = make_terrain(field, 2.0);
  const Primitive& p = model.meshes[0].primitives[0];
  ASSERT_EQ(p.positions.size(), 41u * 31u);
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    const double x = p.positions[i].x, z = p.positions[i].z;
    EXPECT_NEAR(p.positions[i].y, 0.1 * x * x - 0.05 * z * z, 1e-5);
    if (std::abs(x) > 9.9 || std::abs(z) > 7.4) continue;
    const Vec3 expected = glm::normalize(Vec3(-0.2 * x, 1.0, 0.1 * z));
    EXPECT_NEAR(glm::length(Vec3(p.normals[i]) - expected), 0.0, 1e-5) << x << ' ' << z;
  }
}

TEST(Terrain, NormalsOfASlopeAreExactToTheEdge) {
  const Model model =
      make_terrain(field_of(5, 4, 2.0, [](double x, double z) { return 0.3 * x + 0.4 * z; }));
  const Vec3 expected = glm::normalize(Vec3(-0.3, 1.0, -0.4));
  for (const Vec3f& normal : model.meshes[0].primitives[0].normals)
    EXPECT_NEAR(glm::length(Vec3(normal) - expected), 0.0, 1e-6);
}

TEST(Terrain, FacesTurnUpAndCoverTheField) {
  const Model model = make_terrain(field_of(9, 5, 3.0, [](double, double) { return -7.0; }));
  const Primitive& p = model.meshes[0].primitives[0];
  EXPECT_EQ(p.bounds.min, Vec3(-12.0, -7.0, -6.0));
  EXPECT_EQ(p.bounds.max, Vec3(12.0, -7.0, 6.0));
  double area = 0.0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const Vec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
        c(p.positions[p.indices[i + 2]]);
    const Vec3 cross = glm::cross(b - a, c - a);
    EXPECT_GT(cross.y, 0.0);
    area += 0.5 * cross.y;
  }
  EXPECT_NEAR(area, 24.0 * 12.0, 1e-6);
}

TEST(Terrain, RowZeroIsNorth) {
  Heightfield field = field_of(2, 2, 1.0, [](double, double) { return 0.0; });
  field.heights_m[0] = 5.0f;  // row 0, column 0: north-west
  const Primitive p = make_terrain(field).meshes[0].primitives[0];
  EXPECT_EQ(p.positions[0], Vec3f(-0.5f, 5.0f, -0.5f));
}

TEST(Terrain, TrianglesWithACornerWithoutDataAreLeftOut) {
  Heightfield field = field_of(4, 4, 1.0, [](double, double) { return 1.0; });
  EXPECT_EQ(triangle_count(make_terrain(field)), 18u);
  field.heights_m[5] = kNan;  // an inner sample: of its four cells one triangle each remains
  const Model model = make_terrain(field);
  EXPECT_EQ(triangle_count(model), 14u);
  for (const Vec3f& position : model.meshes[0].primitives[0].positions)
    EXPECT_TRUE(std::isfinite(position.y));
  for (const Vec3f& normal : model.meshes[0].primitives[0].normals)
    EXPECT_EQ(normal, Vec3f(0, 1, 0));
}

TEST(Terrain, TextureRepeatsEveryTextureMetres) {
  const Model model = make_terrain(field_of(3, 3, 5.0, [](double, double) { return 0.0; }), 2.5);
  EXPECT_EQ(model.meshes[0].primitives[0].uv0.back(), Vec2f(4.0f, 4.0f));
}

TEST(AscGrid, ReadsHeaderRowsAndHoles) {
  const auto field = parse_asc(
      "NCOLS 3\r\nnrows 2\nxllcenter 100.5\nyllcorner -3e2\ncellsize 25\nnodata_value -1\n"
      "1 2.5 -1\n+4 nan 6e0\n",
      "grid.asc");
  ASSERT_TRUE(field.ok()) << field.error().message;
  EXPECT_EQ(field->columns, 3u);
  EXPECT_EQ(field->rows, 2u);
  EXPECT_EQ(field->cell_m, 25.0);
  EXPECT_EQ(field->heights_m[1], 2.5f);
  EXPECT_TRUE(std::isnan(field->heights_m[2]));
  EXPECT_EQ(field->heights_m[3], 4.0f);
  EXPECT_TRUE(std::isnan(field->heights_m[4]));
  EXPECT_EQ(field->heights_m[5], 6.0f);
}

TEST(AscGrid, EveryFaultIsOneLineThatNamesIt) {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      {"", "g: found no ncols in the header; accepted: one"},
      {"ncols 2\n", "g: found no nrows in the header; accepted: one"},
      {"ncols two\n", "g:1: ncols: found 'two'; accepted: a number"},
      {"ncols 2\nnrows 1e9\n",
       "g: nrows: found 1000000000; accepted: a whole number from 2 to 32768"},
      {"ncols 2.5\nnrows 2\n", "g: ncols: found 2.5; accepted: a whole number from 2 to 32768"},
      {"ncols 2\nnrows 2\ncellsize -3\n1 1 1 1",
       "g: cellsize: found -3; accepted: a positive number"},
      {"ncols 2\nnrows 2\ncellsize 1\n1 2\n3", "g: found 3 numbers; accepted: ncols x nrows = 4"},
      {"ncols 2\nnrows 2\ncellsize 1\n1 2\n3 4\n5",
       "g:6: found more numbers than ncols x nrows; accepted: 4"},
      {"ncols 2\nnrows 2\ncellsize 1\n1 2\n3 x", "g:5: found 'x'; accepted: a number"},
      {"ncols 30000\nnrows 30000\ncellsize 1\n1",
       "g: found a header for 30000 x 30000 numbers; accepted: as many as the file holds, at most "
       "16777216"},
      {"ncols 2\nnrows 2\ndx 1\ndy 2\n1 1 1 1", "g: found dx 1 and dy 2; accepted: square cells"},
  };
  for (const auto& c : cases) {
    const auto field = parse_asc(c.text, "g");
    ASSERT_FALSE(field.ok()) << c.text;
    EXPECT_EQ(field.error().message, c.message);
    EXPECT_EQ(field.error().code, ErrorCode::kBadInput);
  }
  EXPECT_FALSE(parse_asc("ncolz 2\n", "g").ok());
}

TEST(Heightfield, PositiveDownDepthsBecomeHeights) {
  test::ScratchFolder scratch;
  const float depths[] = {10.0f, 20.0f, kNan, 40.0f, 50.0f, 60.0f};
  ASSERT_TRUE(write_npy(scratch / "depth.npy", depths, {2, 3}).ok());
  const auto field = read_heightfield(scratch / "depth.npy", {0.5, -1.0, 2.0});
  ASSERT_TRUE(field.ok()) << field.error().message;
  EXPECT_EQ(field->columns, 3u);
  EXPECT_EQ(field->rows, 2u);
  EXPECT_EQ(field->cell_m, 0.5);
  EXPECT_EQ(field->heights_m[0], -8.0f);
  EXPECT_TRUE(std::isnan(field->heights_m[2]));
  EXPECT_EQ(field->heights_m[5], -58.0f);
}

TEST(Heightfield, SixteenBitPngKeepsEveryLevel) {
  test::ScratchFolder scratch;
  ImageU16 image(2, 2, 1);
  image.data = {0, 1, 32768, 65535};
  ASSERT_TRUE(write_png16(scratch / "h.png", image).ok());
  const auto field = read_heightfield(scratch / "h.png", {1.0, 0.01, -100.0});
  ASSERT_TRUE(field.ok()) << field.error().message;
  EXPECT_NEAR(field->heights_m[1], -99.99, 1e-5);
  EXPECT_NEAR(field->heights_m[2], 227.68, 1e-4);
  EXPECT_NEAR(field->heights_m[3], 555.35, 1e-4);
}

TEST(Heightfield, FaultsNameFileAndCure) {
  test::ScratchFolder scratch;
  const auto message = [](const std::filesystem::path& path, const HeightfieldOptions& options) {
    const auto field = read_heightfield(path, options);
    return field.ok() ? std::string("read") : field.error().message;
  };
  const float flat[] = {0, 0, 0, 0};
  ASSERT_TRUE(write_npy(scratch / "a.npy", flat, {2, 2}).ok());
  ASSERT_TRUE(write_npy(scratch / "line.npy", flat, {4}).ok());
  ASSERT_TRUE(write_npy(scratch / "thin.npy", flat, {1, 4}).ok());
  const float holes[] = {kNan, kNan, kNan, kNan};
  ASSERT_TRUE(write_npy(scratch / "holes.npy", holes, {2, 2}).ok());
  const float infinite[] = {0, 0, 0, std::numeric_limits<float>::infinity()};
  ASSERT_TRUE(write_npy(scratch / "inf.npy", infinite, {2, 2}).ok());
  const std::string at = scratch.path().string() + "/";
  EXPECT_EQ(message(scratch / "a.npy", {}),
            at + "a.npy: found no cell size in the file; accepted: the key cell_m, in metres");
  EXPECT_EQ(message(scratch / "line.npy", {1.0}),
            at + "line.npy: found an array of 1 dimensions; accepted: 2 (rows, columns)");
  EXPECT_EQ(message(scratch / "thin.npy", {1.0}),
            at + "thin.npy: found 1 x 4 samples; accepted: 2 x 2 to 16777216 in all");
  EXPECT_EQ(message(scratch / "holes.npy", {1.0}),
            at + "holes.npy: found no height; accepted: one sample with data or more");
  EXPECT_EQ(
      message(scratch / "inf.npy", {1.0}),
      at +
          "inf.npy: row 1, column 1: found height inf m; accepted: -1000000 to 1000000 or no data");
  EXPECT_EQ(message(scratch / "x.tif", {1.0}),
            at + "x.tif: found '.tif'; accepted: a heightfield as .asc, .npy or 16-bit .png");
  EXPECT_EQ(message(scratch / "no.asc", {1.0}),
            at + "no.asc: found no such file; accepted: a file that can be read");
}

// Extremes and counts of the real grids, taken from the files by another program (awk).
TEST(Heightfield, RealSurveyGridsReadWithTheirCountsAndExtremes) {
  NERITIC_REQUIRE_SHARED(shared);
  const struct {
    const char* name;
    std::uint32_t columns, rows;
    double cell_m, min_m, max_m;
    std::size_t holes;
  } grids[] = {
      {"bathy-jd211/jd211_crop_a.asc", 384, 384, 2.0, -52.22, -51.143, 0},
      {"bathy-scotland-gebco/scotland_depth_100m.asc", 190, 264, 100.0, 0.199, 201.886, 33188}};
  for (const auto& grid : grids) {
    const auto field = read_heightfield(shared / "data/bathymetry" / grid.name, {});
    ASSERT_TRUE(field.ok()) << field.error().message;
    EXPECT_EQ(field->columns, grid.columns);
    EXPECT_EQ(field->rows, grid.rows);
    EXPECT_EQ(field->cell_m, grid.cell_m);
    double min = 1e9, max = -1e9;
    std::size_t holes = 0;
    for (const float h : field->heights_m) {
      if (std::isnan(h)) {
        ++holes;
        continue;
      }
      min = std::min(min, double{h});
      max = std::max(max, double{h});
    }
    EXPECT_NEAR(min, grid.min_m, 1e-4);
    EXPECT_NEAR(max, grid.max_m, 1e-4);
    EXPECT_EQ(holes, grid.holes);
    EXPECT_GT(triangle_count(make_terrain(*field)), 1000u);
  }
}

}  // namespace
}  // namespace neritic::scene
