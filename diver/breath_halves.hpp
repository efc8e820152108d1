// Whether the bursts of a rhythm alternate: breathing in and breathing out are bursts that may
// sound nearly alike. Pure functions; any thread.
#pragma once

#include "diver/breath_rhythm.hpp"

namespace neritic::diver {

// How far the levels of odd bursts lie from those of even ones, a drift set apart: squares of
// deviations over their error, the mean of all bands, of the quarter of a burst's period where it
// is largest. Bursts that are alike give 1 to 5. 0: fewer than eight bursts, which cannot tell.
double alternation(const std::vector<Levels>& bands, double bursts_hz);

}  // namespace neritic::diver
