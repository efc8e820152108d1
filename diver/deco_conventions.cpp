#include "diver/deco_conventions.hpp"

#include <array>
#include <string>

#include "diver/oxygen_exposure.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// Stops end on whole minutes of the run time, as what a diver writes on a slate; tissues get the
// ascent's credit.
DecoConventions run_minutes() {
  DecoConventions c;
  c.table = BuehlmannTable::kC;
  c.start_n2 = 0.781;
  c.environment.bar_per_m = bar_per_m_of(1030.0);
  c.stop_end = StopEnd::kWholeRunTime;
  c.leaving = LeavingTrial::kTissuesAfterAscent;
  c.first_stop = FirstStop::kStepByStep;
  c.gf_anchor = GfAnchor::kCeiling;
  c.cns_from_bar = kCnsFromTable_bar;
  return c;
}

// Metres of sea water: 10 a bar, 1 bar at the surface, water vapour by a respiratory quotient of
// 0.9.
DecoConventions msw() {
  DecoConventions c;
  c.water_vapour_bar = 0.0567;
  c.start_n2 = 0.79;
  c.environment = kTenMetresABar;
  c.stop_end = StopEnd::kWholeRunTime;
  c.direct_ascent = false;
  return c;
}

}  // namespace

std::span<const NamedConventions> convention_sets() {
  static const std::array<NamedConventions, 3> sets{
      {{"stop-minutes",
        "whole minutes at each stop, no credit for the ascent to the next; table B, 1b",
        DecoConventions{}},
       {"run-minutes", "stops end on whole minutes of run time, credit for the ascent; table C, 1b",
        run_minutes()},
       {"msw", "10 m a bar, stops end on whole minutes of run time, no credit; table B, 1b",
        msw()}}};
  return sets;
}

Result<DecoConventions> conventions_of(std::string_view name) {
  std::string names;
  for (const NamedConventions& set : convention_sets()) {
    if (set.name == name) return set.conventions;
    names += (names.empty() ? "" : ", ") + std::string(set.name);
  }
  return refusal("", fmt::format("convention '{}'", name.substr(0, 40)), fmt::format("{}", names));
}

}  // namespace neritic::diver
