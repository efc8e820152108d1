// Where the panels of a window lie, so that none leaves it, none covers another or a diver's
// instrument, and the middle of the picture stays free. What has no room is left out: first sonars,
// from the last one, then the panels on demand, from the last one, then the status, the hint, the
// readout of compass and depth. Units: points, pixels at a scale of 1; x to the right, y down. Pure
// function; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace neritic::testbed {

struct PanelRect {
  float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;  // no size: there is no room for it
  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool empty() const { return !(width > 0.0f && height > 0.0f); }
  bool operator==(const PanelRect&) const = default;
};
bool overlap(const PanelRect& a, const PanelRect& b);

// A sonar's panel but for its fan: title, settings, the labels beside and above the fan.
struct FanFrame {
  float margin_x = 44.0f;  // on each side
  float above_and_below = 84.0f;
};
// The height of a panel of that width; aspect: of the fan, height over width. A tall fan is no
// higher than its panel is wide.
float fan_panel_height(float width, float aspect, const FanFrame& frame = {});

// The height of a panel that is shown on demand: as much as there is room for, up to wanted.
struct PanelWish {
  float wanted = 0.0f, least = 0.0f;
};

struct PanelLayout {
  PanelRect status, readout, hint;
  std::vector<PanelRect>
      extras;                   // of each wish, below the status, else at the right; empty: no room
  std::vector<PanelRect> fans;  // of the first ones; for the others there is no room
};

// status_height: that it wants. fan_aspects: of each sonar's fan; extras come before fans.
// taken: by a diver's instruments.
PanelLayout lay_out(float width, float height, float status_height,
                    std::span<const float> fan_aspects, std::span<const PanelWish> wishes = {},
                    std::span<const PanelRect> taken = {});

}  // namespace neritic::testbed
