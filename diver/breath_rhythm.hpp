// The rhythm that the levels of several bands share: where loudness alone is alike in and out, the
// colour of the sound is not. Pure functions; any thread.
#pragma once

#include <vector>

namespace neritic::diver {

using Levels = std::vector<double>;  // kBreathFrames_hz of them a second

// |sum of x e^{-i 2 pi f t}|^2 at f = 0, step_hz, 2 step_hz, ... up to count of them; t in frames
// of kBreathFrames_hz.
std::vector<double> line_powers(const Levels& x, double step_hz, std::size_t count);

// The top of a parabola through three values, one apart: its place, from -0.5 to 0.5; 0: no top.
double parabola_top(double before, double here, double after);

inline constexpr double kUnsureConfidence = 0.8;
struct Rhythm {
  double rate_hz = 0.0;     // 0: none, or faster than kFastestBreath_hz
  double confidence = 0.0;  // the share of sounds without rhythm whose best line is weaker
  // The rate may be twice the breath's, or half of it: bursts sound alike or may alternate. The
  // confidence is kUnsureConfidence at most.
  bool unsure = false;
  // The two halves of a breath hardly differ: the rate may be half of the breath's.
  bool weak = false;
  // Bursts alternate: a breath is longer than the window can measure; rate_hz and confidence are 0.
  bool slower = false;
  // Too few bursts to say whether they alternate, and a line at half of the rate stands out: a
  // longer window tells.
  bool doubtful = false;
};

// The rhythm of levels of equal length, each with mean 0 and deviation about 1. Principal
// components of all bands, each scaled to the same power: the first is the loudness, the next the
// colour, which tells breathing in from breathing out. The rhythm is the line of their summed
// spectra with the most power, half of the power at its double included; its rate, the turns that
// the sound makes near that line (breath_halves.hpp), since breaths are not equally long. Bursts of
// which every second one differs make it a breath of half the rate.
// deviation: that of the liveliest band before it was scaled, nepers of power.
Rhythm common_rhythm(const std::vector<Levels>& bands, double deviation);

}  // namespace neritic::diver
