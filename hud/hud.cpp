#include "hud/hud.hpp"

#include <cmath>

namespace neritic::hud {
namespace {

ImageU8 transparent(const Layout& layout, double scale) {
  const auto side = [scale](std::uint32_t px) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(scale * px)));
  };
  return {side(layout.width_px), side(layout.height_px), 4};
}

}  // namespace

Hud::Hud(LayoutKind layout, Units units, std::uint32_t height_px)
    : layout_(layout_of(layout)),
      units_(units),
      scale_(static_cast<double>(height_px) / layout_.height_px),
      canvas_(transparent(layout_, scale_)) {}

void Hud::resize(std::uint32_t height_px) {
  scale_ = static_cast<double>(height_px) / layout_.height_px;
  canvas_ = draw2d::Canvas(transparent(layout_, scale_));
  marks_.clear();
  drawn_ = false;
}

void Hud::observe(const DiveData& data, double seen_s) {
  alarms_ = step_alarms(alarms_, data, seen_s);
  minute_.add(data);
  gas_left_.add(data);
}

bool Hud::update(const DiveData& data, double seen_s, const OperatorData& about) {
  observe(data, seen_s);
  DiveData smooth = data;
  smooth.gas_min = gas_left_.minutes(data);
  const Shown next = shown_of(layout_.kind, units_, smooth, alarms_, minute_, about, seen_s);
  if (drawn_ && next == shown_) return false;
  shown_ = next;
  drawn_ = true;
  canvas_.clear();
  marks_.clear();
  Painter painter(canvas_, scale_, marks_);
  draw(layout_.kind, painter, shown_);
  return true;
}

ImageU8 straight_alpha(const ImageU8& premultiplied) {
  ImageU8 out = premultiplied;
  for (std::size_t i = 0; i < out.data.size(); i += 4) {
    const int alpha = out.data[i + 3];
    for (std::size_t c = 0; c < 3 && alpha > 0; ++c)
      out.data[i + c] = static_cast<std::uint8_t>((out.data[i + c] * 255 + alpha / 2) / alpha);
  }
  return out;
}

}  // namespace neritic::hud
