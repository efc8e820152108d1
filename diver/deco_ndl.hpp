// How long a diver may stay without stops. Pure functions; any thread. Minutes.
#pragma once

#include <optional>

#include "diver/deco_ascent.hpp"

namespace neritic::diver {

// Longer than this is without limit.
inline constexpr double kNoLimit_min = 1e6;

// More minutes at this depth on this gas after which a direct ascent still ends with the ceiling of
// GF high at or above the surface. Negative: not even at once. kNoLimit_min: any time.
double minutes_without_stops(const AscentSettings& settings, const TissueState& tissues,
                             double depth_m, const GasMix& gas);

// Largest run time of a dive to one depth, the way down included, before stops are due; nothing
// where even turning at once needs them. Uses the request's first level.
Result<std::optional<double>> run_time_without_stops(const DivePlanRequest& request);

// The same with instantaneous descent and no credit for the ascent, for nitrogen alone, in closed
// form (Buehlmann; Haldane's equation solved for time):
//   t = -T / ln 2 ln((p_i - M) / (p_i - p_0)), M = P_surface (gf / b + 1 - gf) + a gf
// least over the compartments.
struct ClosedNdl {
  double minutes = kNoLimit_min;
  std::size_t compartment = 0;  // 0 is the first
};
ClosedNdl closed_form_ndl(const Buehlmann& model, const DecoEnvironment& where, double start_n2,
                          double depth_m, const GasMix& gas, double gf);

}  // namespace neritic::diver
