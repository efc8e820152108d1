// Draws what is shown as a layout, on a transparent RGBA canvas of the layout's size times a scale.
// One thread.
#pragma once

#include "diver/jacket.hpp"
#include "hud/painter.hpp"

namespace neritic::hud {

void draw_wrist(Painter& painter, const Shown& shown);
void draw_mask(Painter& painter, const Shown& shown);
void draw_corner(Painter& painter, const Shown& shown);
void draw_console(Painter& painter, const Shown& shown);  // draw_console.cpp
// The plates of the console, layout units; that of the alarms' band also while there is no alarm.
std::vector<Box> console_plates(const Shown& shown);
// Where a display lays the pictures of the sonar and of the camera over the console, layout units;
// nothing where there is none.
std::optional<Box> sonar_place(const Shown& shown);
std::optional<Box> camera_place(const Shown& shown);
void draw(LayoutKind layout, Painter& painter, const Shown& shown);

// The jacket's buttons, as a diver sees which are pressed.
struct JacketKey {
  std::uint64_t bit;
  const char* word;
};
inline constexpr JacketKey kJacketKeys[] = {
    {diver::kInflate, "INFLATE"}, {diver::kDeflate, "DEFLATE"}, {diver::kDump, "DUMP"}};
// Two cells: the gas in the jacket, its lift.
void draw_jacket_cells(Painter& painter, const Box& gas, const Box& lift, const Shown& shown,
                       double size, double label_size);
// These, the keys, and under them how full the jacket is.
void draw_jacket_row(Painter& painter, const Box& box, const Shown& shown, double size,
                     double label_size);

// No-stop time, or the stop with its minutes.
void draw_limit(Painter& painter, const Box& box, const Shown& shown, double size,
                double label_size);
// The ceiling where stops are owed, the deepest depth of the dive where none is.
void draw_ceiling_or_deepest(Painter& painter, const Box& box, const Shown& shown, double size,
                             double label_size);

}  // namespace neritic::hud
