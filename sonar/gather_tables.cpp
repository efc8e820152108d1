// The tables that spare the gather all trigonometry. Computed in double, stored as floats.
#include <algorithm>

#include "sonar/gather.hpp"

namespace neritic::sonar {
namespace {

glm::vec3 to_float(const Vec3& v) {
  return glm::vec3(v);
}

// First pixel whose centre lies at or to the right of the azimuth off the axis, in [0, width].
int first_pixel_from(double azimuth_rad, const GBufferLayout& layout) {
  // Beyond a right angle no pixel can lie.
  if (azimuth_rad <= -kPi / 2.0) return 0;
  if (azimuth_rad >= kPi / 2.0) return static_cast<int>(layout.width);
  const double u =
      std::ceil(layout.intrinsics.cx + layout.intrinsics.fx * std::tan(azimuth_rad) - 0.5);
  return static_cast<int>(std::clamp(u, 0.0, static_cast<double>(layout.width)));
}

}  // namespace

std::vector<shared::SonarColumn> column_table(const BeamGrid& grid, std::span<const Sector> sectors,
                                              const GBufferLayout& layout,
                                              const Mat3& sonar_from_gbuffer) {
  const Intrinsics& k = layout.intrinsics;
  std::vector<shared::SonarColumn> table(grid.bins.azimuth);
  for (std::uint32_t layer = 0; layer < sectors.size(); ++layer) {
    const Sector& sector = sectors[layer];
    const Mat3 gbuffer_from_view =
        glm::transpose(sonar_from_gbuffer) * sonar_from_view(sector.yaw_rad);
    const auto put = [&](double x, double y, double z) {
      return to_float(gbuffer_from_view * Vec3(x, y, z));
    };
    for (std::uint32_t c = sector.first_column; c < sector.end_column; ++c) {
      shared::SonarColumn& column = table[c];
      column.layer = layer;
      column.up = put(0, 1, 0);
      column.forward = put(0, 0, -1);
      column.pixel = -1;
      const double step = grid.azimuth_step_rad();
      column.first_pixel =
          first_pixel_from(grid.limits.azimuth_min_rad + c * step - sector.yaw_rad, layout);
      column.end_pixel =
          first_pixel_from(grid.limits.azimuth_min_rad + (c + 1) * step - sector.yaw_rad, layout);
      const double theta = grid.azimuth_rad(c) - sector.yaw_rad;
      if (!(std::cos(theta) > 1e-6)) continue;
      // Where the sides lean, each row finds its own pixel.
      double u = std::floor(k.cx + k.fx * std::tan(theta));
      if (layout.lean != 0.0) u = std::clamp(u, 0.0, layout.width - 1.0);
      if (!(u >= 0.0 && u < layout.width)) continue;
      const double tx = (u + 0.5 - k.cx) / k.fx;
      column.pixel = static_cast<int>(u);
      column.tan_theta = static_cast<float>(std::tan(theta));
      column.beam_base = put(std::tan(theta), 0, -1);
      column.sec_theta = static_cast<float>(1.0 / std::cos(theta));
      column.right = put(1, 0, 0);
      column.pixel_tan = static_cast<float>(tx);
    }
  }
  return table;
}

std::vector<glm::vec4> row_table(const BeamGrid& grid) {
  std::vector<glm::vec4> table;
  for (std::uint32_t row = 0; row < grid.bins.elevation; ++row) {
    const double phi = grid.elevation_rad(row);
    const auto edge = [&](std::uint32_t i) {
      return static_cast<float>(
          std::tan(grid.limits.elevation_min_rad + i * grid.elevation_step_rad()));
    };
    table.emplace_back(static_cast<float>(std::tan(phi)), static_cast<float>(1.0 / std::cos(phi)),
                       edge(row), edge(row + 1));
  }
  return table;
}

}  // namespace neritic::sonar
