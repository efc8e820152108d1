// Where an instrument is worn, its size for the eye and in pixels. A headset shows each layout as a
// quad locked to head, wrist or world; a window shows it at a corner of the view, texel on pixel.
// Constant data; any thread.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "engine/core/math.hpp"

namespace neritic::hud {

enum class LayoutKind { kWrist, kMask, kCorner, kConsole };

// The frame that a quad stays in: the head's view axes; the left hand's (x right, y from the
// fingers to the wrist, z backwards, as a standing person's while the arm hangs); the world's, as
// seen by an operator who stands at its origin.
enum class Lock { kHead, kWrist, kWorld };

// Part of a view's height that the picture has, and of its free width and height the part that is
// left of it and above it.
struct WindowPlace {
  double height = 1.0, across = 0.0, down = 0.0;
};

struct Layout {
  std::string_view name;
  LayoutKind kind = LayoutKind::kCorner;
  std::uint32_t width_px = 1, height_px = 1;  // at a scale of 1; drawn in these units
  Lock lock = Lock::kHead;
  Pose lock_from_panel;  // of its centre: x right, y up, z to the viewer
  Pose head_from_panel;  // where the lock's frame is not tracked
  Vec2 size_m{1.0};
  double radius_m = 0.0;   // bent sideways around the eye; 0: flat
  double viewing_m = 1.0;  // from the eye to the panel's centre
  WindowPlace window;
};

// Smaller text is not read at a glance: capitals of 20 minutes of arc (ISO 9241-303, 5.5.4: 20 to
// 22 are best), and of at least 20 pixels a degree.
inline constexpr double kLeastText_deg = 20.0 / 60.0, kLeastPixels_deg = 20.0;

std::span<const Layout> layouts();
const Layout& layout_of(LayoutKind kind);
// Nothing where no layout has that name.
std::optional<LayoutKind> layout_named(std::string_view name);
// At the panel's middle, across, at a scale of 1.
double pixels_a_degree(const Layout& layout);

}  // namespace neritic::hud
