// Draws what is shown as a layout, on a transparent RGBA canvas of the layout's size times a scale.
// One thread.
#pragma once

#include "hud/painter.hpp"

namespace neritic::hud {

void draw_wrist(Painter& painter, const Shown& shown);
void draw_mask(Painter& painter, const Shown& shown);
void draw_corner(Painter& painter, const Shown& shown);
void draw_console(Painter& painter, const Shown& shown);  // draw_console.cpp
// The plates of the console, layout units; that of the alarms' band also while there is no alarm.
std::vector<Box> console_plates(const Shown& shown);
void draw(LayoutKind layout, Painter& painter, const Shown& shown);

// No-stop time, or the stop with its minutes.
void draw_limit(Painter& painter, const Box& box, const Shown& shown, double size,
                double label_size);
// The ceiling where stops are owed, the deepest depth of the dive where none is.
void draw_ceiling_or_deepest(Painter& painter, const Box& box, const Shown& shown, double size,
                             double label_size);

}  // namespace neritic::hud
