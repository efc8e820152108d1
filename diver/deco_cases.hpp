// Cases of decompression from a file of the form of deco_vectors: dives with what a planner of the
// same conventions found, and tables of times without stops. Any thread.
//
// The form, as such files document it (JSON; bar, m, min; what is optional has its default in
// brackets; what is not named here is ignored, but a parameter, a member of reference, of its
// points, of oxygen_exposure, that is one of these but for capitals, or begins or goes on as one,
// is an error, and so is all but a text that is said of earlier dives under a name that is not
// here; of all that is expected, what is there is compared):
//   tolerances: tissues_bar [1e-6], ndl_continuous_min [1e-3], stop_minutes [exact: 1e-3]
//   profiles: a list of
//     id; model: a text with 16B or 16C; coefficient_table: a text with "compartment 1b" or
//       "compartment 1 " [1b for B, 1 for C]
//     parameters: gf_low, gf_high; surface_pressure_bar [of altitude_m]; bar_per_metre [of
//       water_density_kg_m3 and gravity_m_s2]; water_vapour_pressure_bar [.0627],
//       start_n2_fraction [.7902], descent_rate_m_min [20], ascent_rate_m_min [10], stop_step_m
//       [3], stop_quantum_min [1], last_stop_m [stop_step_m], saturation, desaturation [1: times
//       the speed at which gas goes in and out]
//     gases: a list of o2, he [0], n2 (percent), switch_depth_m [0], role travel, bottom, deco
//       [bottom for the first, deco for the rest]
//     profile: kind square with depth_m, bottom_runtime_min; or multilevel with levels: a list of
//       depth_m, leave_runtime_min
//     initial_tissues [those of repetitive, or saturated]: 16 rows of nitrogen, helium
//     repetitive: what was dived before. One dive: first_dive (depth_m, bottom_runtime_min or
//     levels;
//       gases [the case's]; parameters that differ), surface_interval_min, surface_interval_gas
//       ["air" or "O2/He"], and expected: first_dive_stops (rows of depth, minutes),
//       first_dive_runtime_min, tissues_at_surfacing, tissues_after_interval. Several: second_dive,
//       third_dive, to the sixth, likewise with surface_interval_min a list; or a list of dives,
//       oldest first, as repetitive, or in it under any name, each with its own
//       surface_interval_min and with stops, runtime_min and the tissues expected of it; or a dive
//       has its own repetitive, of what was dived before it. stops, runtime_min,
//       tissues_at_surfacing, tissues_after_interval may stand in a dive, or beside it after its
//       ordinal (second_dive_tissues_at_surfacing), once; tissues with no ordinal are those of the
//       last of the dives that they stand beside, or a list of one table a dive
//     segments: columns (from_m, to_m, minutes, o2_percent, he_percent, phase) and rows: replayed
//     reference: end_of_bottom, first_stop, stops, surfacing, and so on: expected
//       (DecoExpected). A first stop shallower than last_stop_m, in stops or in first_stop, stands
//       for a planner that made it
//     oxygen_exposure: cns_percent, otu, max_po2_bar: expected
//     second_opinions: by program, each with total_stop_time_min, or stops whose minutes include
//       the ways between them, or runtime_leaving_last_stop_min, total_runtime_min: expected within
//       15 % or 3 min of total stop time, as such files say, of the set of conventions that is
//       nearest to the program's (subsurface: run-minutes, baker_gfdeco: msw; of others the set
//       that their conventions name, else the case's own), on the column of ZH-L16 that their table
//       names (a text with B or C); end_of_bottom_tissues_n2_he_bar within .005 bar,
//       start_of_deco_zone_m within .2 m, cns_percent within 15 % and 1, otu within 5 % and .5
//   ndl_tables: a list of model, gf_high, o2 (he: none), surface_pressure_bar, bar_per_metre,
//     descent_rate_m_min, ascent_rate_m_min, rows: depth_m, decotengu_runtime_min,
//     decotengu_runtime_whole_min, closed_form_time_at_depth_min, controlling_compartment; null is
//     no limit
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
  std::string set;  // of conventions; empty: the case's own
  std::optional<BuehlmannTable> table;
  // What the program gives of these.
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
  std::vector<EarlierCase> earlier;
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
  // Tolerances. Stops are exact where they differ by less than this.
  double tissues_bar = 1e-6, ndl_min = 1e-3, stop_min = 1e-3;
  std::vector<DecoCase> dives;
  std::vector<NdlTable> tables;
};

// name stands in messages. Errors say file, case, field, what was found, what is accepted.
Result<DecoCases> read_deco_cases(std::string_view text, std::string name);

}  // namespace neritic::diver
