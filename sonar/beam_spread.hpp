// Beam patterns made discrete: how the energy of what lies in one azimuth column spreads over the
// beams of a grid, and how much of each elevation row a beam hears. Pure functions in double; any
// thread.
#pragma once

#include <cstdint>
#include <vector>

#include "sonar/beam_grid.hpp"
#include "sonar/beam_pattern.hpp"

namespace neritic::sonar {

enum class Ways {
  kOneWay,  // a broad sender, beams formed in receiving: power |a|^2 (imaging, profiling)
  kTwoWay,  // sent and received through the pattern: |a|^4 (mechanical, side-scan, echo sounder)
};

enum class Steering {
  kTurned,      // every beam has the pattern around its own axis (mechanical, lenses)
  kElectronic,  // one flat array steered by phase: beams widen towards the sides (sine law)
};

// What beams take of columns, banded. Beam b's tap t belongs to column b + t - reach (modulo beams
// where wraps). Every column's energy is kept: over the beams that hear it, its taps' energies sum
// to 1, at the grid's edges too (what would have gone beyond the edge goes to the beams there are).
struct BeamSpread {
  std::uint32_t beams = 0, reach = 0;
  bool wraps = false;             // the grid is a full turn
  std::vector<double> energy;     // [beam][2 reach + 1], 0 for columns off the grid
  std::vector<double> amplitude;  // the same, signed, its squares are energy: for coherent sums
  double truncated =
      0.0;  // largest share of a column's energy on beams beyond reach, before scaling

  std::uint32_t taps() const { return 2 * reach + 1; }
};

struct BeamSpreadOptions {
  Ways ways = Ways::kOneWay;
  Steering steering = Steering::kTurned;
  double max_truncated = 1e-2;  // in (0, 1)
};

// Beams point at the grid's azimuth columns. An energy is the pattern's power averaged over the
// column, whose contents may lie anywhere in it; the sign of an amplitude is the pattern's at the
// column's centre. kBadInput where the grid is wrong, max_truncated lies outside (0, 1), the table
// would exceed kMaxSpreadTaps, or the grid is wider than 180 degrees and steered electronically.
inline constexpr std::size_t kMaxSpreadTaps = std::size_t{1} << 24;
Result<BeamSpread> beam_spread(const BeamPattern& pattern, const BeamGrid& grid,
                               const BeamSpreadOptions& options);

// Power heard from each elevation row, averaged over the row, of a beam whose axis is at
// axis_rad; 1 where the pattern is 1. Not scaled to any sum: a beam that is narrower than the grid
// hears less of it.
std::vector<double> elevation_power(const BeamPattern& pattern, const BeamGrid& grid, Ways ways,
                                    double axis_rad = 0.0);

}  // namespace neritic::sonar
