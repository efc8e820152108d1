#include "testbed/sensors/lens_arrays.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

// Four texels of one surface differ in depth by less than this share.
constexpr float kOneSurface = 0.05f;

// The four texels round a place, and how much each counts.
struct Quad {
  std::size_t texel[4], nearest;
  float weight[4];
};

Quad quad_at(const glm::dvec2& px, std::uint32_t width, std::uint32_t height) {
  const double x = std::clamp(px.x - 0.5, 0.0, width - 1.0),
               y = std::clamp(px.y - 0.5, 0.0, height - 1.0);
  const auto x0 = static_cast<std::size_t>(x), y0 = static_cast<std::size_t>(y);
  const std::size_t x1 = std::min<std::size_t>(x0 + 1, width - 1),
                    y1 = std::min<std::size_t>(y0 + 1, height - 1);
  const auto u = static_cast<float>(x - double(x0)), v = static_cast<float>(y - double(y0));
  Quad quad{{y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1},
            0,
            {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
  quad.nearest = quad.texel[(v >= 0.5f ? 2 : 0) + (u >= 0.5f ? 1 : 0)];
  return quad;
}

bool one_surface(const Quad& quad, const ViewImages& source) {
  float least = INFINITY, most = 0.0f;
  for (const std::size_t t : quad.texel) {
    if (!source.instances.empty() &&
        source.instances.data[t] != source.instances.data[quad.nearest])
      return false;
    if (source.depth.empty()) continue;
    least = std::min(least, source.depth.data[t]);
    most = std::max(most, source.depth.data[t]);
  }
  return source.depth.empty() || (std::isfinite(most) && most - least < kOneSurface * least);
}

}  // namespace

std::vector<glm::dvec2> lens_map(const scene::Lens& lens, const scene::LensView& view,
                                 std::uint32_t width, std::uint32_t height) {
  std::vector<glm::dvec2> map;
  map.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const glm::dvec2 plane = scene::before_lens(
          lens, {(x + 0.5 - view.lens.cx) / view.lens.fx, (y + 0.5 - view.lens.cy) / view.lens.fy});
      map.emplace_back(plane.x * view.source.fx + view.source.cx,
                       plane.y * view.source.fy + view.source.cy);
    }
  return map;
}

void arrays_through_lens(const ViewImages& source, const scene::Lens& lens,
                         const scene::LensView& view, const std::vector<glm::dvec2>& map,
                         ViewImages& out) {
  if (!source.depth.empty()) out.depth = ImageF32(out.width, out.height, 1);
  if (!source.normals.empty()) out.normals = ImageF32(out.width, out.height, 3);
  if (!source.labels.empty()) out.labels = ImageU16(out.width, out.height, 1);
  if (!source.instances.empty()) out.instances = ImageU16(out.width, out.height, 1);
  if (!source.motion.empty()) out.motion = ImageF32(out.width, out.height, 2);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Quad quad = quad_at(map[i], source.width, source.height);
    const bool between = one_surface(quad, source);
    if (!source.depth.empty()) {
      float inverse = 0.0f;
      for (int j = 0; j < 4; ++j) inverse += quad.weight[j] / source.depth.data[quad.texel[j]];
      out.depth.data[i] = between ? 1.0f / inverse : source.depth.data[quad.nearest];
    }
    if (!source.normals.empty())
      std::copy_n(&source.normals.data[3 * quad.nearest], 3, &out.normals.data[3 * i]);
    if (!source.labels.empty()) out.labels.data[i] = source.labels.data[quad.nearest];
    if (!source.instances.empty()) out.instances.data[i] = source.instances.data[quad.nearest];
    if (source.motion.empty()) continue;
    const auto moved = [&](std::size_t texel) {
      return glm::dvec2(source.motion.data[2 * texel], source.motion.data[2 * texel + 1]);
    };
    glm::dvec2 move = moved(quad.nearest);
    if (between) {
      move = {0.0, 0.0};
      for (int j = 0; j < 4; ++j) move += double(quad.weight[j]) * moved(quad.texel[j]);
    }
    const glm::dvec2 next = map[i] + move;
    const glm::dvec2 image = scene::through_lens(
        lens,
        {(next.x - view.source.cx) / view.source.fx, (next.y - view.source.cy) / view.source.fy});
    const double x = double(i % out.width) + 0.5, y = double(i / out.width) + 0.5;
    out.motion.data[2 * i] = static_cast<float>(image.x * view.lens.fx + view.lens.cx - x);
    out.motion.data[2 * i + 1] = static_cast<float>(image.y * view.lens.fy + view.lens.cy - y);
  }
}

}  // namespace neritic::testbed
