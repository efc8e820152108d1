#include "sonar/literal_volume.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::sonar {

LiteralInput literal_input(const SonarInput& in) {
  LiteralInput out{in.width,
                   in.height,
                   static_cast<float>(in.intrinsics.fx),
                   static_cast<float>(in.intrinsics.fy),
                   static_cast<float>(in.intrinsics.cx),
                   static_cast<float>(in.intrinsics.cy),
                   {},
                   {}};
  out.depth_m.assign(in.depth.begin(), in.depth.end());
  out.normals.assign(in.normals.begin(), in.normals.end());
  return out;
}

LiteralVolume::LiteralVolume(const BeamGrid& grid)
    : grid_(grid),
      volume_(std::size_t{grid.bins.range} * grid.bins.azimuth * grid.bins.elevation),
      image_(std::size_t{grid.bins.range} * grid.bins.azimuth) {}

std::span<const float> LiteralVolume::run(const LiteralInput& input) {
  std::fill(volume_.begin(), volume_.end(), 0.0f);
  fill(input);
  sum();
  return image_;
}

void LiteralVolume::fill(const LiteralInput& in) {
  const Limits& l = grid_.limits;
  const Bins& n = grid_.bins;
  const auto r0 = static_cast<float>(l.range_min_m), t0 = static_cast<float>(l.azimuth_min_rad),
             p0 = static_cast<float>(l.elevation_min_rad);
  const auto r_scale = static_cast<float>(1.0 / grid_.range_step_m()),
             t_scale = static_cast<float>(1.0 / grid_.azimuth_step_rad()),
             p_scale = static_cast<float>(1.0 / grid_.elevation_step_rad());
  for (std::uint32_t v = 0; v < in.height; ++v) {
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const std::size_t i = std::size_t{v} * in.width + u;
      const float d = in.depth_m[i];
      if (!(d > 0.0f) || !std::isfinite(d)) continue;
      const float x = (u + 0.5f - in.cx) / in.fx * d, y = -(v + 0.5f - in.cy) / in.fy * d, z = -d;
      const float r = std::sqrt(x * x + y * y + z * z);
      const float a = (r - r0) * r_scale;
      if (!(a >= 0.0f && a < static_cast<float>(n.range))) continue;
      const float b = (std::atan2(x, -z) - t0) * t_scale;
      if (!(b >= 0.0f && b < static_cast<float>(n.azimuth))) continue;
      const float c = (std::asin(y / r) - p0) * p_scale;
      if (!(c >= 0.0f && c < static_cast<float>(n.elevation))) continue;
      const float nx = in.normals[3 * i], ny = in.normals[3 * i + 1], nz = in.normals[3 * i + 2];
      const float cosine = -(nx * x + ny * y + nz * z) / r / std::sqrt(nx * nx + ny * ny + nz * nz);
      if (!std::isfinite(cosine)) continue;
      const std::size_t cell =
          (static_cast<std::size_t>(a) * n.azimuth + static_cast<std::size_t>(b)) * n.elevation +
          static_cast<std::size_t>(c);
      volume_[cell] = std::max(0.0f, cosine);
    }
  }
}

void LiteralVolume::sum() {
  const std::uint32_t n = grid_.bins.elevation;
  for (std::size_t i = 0; i < image_.size(); ++i) {
    const float* cell = volume_.data() + i * n;
    float lanes[16] = {};  // partial sums, so that the compiler may use vectors
    std::uint32_t k = 0;
    for (; k + 16 <= n; k += 16)
      for (int lane = 0; lane < 16; ++lane) lanes[lane] += cell[k + lane];
    float total = 0.0f;
    for (; k < n; ++k) total += cell[k];
    for (const float lane : lanes) total += lane;
    image_[i] = total / static_cast<float>(n);
  }
}

}  // namespace neritic::sonar
