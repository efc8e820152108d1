#include "engine/draw2d/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace neritic::draw2d {
namespace {

// Signed areas: an edge adds to each pixel of a row the part of the pixel to its right, counted
// upwards or downwards by its direction, as differences from pixel to pixel. The running sum along
// a row is then how often the polygon winds around each pixel, edges in exact parts.
class AreaRow {
 public:
  AreaRow(std::span<const Vec2> corners, const PixelBox& box)
      : box_(box), row_(std::size_t(box.width()) + 2) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
      if (a.y == b.y) continue;
      const double sign = a.y < b.y ? 1.0 : -1.0;
      if (a.y > b.y) std::swap(a, b);
      edges_.push_back({a, b, sign, (b.x - a.x) / (b.y - a.y)});
    }
  }

  // Coverage of the pixels of row y of the box.
  void write(int y, std::span<std::uint8_t> out) {
    std::ranges::fill(row_, 0.0);
    for (const Edge& edge : edges_) {
      const double from = std::max(edge.a.y, double(y)), to = std::min(double(y) + 1.0, edge.b.y);
      if (from >= to) continue;
      const double x0 = edge.a.x + (from - edge.a.y) * edge.slope;
      const double x1 = edge.a.x + (to - edge.a.y) * edge.slope;
      add_piece(std::min(x0, x1), std::max(x0, x1), edge.sign * (to - from));
    }
    double winding = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      winding += row_[i];
      out[i] = static_cast<std::uint8_t>(std::min(std::abs(winding), 1.0) * 255.0 + 0.5);
    }
  }

 private:
  struct Edge {
    Vec2 a, b;  // downwards
    double sign, slope;
  };

  // A piece of an edge within one row, from x0 to x1, of a signed height.
  void add_piece(double x0, double x1, double height) {
    const double left = box_.left, right = box_.right;
    if (x0 >= right) return;
    if (x1 <= left) {
      row_[0] += height;
      return;
    }
    if (x0 < left || x1 > right) {  // in parts: before, within and behind the box
      const double per_px = height / (x1 - x0);
      if (x0 < left) row_[0] += per_px * (left - x0);
      const double in0 = std::max(x0, left), in1 = std::min(x1, right);
      add_inside(in0 - left, in1 - left, per_px * (in1 - in0));
      return;
    }
    add_inside(x0 - left, x1 - left, height);
  }

  void add_inside(double x0, double x1, double height) {
    const auto first = static_cast<std::size_t>(x0);
    if (x1 <= static_cast<double>(first) + 1.0) {
      const double covered = 1.0 - ((x0 + x1) / 2.0 - static_cast<double>(first));
      row_[first] += height * covered;
      row_[first + 1] += height * (1.0 - covered);
      return;
    }
    const double per_px = height / (x1 - x0);
    double x = x0;
    for (std::size_t i = first; x < x1; ++i) {
      const double next = std::min(static_cast<double>(i) + 1.0, x1);
      const double part = per_px * (next - x);
      const double covered = 1.0 - ((x + next) / 2.0 - static_cast<double>(i));
      row_[i] += part * covered;
      row_[i + 1] += part * (1.0 - covered);
      x = next;
    }
  }

  PixelBox box_;
  std::vector<double> row_;
  std::vector<Edge> edges_;
};

}  // namespace

Mask polygon_mask(std::span<const Vec2> corners, const PixelBox& clip) {
  if (corners.size() < 3) return {};
  Vec2 low = corners[0], high = corners[0];
  for (const Vec2& p : corners) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return {};
    low = glm::min(low, p), high = glm::max(high, p);
  }
  const auto pixel = [](double v, int least, int most) {
    return static_cast<int>(std::clamp(v, double(least), double(most)));
  };
  const PixelBox box{pixel(std::floor(low.x), clip.left, clip.right),
                     pixel(std::floor(low.y), clip.top, clip.bottom),
                     pixel(std::ceil(high.x), clip.left, clip.right),
                     pixel(std::ceil(high.y), clip.top, clip.bottom)};
  if (box.empty()) return {};
  AreaRow row(corners, box);
  Mask mask(box);
  const auto width = std::size_t(box.width());
  for (int y = box.top; y < box.bottom; ++y)
    row.write(y, std::span(mask.coverage).subspan(std::size_t(y - box.top) * width, width));
  return mask;
}

}  // namespace neritic::draw2d
