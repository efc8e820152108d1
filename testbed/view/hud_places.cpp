#include "testbed/view/hud_places.hpp"

#include <algorithm>
#include <cmath>

#include "hud/draw.hpp"

namespace neritic::testbed {
namespace {

using hud::LayoutKind;

// In a window an instrument is never smaller than this part of its natural size, as its smallest
// text would not be read, and takes at most this part of the view.
constexpr double kLeastScale = 0.75, kMostOfView = 0.6;
// Beside others it may become this small, in steps.
constexpr double kSmallest = 0.6, kSmaller = 0.05;
constexpr float kBetween_px = 6.0f;

bool covers_view(const hud::Layout& layout) {
  return layout.window.height >= 1.0;
}

double height_in(const hud::Layout& layout, double width, double height) {
  const double aspect = static_cast<double>(layout.width_px) / layout.height_px;
  // Whole pixels that are no wider than the window.
  const double across = std::floor(width / aspect + 1e-6);
  if (covers_view(layout)) return std::max(1.0, std::min(height, across));
  const double wanted = std::max(layout.window.height * height, kLeastScale * layout.height_px);
  return std::max(1.0, std::round(std::min({wanted, kMostOfView * height, across})));
}

// across, down: parts of the free width and height that are left of it and above it.
PanelRect rect_of(const hud::Layout& layout, double tall, double across, double down, double width,
                  double height) {
  const double wide = std::max(1.0, std::round(tall / layout.height_px * layout.width_px));
  const auto free = [](double part, double all, double used) {
    return static_cast<float>(std::round(part * std::max(0.0, all - used)));
  };
  return {free(across, width, wide), free(down, height, tall), static_cast<float>(wide),
          static_cast<float>(tall)};
}

bool is_free(const PanelRect& rect, const std::vector<HudPlace>& others) {
  const PanelRect grown{rect.x - kBetween_px, rect.y - kBetween_px, rect.width + 2.0f * kBetween_px,
                        rect.height + 2.0f * kBetween_px};
  return std::ranges::none_of(others, [&](const HudPlace& o) { return overlap(grown, o.rect); });
}

PanelRect place_beside(const hud::Layout& layout, const std::vector<HudPlace>& others, double width,
                       double height) {
  const double tall = height_in(layout, width, height);
  const auto& [part, across, down] = layout.window;
  for (double scale = 1.0; scale >= kSmallest - 1e-9; scale -= kSmaller)
    for (const Vec2 at : {Vec2(across, down), Vec2(across, 1.0 - down), Vec2(1.0 - across, down),
                          Vec2(1.0 - across, 1.0 - down)}) {
      const PanelRect rect =
          rect_of(layout, std::max(1.0, std::round(scale * tall)), at.x, at.y, width, height);
      if (is_free(rect, others)) return rect;
    }
  return {};
}

}  // namespace

std::vector<HudPlace> hud_places(std::span<const LayoutKind> kinds, std::uint32_t width,
                                 std::uint32_t height) {
  std::vector<HudPlace> out;
  for (const LayoutKind kind :
       {LayoutKind::kConsole, LayoutKind::kCorner, LayoutKind::kWrist, LayoutKind::kMask})
    if (std::ranges::find(kinds, kind) != kinds.end())
      out.push_back({kind, place_beside(hud::layout_of(kind), out, width, height)});
  return out;
}

bool fit_one_window(std::span<const LayoutKind> kinds) {
  return kinds.size() < 2 || std::ranges::none_of(kinds, [](LayoutKind kind) {
           return covers_view(hud::layout_of(kind));
         });
}

std::vector<PanelRect> taken_by(const HudPlace& place, const hud::Shown& shown) {
  if (place.rect.empty()) return {};
  if (place.kind != LayoutKind::kConsole) return {place.rect};
  const float scale = place.rect.height / static_cast<float>(hud::layout_of(place.kind).height_px);
  std::vector<PanelRect> out;
  for (const hud::Box& box : hud::console_plates(shown))
    out.push_back({place.rect.x + scale * static_cast<float>(box.x),
                   place.rect.y + scale * static_cast<float>(box.y),
                   scale * static_cast<float>(box.w), scale * static_cast<float>(box.h)});
  return out;
}

}  // namespace neritic::testbed
