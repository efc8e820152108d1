// The parts of a polar panel that are drawn: layout, colours, rings, bearings, scale and words.
// Used by panel.cpp only. Pure functions on a canvas.
#pragma once

#include <string>

#include "sonar/beam_grid.hpp"
#include "sonar/canvas.hpp"
#include "sonar/panel.hpp"

namespace neritic::sonar {

inline constexpr Color kPanelBackground{0.035f, 0.042f, 0.052f};

// Where the fan lies: apex in pixels, pixels a metre.
struct PanelLayout {
  std::uint32_t width, height;
  double apex_x, apex_y, scale;
};
// words: with room for them.
PanelLayout lay_out(const BeamGrid& grid, std::uint32_t height_px, bool words);

// Shown brightness 0 to 1 in copper: black, umber, copper, amber, cream.
Color panel_color(double value);

// unit: the panel's height / 900 px, on which all sizes are given.
void draw_rings(Canvas& canvas, const PanelLayout& layout, const Limits& limits, double unit,
                bool words);
void draw_bearings(Canvas& canvas, const PanelLayout& layout, const Limits& limits, double unit,
                   bool words);
// What stays: the colour scale, the title and the limits.
void draw_scale(Canvas& canvas, double unit);
void draw_words(Canvas& canvas, const BeamGrid& grid, const std::string& title, double unit);
// What changes with each image: the numbers at the scale, and the words on the gain.
void draw_gain(Canvas& canvas, double full_scale, const PanelOptions& options);

}  // namespace neritic::sonar
