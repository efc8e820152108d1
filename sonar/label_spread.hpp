// Labels by energy after beam pattern and pulse: the energy of each (class, instance) is spread by
// the same taps as the field, at the host. Pure function; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sonar/label_energy.hpp"

namespace neritic::sonar {

// A kernel of powers: weights[k] is for the value at distance first + k. Empty: no spread.
struct PowerTaps {
  int first = 0;
  std::vector<float> weights;  // [kernels][size]: beam b's is the b-th, or the last
  std::uint32_t kernels = 1;
  int size() const { return static_cast<int>(weights.size() / kernels); }
};

struct LabelSpread {
  std::uint32_t n_range = 0, n_beams = 0, n_columns = 0;  // of the gather: margins counted
  std::uint32_t stride = 1;  // beam b's kernel across is counted from column b * stride
  bool wrap = false;         // a full turn: the columns are a ring
  PowerTaps across, range;   // across without taps: column b is beam b
  std::vector<float> gain;   // of power, a range bin
  double first_shift = 0.0,
         shift = 0.0;  // columns that bearings turn until row 0, and from row to row
};

// Taps 30 dB or more below a kernel's peak fill no bin: a bin in the far side lobes of a bright
// object stays water or shadow.
inline constexpr float kLeastPart = 1e-3f;

// A hidden bin stays shadow while what spills into it is so much weaker, in power, than what its
// surroundings hear: 10 dB, which shows as dark in a picture.
inline constexpr float kShadowPart = 0.1f;

// records: [rows][n_columns], of the direct rays and each mirror's. labels: what
// label_by_energy made of the same rays; every bin that the spread fills is written anew: the
// (class, instance) of most energy, ties to the smaller, and its part of all. But a bin of shadow
// stays one if it hears kShadowPart or less of its surroundings: the middle of the nearest bins to
// either side at its range that are heard and in no shadow, the quieter side's; or, if there are
// none at its range, of those behind it in its beam. Cost: a few operations a bin that an instance
// fills, beam that hears it and tap.
void spread_labels(std::span<const EnergyRecord> records, const LabelSpread& spread,
                   LabelImage& labels);

}  // namespace neritic::sonar
