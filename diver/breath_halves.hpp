// Whether the bursts of a rhythm alternate: breathing in and breathing out are bursts that may
// sound nearly alike. Pure functions; any thread.
#pragma once

#include "diver/breath_rhythm.hpp"

namespace neritic::diver {

// The phase of a rhythm near hz at each frame, in turns, from 0 on, never falling: breaths are not
// equally long. It follows what four periods say together; `components` as in breath_rhythm.cpp.
Levels turns_of(const std::vector<Levels>& components, double hz);

inline constexpr std::size_t kLeastBursts = 4;

// How far the levels of odd turns lie from those of even ones, a drift set apart, as a deviate of
// the standard normal distribution: 2 and more by chance in 2 % of all rhythms in which turns do
// not alternate. Fewer than kLeastBursts turns tell nothing: 0.
double alternation(const std::vector<Levels>& bands, const Levels& turns);

}  // namespace neritic::diver
