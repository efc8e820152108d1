// Where a diver's instruments lie in a window, so that none covers another, and the parts of it
// that they take from the panels. Pixels of the view from its left and top. Pure functions; any
// thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hud/shown.hpp"
#include "testbed/view/panel_layout.hpp"

namespace neritic::testbed {

struct HudPlace {
  hud::LayoutKind kind = hud::LayoutKind::kCorner;
  PanelRect rect;  // whole pixels; empty: there is no room beside the others
};

// Placed in turn: console, corner, wrist, mask. Each at its layout's place; one that would cover an
// earlier one at another edge, or smaller. The console lies under the view's whole width or height
// and leaves the others no place (fit_one_window).
std::vector<HudPlace> hud_places(std::span<const hud::LayoutKind> kinds, std::uint32_t width,
                                 std::uint32_t height);

// Whether these can lie in one window: the console shows all that the others show, over all of it.
bool fit_one_window(std::span<const hud::LayoutKind> kinds);

// What a layout at its place takes: all of it, but of the console its plates.
std::vector<PanelRect> taken_by(const HudPlace& place, const hud::Shown& shown);

}  // namespace neritic::testbed
