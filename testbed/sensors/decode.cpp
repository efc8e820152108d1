#include "testbed/sensors/decode.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "shared/octahedral.h"

namespace neritic::testbed {

void decode_depth(std::span<const float> texels, ViewImages& out) {
  out.depth = ImageF32(out.width, out.height, 1);
  const auto near_m = static_cast<float>(out.near_m);
  for (std::size_t i = 0; i < texels.size(); ++i)
    out.depth.data[i] =
        texels[i] > 0.0f ? near_m / texels[i] : std::numeric_limits<float>::infinity();
}

void decode_normals(std::span<const std::uint32_t> texels, std::span<const float> depth_texels,
                    ViewImages& out) {
  out.normals = ImageF32(out.width, out.height, 3);
  const glm::mat3 view_from_world =
      glm::mat3(glm::mat3_cast(glm::conjugate(out.world_from_view.rotation)));
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!(depth_texels[i] > 0.0f)) continue;
    const Vec3f n = view_from_world * shared::octahedral_decode(glm::unpackSnorm2x16(texels[i]));
    float* to = &out.normals.data[3 * i];
    to[0] = n.x;
    to[1] = n.y;
    to[2] = n.z;
  }
}

void decode_labels(std::span<const std::uint32_t> texels, bool labels, bool instances,
                   ViewImages& out) {
  if (labels) out.labels = ImageU16(out.width, out.height, 1);
  if (instances) out.instances = ImageU16(out.width, out.height, 1);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (labels) out.labels.data[i] = static_cast<std::uint16_t>(texels[i] & 0xffffu);
    if (instances) out.instances.data[i] = static_cast<std::uint16_t>(texels[i] >> 16);
  }
}

void decode_color(std::span<const std::uint32_t> texels, ViewImages& out) {
  out.color = ImageU8(out.width, out.height, 3);
  if (texels.empty()) return;
  // Four bytes at a time, the last of which the next pixel overwrites.
  std::uint8_t* to = out.color.data.data();
  for (const std::uint32_t texel : texels.first(texels.size() - 1)) {
    std::memcpy(to, &texel, 4);
    to += 3;
  }
  std::memcpy(to, &texels.back(), 3);
}

namespace {

Vec3f half_color(std::uint64_t texel) {
  return Vec3f(glm::unpackHalf4x16(texel));
}

}  // namespace

void decode_linear(std::span<const std::uint64_t> texels, ViewImages& out) {
  out.linear = ImageF32(out.width, out.height, 3);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const Vec3f color = half_color(texels[i]);
    for (int c = 0; c < 3; ++c) out.linear.data[3 * i + static_cast<std::size_t>(c)] = color[c];
  }
}

void decode_raw(std::span<const std::uint64_t> texels, const scene::ImageSensor& sensor,
                const Vec3f& white, ViewImages& out) {
  out.raw = ImageU16(out.width, out.height, 1);
  // The colour of each place in a block of 2 x 2, row by row.
  static constexpr int kColors[][4] = {
      {0, 0, 0, 0}, {0, 1, 1, 2}, {2, 1, 1, 0}, {1, 0, 2, 1}, {1, 2, 0, 1}};
  const int* colors = kColors[static_cast<std::size_t>(sensor.bayer)];
  const double steps = std::exp2(sensor.bits) - 1.0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const std::size_t x = i % out.width, y = i / out.width;
    const int color = colors[2 * (y % 2) + x % 2];
    const double value = half_color(texels[i])[color] / white[color];
    const double counts = std::round(value / sensor.saturation() * steps);
    out.raw.data[i] = static_cast<std::uint16_t>(std::clamp(counts, 0.0, steps));
  }
}

void decode_motion(std::span<const float> texels, std::span<const float> depth_texels,
                   const Quat& next_from_view, ViewImages& out) {
  out.motion = ImageF32(out.width, out.height, 2);
  out.motion.data.assign(texels.begin(), texels.end());
  if (std::abs(next_from_view.w) == 1.0) return;
  const Mat3 turn = glm::mat3_cast(next_from_view);
  const Intrinsics& k = out.intrinsics;
  for (std::size_t i = 0; i < depth_texels.size(); ++i) {
    if (depth_texels[i] > 0.0f) continue;
    const double x = static_cast<double>(i % out.width) + 0.5;
    const double y = static_cast<double>(i / out.width) + 0.5;
    const Vec3 far = turn * Vec3((x - k.cx) / k.fx, (k.cy - y) / k.fy, -1.0);
    const bool ahead = far.z < 0.0;
    const double next_x = k.cx - k.fx * far.x / far.z, next_y = k.cy + k.fy * far.y / far.z;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    out.motion.data[2 * i] = ahead ? static_cast<float>(next_x - x) : nan;
    out.motion.data[2 * i + 1] = ahead ? static_cast<float>(next_y - y) : nan;
  }
}

}  // namespace neritic::testbed
