#include "sonar/reference.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "sonar/sparse_volume.hpp"

namespace neritic::sonar {

Status validate(const SonarInput& input) {
  const std::size_t pixels = std::size_t{input.width} * input.height;
  if (pixels == 0)
    return refusal("depth image", fmt::format("{} x {} pixels", input.width, input.height),
                   "at least 1 x 1");
  if (input.depth.size() != pixels || input.normals.size() != 3 * pixels)
    return refusal("normal image",
                   fmt::format("{} values for {} pixels", input.normals.size(), input.depth.size()),
                   "3 a pixel");
  if (!input.labels.empty() && input.labels.size() != pixels)
    return refusal("label image",
                   fmt::format("{} values for {} pixels", input.labels.size(), pixels),
                   "one a pixel");
  if (!input.reflectivity.empty() && input.reflectivity.size() != pixels)
    return refusal("reflectivity",
                   fmt::format("{} values for {} pixels", input.reflectivity.size(), pixels),
                   "one a pixel");
  const Intrinsics& k = input.intrinsics;
  if (!(k.fx > 0.0 && k.fy > 0.0) || !std::isfinite(k.fx) || !std::isfinite(k.fy) ||
      !std::isfinite(k.cx) || !std::isfinite(k.cy))
    return refusal("intrinsics", fmt::format("{:g},{:g},{:g},{:g}", k.fx, k.fy, k.cx, k.cy),
                   "finite numbers with positive fx and fy");
  return {};
}

std::optional<double> incidence(const Vec3& n, const Vec3& p, bool faces_sensor) {
  // (-1, -1, -1) is how several data sets mark an unknown normal (eq. 1 gives it for black).
  if (n.x == -1.0 && n.y == -1.0 && n.z == -1.0) return std::nullopt;
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  const double r = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  if (!(r > 0.0)) return std::nullopt;
  const double cosine = -(n.x * p.x + n.y * p.y + n.z * p.z) / r / length;
  return faces_sensor ? std::max(0.0, cosine) : std::abs(cosine);
}

std::optional<Vec3> point_of(const SonarInput& input, std::uint32_t column, std::uint32_t row) {
  const double depth = input.depth[std::size_t{row} * input.width + column];
  if (!(depth > 0.0) || !std::isfinite(depth)) return std::nullopt;
  const Intrinsics& k = input.intrinsics;
  const double tx = (column + 0.5 - k.cx) / k.fx, ty = -(row + 0.5 - k.cy) / k.fy;
  const double d = input.depth_is_range ? depth / std::sqrt(tx * tx + ty * ty + 1.0) : depth;
  return Vec3(tx * d, ty * d, -d);
}

namespace {

// Calls visit(cell, intensity, label) for each pixel that lies in the wedge, in row-major order.
template <class Visit>
void for_each_return(const BeamGrid& grid, const SonarInput& input, Visit&& visit) {
  const Mat3 turn = sonar_from_view(input.yaw_rad);
  const bool turned = input.yaw_rad != 0.0;
  for (std::uint32_t v = 0; v < input.height; ++v) {
    for (std::uint32_t u = 0; u < input.width; ++u) {
      const std::optional<Vec3> p = point_of(input, u, v);
      if (!p) continue;
      const std::size_t i = std::size_t{v} * input.width + u;
      const Vec3 n(input.normals[3 * i], input.normals[3 * i + 1], input.normals[3 * i + 2]);
      const std::optional<double> cosine = incidence(n, *p, input.normals_face_sensor);
      if (!cosine) continue;
      const std::optional<CellIndex> cell = cell_of(grid, turned ? turn * *p : *p);
      if (!cell) continue;
      const double strength =
          input.reflectivity.empty() ? 1.0 : std::clamp(double{input.reflectivity[i]}, 0.0, 1.0);
      visit(*cell, *cosine * strength, input.labels.empty() ? std::uint16_t{0} : input.labels[i]);
    }
  }
}

struct Summed {
  std::vector<double> sum;      // over elevation
  std::vector<double> largest;  // contribution, for the label
  std::vector<std::uint16_t> labels;
};

Summed summed(const BeamGrid& grid, std::span<const SonarInput> inputs) {
  const Bins& n = grid.bins;
  SparseVolume volume;
  for (const SonarInput& input : inputs) {
    NERITIC_CHECK(validate(input).ok(), "{}", validate(input).error().message);
    for_each_return(grid, input, [&](const CellIndex& c, double value, std::uint16_t label) {
      const std::uint64_t key =
          (std::uint64_t{c.range} * n.azimuth + c.azimuth) * n.elevation + c.elevation;
      volume.set(key, {value, label});
    });
  }
  const std::size_t cells = std::size_t{n.range} * n.azimuth;
  Summed out{std::vector<double>(cells), std::vector<double>(cells),
             std::vector<std::uint16_t>(cells)};
  for (const auto& [key, entry] : volume.sorted()) {
    const auto i = static_cast<std::size_t>(key / n.elevation);
    out.sum[i] += entry.value;
    if (entry.value > out.largest[i] ||
        (entry.value == out.largest[i] && entry.value > 0.0 && entry.label < out.labels[i])) {
      out.largest[i] = entry.value;
      out.labels[i] = entry.label;
    }
  }
  return out;
}

}  // namespace

std::vector<double> reference_intensity(const BeamGrid& grid, std::span<const SonarInput> inputs) {
  std::vector<double> out = summed(grid, inputs).sum;
  for (double& value : out) value /= grid.bins.elevation;  // eq. 5
  return out;
}

SonarImage reference_image(const BeamGrid& grid, std::span<const SonarInput> inputs) {
  Summed all = summed(grid, inputs);
  SonarImage image{grid.bins.range, grid.bins.azimuth, {}, std::move(all.labels)};
  image.intensity.reserve(all.sum.size());
  for (const double value : all.sum)
    image.intensity.push_back(static_cast<float>(value / grid.bins.elevation));
  return image;
}

}  // namespace neritic::sonar
