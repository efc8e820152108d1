// How far a point spreads along range: the matched filter's envelope of a pulse of given
// bandwidth, and the kernel that it makes over range bins. Pure functions in double; any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::sonar {

// The pulse's spectrum over its band, which is all that the matched filter's envelope knows.
enum class PulseShape {
  kFlat,  // an unweighted chirp: envelope |sinc|, first side lobe -13.26 dB
  kHann,  // Hann-weighted: side lobe -31.47 dB, main lobe twice as wide from null to null
};

// c / 2B: two points nearer than that merge (Urick 1983, ch. 2). 29.9 kHz at 1500 m/s: 25.08 mm.
double range_resolution_m(double sound_speed_m_s, double bandwidth_hz);

// Signed envelope, 1 at 0, of a point offset_m from its true range, resolution_m = c / 2B:
// sinc(x) or sinc(x) + (sinc(x-1) + sinc(x+1)) / 2, with x = offset / resolution and
// sinc(x) = sin(pi x) / (pi x) (Harris 1978, Proc. IEEE 66, 51).
double pulse_envelope(PulseShape shape, double offset_m, double resolution_m);
// Length of a rectangular pulse with the envelope's peak and energy: 1 (flat) or 3/2 (Hann) c / 2B,
// by Parseval. An area that returns the power w a metre of range is heard at w times this length.
double pulse_length_m(PulseShape shape, double resolution_m);
// The pulse's energy from -infinity to offset_m over its whole energy, 0 to 1.
double pulse_energy_below(PulseShape shape, double offset_m, double resolution_m);

// Where in its range bin a point lies, which a gather's sums no longer tell.
enum class PlaceInBin {
  kMiddle,
  kAnywhere,  // the mean over all places, which is also an area's that fills the bin
};

// The shares of its energy that a point gives to its own range bin and the bins around it.
struct RangeSpread {
  std::uint32_t reach = 0;     // bins to either side: 2 reach + 1 taps, the middle one its own bin
  std::vector<double> energy;  // shares of its energy, summing to 1
  // Signed amplitudes whose squares are energy: for coherent sums. The sign is the envelope's in
  // the bin's middle.
  std::vector<double> amplitude;
  double truncated =
      0.0;  // share of the energy that lay beyond reach, before taps were scaled to 1
  // pulse_length_m in bins. Times energy: a bin's mean power for a point whose peak power is 1.
  double pulse_bins = 1.0;
};

// Each tap is the pulse's energy within the bin, so bins of any width, coarser or finer than the
// resolution, keep the energy. Reach: as few bins as leave max_truncated out. kBadInput where a
// length is not positive, max_truncated is not in (0, 1) or reach would exceed kMaxReach.
inline constexpr std::uint32_t kMaxReach = 4096;
Result<RangeSpread> range_spread(PulseShape shape, double resolution_m, double bin_m,
                                 double max_truncated = 1e-2,
                                 PlaceInBin place = PlaceInBin::kMiddle);

}  // namespace neritic::sonar
