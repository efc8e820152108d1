// The differences between programs of the same model, each a field, and named sets of them. The
// differences are no errors of anybody: ZH-L16 says what tissues tolerate, not how an ascent is put
// into whole minutes. Plain values; any thread.
#pragma once

#include <span>
#include <string_view>

#include "diver/buehlmann.hpp"
#include "diver/deco_environment.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

// When a stop ends: after whole multiples of the quantum at it, or when the run time is one.
enum class StopEnd { kWholeStop, kWholeRunTime };
// The test before a stop is left: the next depth against the tissues as they are, or as they
// will be when it is reached.
enum class LeavingTrial { kTissuesAtStop, kTissuesAfterAscent };
// How the first stop is found: by rising to the ceiling of GF low, again and again while it
// recedes, or step by step as all stops are left.
enum class FirstStop { kRecedingCeiling, kStepByStep };
// Where GF low is used up: at the first stop, or at the ceiling of GF low when that begins, at
// least 1 bar below the surface.
enum class GfAnchor { kFirstStop, kCeiling };

struct DecoConventions {
  BuehlmannTable table = BuehlmannTable::kB;
  FirstCompartment first_compartment = FirstCompartment::k5Min;
  double water_vapour_bar = 0.0627;
  double start_n2 = 0.7902;  // of a diver who has not dived
  DecoEnvironment environment;
  StopEnd stop_end = StopEnd::kWholeStop;
  LeavingTrial leaving = LeavingTrial::kTissuesAtStop;
  FirstStop first_stop = FirstStop::kRecedingCeiling;
  GfAnchor gf_anchor = GfAnchor::kFirstStop;
  // Stops are left out altogether where a direct ascent ends within GF high.
  bool direct_ascent = true;
  double stop_step_m = 3.0, stop_quantum_min = 1.0, last_stop_m = 3.0;
  double descent_m_min = 20.0, ascent_m_min = 10.0;
  double cns_from_bar = 0.5;
  double saturation = 1.0, desaturation = 1.0;  // see Buehlmann

  Buehlmann model() const {
    Buehlmann made = buehlmann(table, first_compartment, water_vapour_bar);
    made.saturation = saturation;
    made.desaturation = desaturation;
    return made;
  }
};

struct NamedConventions {
  std::string_view name, meaning;
  DecoConventions conventions;
};
// The first is the default.
std::span<const NamedConventions> convention_sets();
Result<DecoConventions> conventions_of(std::string_view name);

}  // namespace neritic::diver
