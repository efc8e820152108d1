// The parts of a polar panel: layout, rings, bearings, colour scale and text. Used by panel.cpp and
// trace_panel.cpp only. Pure functions on a canvas.
#pragma once

#include <string>

#include "engine/draw2d/canvas.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/panel.hpp"

namespace neritic::sonar {

// Where the fan lies: its apex in pixels, and its scale in pixels per metre.
struct PanelLayout {
  std::uint32_t width, height;
  double apex_x, apex_y, scale;
};
// words: whether to leave room for text.
PanelLayout lay_out(const BeamGrid& grid, std::uint32_t height_px, bool words);

// unit: the panel's height / 900, in pixels; all sizes are multiples of it.
void draw_rings(draw2d::Canvas& canvas, const PanelLayout& layout, const Limits& limits,
                double unit, bool words);
void draw_bearings(draw2d::Canvas& canvas, const PanelLayout& layout, const Limits& limits,
                   double unit, bool words);
// The parts that no image changes: the colour scale, the title and the limits.
void draw_scale(draw2d::Canvas& canvas, double unit);
void draw_words(draw2d::Canvas& canvas, const BeamGrid& grid, const std::string& title,
                double unit);
// The parts that change with the image: the numbers at the scale, and the line on the gain.
void draw_gain(draw2d::Canvas& canvas, double full_scale, const PanelOptions& options);

}  // namespace neritic::sonar
