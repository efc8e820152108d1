// Colour maps: a value from 0 to 1 as a colour, linear between a few stops. Pure; any thread.
#pragma once

#include "engine/draw2d/color.hpp"

namespace neritic::draw2d {

enum class ColorMap {
  kCopper,  // black, umber, copper, amber, cream: polar sonar panels
  kBronze,  // black, umber, bronze, gold, cream: side-scan and scanning sonars
  kEcho,    // dark blue over green and yellow to red: echo sounders
  kDepth,   // violet (0, deep) over blue and green to red (1, shallow): charts
};

// Clamps value to 0..1; NaN counts as 0.
Color map_color(ColorMap map, double value);

}  // namespace neritic::draw2d
