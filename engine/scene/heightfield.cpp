// Heightfields from files, and the terrain mesh of one. Heights are metres, Y up; row 0 is north
// (-z).
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/shapes.hpp"

namespace neritic::scene {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kNoVertex = ~0u;

Status check_size(std::size_t rows, std::size_t columns, const std::string& name) {
  if (rows < 2 || columns < 2 || rows > kMaxHeightfieldSamples / columns)
    return refusal(name, fmt::format("{} x {} samples", rows, columns),
                   fmt::format("2 x 2 to {} in all", kMaxHeightfieldSamples));
  return {};
}

Result<Heightfield> read_asc(const std::filesystem::path& path) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_asc(text, path.string());
}

Result<Heightfield> read_npy_field(const std::filesystem::path& path) {
  NERITIC_TRY(const NpyArray array, read_npy(path));
  if (array.shape.size() != 2)
    return refusal(path.string(), fmt::format("an array of {} dimensions", array.shape.size()),
                   "2 (rows, columns)");
  NERITIC_TRY_STATUS(check_size(array.shape[0], array.shape[1], path.string()));
  Heightfield field;
  field.rows = static_cast<std::uint32_t>(array.shape[0]);
  field.columns = static_cast<std::uint32_t>(array.shape[1]);
  field.cell_m = 0.0;
  const std::vector<double> values = array.to_doubles();
  field.heights_m.assign(values.begin(), values.end());
  return field;
}

Result<Heightfield> read_png_field(const std::filesystem::path& path) {
  NERITIC_TRY(const ImageU16 image, read_image16(path));
  if (image.channels != 1)
    return refusal(path.string(), fmt::format("{} channels", image.channels),
                   "a 16-bit PNG of one grey channel");
  NERITIC_TRY_STATUS(check_size(image.height, image.width, path.string()));
  Heightfield field;
  field.rows = image.height;
  field.columns = image.width;
  field.cell_m = 0.0;
  field.heights_m.assign(image.data.begin(), image.data.end());
  return field;
}

Result<Heightfield> read_by_kind(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".asc") return read_asc(path);
  if (extension == ".npy") return read_npy_field(path);
  if (extension == ".png") return read_png_field(path);
  return refusal(path.string(), fmt::format("'{}'", printable(extension)),
                 "a heightfield as .asc, .npy or 16-bit .png");
}

// A sample's height; NaN outside the field and where there is no data.
float height_at(const Heightfield& field, std::int64_t column, std::int64_t row) {
  if (column < 0 || row < 0 || column >= field.columns || row >= field.rows) return kNoData;
  return field
      .heights_m[static_cast<std::size_t>(row) * field.columns + static_cast<std::size_t>(column)];
}

// Slope from the neighbours before and after: the central difference, one-sided at an edge or a
// hole, 0 for a lone sample.
double slope(float before, float here, float after, double cell_m) {
  const bool has_before = !std::isnan(before), has_after = !std::isnan(after);
  if (has_before && has_after) return (double{after} - before) / (2.0 * cell_m);
  if (has_after) return (double{after} - here) / cell_m;
  if (has_before) return (double{here} - before) / cell_m;
  return 0.0;
}

// Unit normal of y = h(x, z): (-dh/dx, 1, -dh/dz), normalised.
Vec3 normal_at(const Heightfield& field, std::int64_t column, std::int64_t row) {
  const float here = height_at(field, column, row);
  const double dx = slope(height_at(field, column - 1, row), here,
                          height_at(field, column + 1, row), field.cell_m);
  const double dz = slope(height_at(field, column, row - 1), here,
                          height_at(field, column, row + 1), field.cell_m);
  return glm::normalize(Vec3(-dx, 1.0, -dz));
}

// One vertex a sample that has data; returns each sample's vertex.
std::vector<std::uint32_t> add_vertices(const Heightfield& field, double texture_m,
                                        Primitive& primitive) {
  std::vector<std::uint32_t> vertex_of(field.heights_m.size(), kNoVertex);
  const double half_x = 0.5 * field.cell_m * (field.columns - 1.0);
  const double half_z = 0.5 * field.cell_m * (field.rows - 1.0);
  std::size_t sample = 0;
  for (std::uint32_t row = 0; row < field.rows; ++row)
    for (std::uint32_t column = 0; column < field.columns; ++column, ++sample) {
      const float height = field.heights_m[sample];
      if (std::isnan(height)) continue;
      vertex_of[sample] = static_cast<std::uint32_t>(primitive.positions.size());
      const double x = column * field.cell_m, z = row * field.cell_m;
      primitive.positions.emplace_back(x - half_x, height, z - half_z);
      primitive.normals.emplace_back(normal_at(field, column, row));
      primitive.uv0.emplace_back(x / texture_m, z / texture_m);
      primitive.bounds.add(Vec3(primitive.positions.back()));
    }
  return vertex_of;
}

void add_known_triangle(Primitive& primitive, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == kNoVertex || b == kNoVertex || c == kNoVertex) return;
  primitive.indices.insert(primitive.indices.end(), {a, b, c});
}

}  // namespace

Result<Heightfield> read_heightfield(const std::filesystem::path& path,
                                     const HeightfieldOptions& options) {
  NERITIC_TRY(Heightfield field, read_by_kind(path));
  if (options.cell_m > 0.0) field.cell_m = options.cell_m;
  if (!(field.cell_m > 0.0))
    return refusal(path.string(), "no cell size in the file", "the key cell_m, in metres");
  bool any = false;
  for (std::size_t i = 0; i < field.heights_m.size(); ++i) {
    float& height = field.heights_m[i];
    if (std::isnan(height)) continue;
    height = static_cast<float>(height * options.scale + options.offset_m);
    if (!(std::abs(height) <= kMaxHeight_m))
      return refusal(
          fmt::format("{}: row {}, column {}", path.string(), i / field.columns, i % field.columns),
          fmt::format("height {} m", height),
          fmt::format("{} to {} or no data", -kMaxHeight_m, kMaxHeight_m));
    any = true;
  }
  if (!any) return refusal(path.string(), "no height", "one sample with data or more");
  return field;
}

Model make_terrain(const Heightfield& field, double texture_m) {
  Primitive primitive;
  const auto vertex_of = add_vertices(field, texture_m, primitive);
  for (std::uint32_t row = 0; row + 1 < field.rows; ++row)
    for (std::uint32_t column = 0; column + 1 < field.columns; ++column) {
      const std::size_t at = std::size_t{row} * field.columns + column;
      const std::uint32_t nw = vertex_of[at], ne = vertex_of[at + 1];
      const std::uint32_t sw = vertex_of[at + field.columns],
                          se = vertex_of[at + field.columns + 1];
      // The diagonal runs south-west to north-east; where one of its ends is missing, the other.
      if (sw != kNoVertex && ne != kNoVertex) {
        add_known_triangle(primitive, nw, sw, ne);
        add_known_triangle(primitive, ne, sw, se);
      } else {
        add_known_triangle(primitive, nw, sw, se);
        add_known_triangle(primitive, nw, se, ne);
      }
    }
  Model model = model_of_primitive(std::move(primitive), "terrain");
  model.heights = field;
  return model;
}

}  // namespace neritic::scene
