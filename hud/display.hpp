// The display of a computer that a diver wears, as others see it on the wrist: depth, no-stop time
// or the stop and its minutes, dive time, ceiling or deepest depth, tank and time to the surface.
// It has no memory: it follows from the data and the time alone, alarms too. Pure functions; any
// thread with its own painter.
#pragma once

#include "hud/painter.hpp"

namespace neritic::hud {

// Pixels at a scale of 1, opaque; the models' displays have this shape
// (tools/assets/diver_trim.py).
inline constexpr std::uint32_t kDisplayWidth_px = 240, kDisplayHeight_px = 200;

// seen_s: as in step_alarms.
Shown shown_on_display(Units units, const DiveData& data, double seen_s);
void draw_display(Painter& painter, const Shown& shown);

}  // namespace neritic::hud
