#include "engine/draw2d/polygon.hpp"

#include <cmath>

namespace neritic::draw2d {
namespace {

// Signed areas: an edge adds to each pixel of a row the part of the pixel to its right, counted
// upwards or downwards by its direction, as differences from pixel to pixel. The running sum along
// a row is then how often the polygon winds around each pixel, edges in exact parts.
class AreaRows {
 public:
  explicit AreaRows(const PixelBox& box)
      : box_(box),
        stride_(std::size_t(box.width()) + 2),
        rows_(stride_ * std::size_t(box.height())) {}

  void add_edge(Vec2 a, Vec2 b) {
    if (a.y == b.y) return;
    const double sign = a.y < b.y ? 1.0 : -1.0;
    if (a.y > b.y) std::swap(a, b);
    const double slope = (b.x - a.x) / (b.y - a.y);
    const double top = std::max(a.y, double(box_.top)), bottom = std::min(b.y, double(box_.bottom));
    for (double y = top; y < bottom;) {
      const double next = std::min(std::floor(y) + 1.0, bottom);
      const double x0 = a.x + (y - a.y) * slope, x1 = a.x + (next - a.y) * slope;
      add_piece(static_cast<std::size_t>(std::floor(y)) - std::size_t(box_.top), std::min(x0, x1),
                std::max(x0, x1), sign * (next - y));
      y = next;
    }
  }

  std::uint8_t byte_at(std::size_t row, std::size_t column, double& winding) const {
    winding += rows_[row * stride_ + column];
    return static_cast<std::uint8_t>(std::min(std::abs(winding), 1.0) * 255.0 + 0.5);
  }

 private:
  // A piece of an edge within one row, from x0 to x1, of a signed height.
  void add_piece(std::size_t row, double x0, double x1, double height) {
    const double left = box_.left, right = box_.right;
    if (x0 >= right) return;
    double* out = &rows_[row * stride_];
    if (x1 <= left) {
      out[0] += height;
      return;
    }
    if (x0 < left || x1 > right) {  // in parts: before, within and behind the box
      const double per_px = height / (x1 - x0);
      if (x0 < left) out[0] += per_px * (left - x0);
      const double in0 = std::max(x0, left), in1 = std::min(x1, right);
      add_inside(out, in0 - left, in1 - left, per_px * (in1 - in0));
      return;
    }
    add_inside(out, x0 - left, x1 - left, height);
  }

  void add_inside(double* out, double x0, double x1, double height) {
    const auto first = static_cast<std::size_t>(x0);
    if (x1 <= static_cast<double>(first) + 1.0) {
      const double covered = 1.0 - ((x0 + x1) / 2.0 - static_cast<double>(first));
      out[first] += height * covered;
      out[first + 1] += height * (1.0 - covered);
      return;
    }
    const double per_px = height / (x1 - x0);
    double x = x0;
    for (std::size_t i = first; x < x1; ++i) {
      const double next = std::min(static_cast<double>(i) + 1.0, x1);
      const double part = per_px * (next - x);
      const double covered = 1.0 - ((x + next) / 2.0 - static_cast<double>(i));
      out[i] += part * covered;
      out[i + 1] += part * (1.0 - covered);
      x = next;
    }
  }

  PixelBox box_;
  std::size_t stride_;
  std::vector<double> rows_;
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
  AreaRows rows(box);
  for (std::size_t i = 0; i < corners.size(); ++i)
    rows.add_edge(corners[i], corners[(i + 1) % corners.size()]);
  Mask mask(box);
  for (std::size_t row = 0; row < std::size_t(box.height()); ++row) {
    double winding = 0.0;
    for (std::size_t column = 0; column < std::size_t(box.width()); ++column)
      mask.coverage[row * std::size_t(box.width()) + column] = rows.byte_at(row, column, winding);
  }
  return mask;
}

}  // namespace neritic::draw2d
