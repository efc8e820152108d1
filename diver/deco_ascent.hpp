// The ascent by DecoConventions, from any depth and tissues: gas switches, the first stop, stops.
// It allocates nothing, so that a dive computer may ask it in every second. Pure functions; any
// thread.
#pragma once

#include <span>

#include "diver/dive_plan.hpp"

namespace neritic::diver {

// The constants of one ascent. Borrows conventions and gases.
struct AscentSettings {
  const DecoConventions& conventions;
  Buehlmann model;  // the conventions'
  double gf_low = 0.3, gf_high = 0.85;
  std::span<const PlanGas> gases;
  bool last_stop_always = true;
  StepFactors quantum;  // of the stop quantum
  // Bits of gases that are carried, but not there to switch to.
  std::uint64_t without = 0;
};
AscentSettings ascent_settings(const DecoConventions& conventions, double gf_low, double gf_high,
                               std::span<const PlanGas> gases, bool last_stop_always = true);

struct AscentState {
  TissueState tissues;
  double run_min = 0.0, depth_m = 0.0;
  std::size_t gas = 0;
  // Where GF low was used up in an ascent that is already under way; 0: none yet.
  double anchor_m = 0.0;
  // The stop at depth_m is yet to be made: it has at least one quantum, also in such an ascent.
  bool stop_owed = false;
};

// Receives the parts of the ascent in order.
class AscentSink {
 public:
  virtual ~AscentSink() = default;
  virtual void segment(const PlanSegment& segment) = 0;
  // At arrival at the first stop.
  virtual void first_stop(const AscentState&) {}
  virtual void stop(const PlanStop&) {}
};

enum class AscentEnd { kDirect, kStops, kNeverClears };
// Runs state to the surface, or to the depth that is never left (after 200 000 quanta).
AscentEnd ascend(const AscentSettings& settings, AscentState& state, AscentSink& sink);

// The gradient factor at a depth: GF low at the anchor and below, GF high at the surface, straight
// between. anchor_m 0: no stop has begun.
double gf_at(const AscentSettings& settings, double anchor_m, double depth_m);
// Where GF low is used up (GfAnchor) if the ascent makes its first stop at this depth; nothing
// where it goes on to the next.
std::optional<double> first_stop_anchor(const AscentSettings& settings, const AscentState& state);

// Tissues after a direct ascent on one gas.
TissueState after_direct_ascent(const AscentSettings& settings, const TissueState& tissues,
                                double depth_m, const GasMix& gas);

}  // namespace neritic::diver
