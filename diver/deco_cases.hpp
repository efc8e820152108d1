// Cases of decompression from a file of the format of deco_vectors.json: dives with the results of
// a planner of the same conventions, and tables of times without stops. Any thread.
//
// JSON; bar, m, min, gases in percent. [] holds the default of a member that may be missing.
// Every expected value that a file has is compared.
//   tolerances: tissues_bar [1e-6], ndl_continuous_min [1e-3]
//   profiles: list of
//     id; model: "ZH-L16B-GF" (first compartment 1b, 5 min) or "ZH-L16C-GF" (1, 4 min)
//     parameters: gf_low, gf_high; surface_pressure_bar [of altitude_m]; bar_per_metre [of
//       water_density_kg_m3 and gravity_m_s2]; water_vapour_pressure_bar [0.0627],
//       start_n2_fraction [0.7902], descent_rate_m_min [20], ascent_rate_m_min [10], stop_step_m
//       [3], stop_quantum_min [1], last_stop_m [stop_step_m]
//     gases: list of o2, he [0], n2 [the rest], switch_depth_m [0], role: travel, bottom or deco
//       [bottom for the first, deco for the others]
//     profile: kind square with depth_m, bottom_runtime_min; or kind multilevel with levels: list
//       of depth_m, leave_runtime_min
//     initial_tissues [after repetitive, or saturated]: 16 rows of nitrogen, helium
//     repetitive [none]: one dive before: first_dive (depth_m, bottom_runtime_min, gases [the
//       case's]), surface_interval_min; surface_interval_gas ["air 21/0 (N2 0.79), surface
//       pressure, Schreiner with R=0"]: "NAME O2/HE (N2 SHARE), " and the same end, of any gas
//       whose label, percents and share agree; expected: first_dive_stops (rows of depth,
//       minutes), first_dive_runtime_min, tissues_at_surfacing, tissues_after_interval
//     segments: replayed: columns (from_m, to_m, minutes, o2_percent, he_percent, phase) and rows
//     reference: end_of_bottom, first_stop, surfacing (points), stops (depth_m, minutes, o2, he,
//       gf_next), no_deco, total_stop_time_min, time_to_surface_min, total_runtime_min,
//       ndl_bottom_gas_runtime_min (whole_minutes, continuous; null: no time): expected. A first
//       stop shallower than last_stop_m, in stops or in first_stop, is a planner's that made it
//     oxygen_exposure: cns_percent, otu, max_po2_bar: expected
//     second_opinions: subsurface (conventions run-minutes) and baker_gfdeco
//       (conventions msw), each with total_stop_time_min, or stops whose minutes include the ways
//       between them, runtime_leaving_last_stop_min, total_runtime_min: expected within 15 % or
//       3 min of total stop time; end_of_bottom_tissues_n2_he_bar within 0.005 bar,
//       start_of_deco_zone_m within 0.2 m, cns_percent within 15 % and 1, otu within 5 % and 0.5
//   ndl_tables: list of model, gf_low, gf_high, o2, surface_pressure_bar, bar_per_metre,
//     descent_rate_m_min, ascent_rate_m_min, rows: depth_m, decotengu_runtime_min,
//     decotengu_runtime_whole_min, closed_form_time_at_depth_min, controlling_compartment; null is
//     no limit
// units, conventions_of_reference and texts under other names are not read. Other members are
// errors.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diver/dive_plan.hpp"

namespace neritic::diver {

// A number that a file expects; nothing: it is not compared.
using Expected = std::optional<double>;

struct ExpectedStop {
  double depth_m = 0.0, minutes = 0.0;
  Expected gf_next;
  std::optional<GasMix> mix;
};

struct ExpectedPoint {
  Expected run_min, depth_m, pressure_bar;
  std::optional<TissueState> tissues;
  // Tolerated pressures of all compartments under GF low, high and 1.
  std::vector<double> low_bar, high_bar, full_bar;
  Expected leading_low, leading_bar, low_m, high_m, deepest_high_bar;
};

struct ExpectedNdl {
  bool given = false;  // and then nothing: never without stops
  Expected continuous_min, whole_min;
};

struct SecondOpinion {
  std::string program;
  std::string set;  // of conventions
  // The values that the reference program printed; absent where it printed none.
  Expected stop_min, stops_and_ways_min, leave_last_min, run_min;
  Expected zone_m, cns_percent, otu;
  std::optional<TissueState> tissues;  // at the end of the bottom
  double band_min = 0.0;
};

struct DecoExpected {
  std::optional<ExpectedPoint> end_of_bottom, first_stop, surfacing;
  std::optional<std::vector<ExpectedStop>> stops;
  Expected no_stops;  // 1 or 0
  Expected stop_min, ascent_min, run_min;
  ExpectedNdl ndl;
  Expected cns_percent, otu, max_po2_bar;
  std::vector<SecondOpinion> opinions;
};

struct EarlierCase {
  EarlierDive earlier;
  std::optional<std::vector<ExpectedStop>> stops;
  Expected run_min;
  std::optional<TissueState> surfacing, after_interval;
};

struct ReplayedSegment {
  double from_m = 0.0, to_m = 0.0, minutes = 0.0;
  GasMix mix;
};

struct DecoCase {
  std::string id;
  DivePlanRequest request;  // its start: initial_tissues, where the file has them
  std::optional<EarlierCase> earlier;
  std::vector<ReplayedSegment> segments;
  DecoExpected expected;
};

struct NdlRow {
  double depth_m = 0.0;
  Expected run_min, whole_min, closed_min, compartment;
  // Null is said of the run time, or of the time in closed form: there is no limit, or none without
  // stops.
  bool no_run_limit = false, no_closed_limit = false;
};
struct NdlTable {
  std::string id;
  DivePlanRequest request;  // its level is a row's
  std::vector<NdlRow> rows;
};

struct DecoCases {
  double tissues_bar = 1e-6, ndl_min = 1e-3;  // tolerances
  std::vector<DecoCase> dives;
  std::vector<NdlTable> tables;
};

// name stands in messages. Errors say file, case, field, what was found, what is accepted.
Result<DecoCases> read_deco_cases(std::string_view text, std::string name);

}  // namespace neritic::diver
