// Cases of control from a file of the format of control_vectors.json: steps of the controller,
// thruster allocations, closed loops. Any thread.
//
// JSON. [] holds the default of a member that may be missing; at least one of the three is needed.
//   pid_sequence: KP, KI, KD, umax, imax, izone [none], each one number per axis; dt; I0 [0];
//     steps: e, nu, and of u, I what is compared
//   allocation: B_6x8; of pinv_8x6, rank, singular_values, cond, cond_length_0p2 what is compared;
//     fmax, fmin: N per thruster; cases: tau, and of f_pinv, scale, f_scaled, tau_achieved what is
//     compared
//   closed_loop: gains as above for six axes; control_hz [50];
//     plant: "Fossen + thruster lag T s, force limits +MAX/-MIN N";
//     map [optional]: "tau=M_RB*u (paper), F=scale(pinv tau)";
//     results: by "PLANT/MANOEUVRE". PLANT is neutral, fresh or sea (the BlueROV2 Heavy's
//     buoyancy); MANOEUVRE is surge_, sway_, depth_ with metres (surge_2m, depth_+1m), roll_,
//     pitch_, yaw_ with degrees (yaw_90deg), or any name with waypoints (p, yaw) and radius.
//     rise_10_90, t90, overshoot_pct, settle_s, final_error, max_tilt_deg, max_thruster_N,
//     arrival_s, end_state: compared if present. A run begins at rest at 10 m and lasts 15 s,
//     with waypoints 40 s; priority: "none" or "level", the law of missions (thrust_priority.hpp)
//     ["none"], is this project's own member
// A text under another name is not read. Other members are errors.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/case_file.hpp"
#include "rov/guidance.hpp"

namespace neritic::rov {

struct PidStep {
  std::vector<double> error, rate;       // an axis each
  std::vector<double> output, integral;  // empty: not compared
};
struct PidCase {
  std::string id;
  std::vector<PidAxis> axes;
  double dt_s = 0.0;
  std::vector<double> integral;  // at first
  std::vector<PidStep> steps;
};

struct AllocationCase {
  std::string id;
  Vec6 wrench;
  std::vector<double> wanted_n, force_n, achieved;  // empty: not compared
  std::optional<double> scale;
};
struct AllocationTable {
  std::vector<Vec6> columns;
  std::vector<std::vector<double>> inverse;  // empty: not compared
  std::optional<double> rank, condition, condition_length_0_2;
  std::vector<double> singular_values;
  std::vector<double> min_n, max_n;
  std::vector<AllocationCase> cases;
};

struct LoopCase {
  std::string id;
  double buoyancy_water_kg_m3 = 0.0;  // 0: neutral
  double lag_s = 0.1, min_n = 0.0, max_n = 0.0, duration_s = 15.0;
  ControlGains gains;
  bool level_first = false;
  // A step of one axis, or waypoints.
  std::size_t axis = 0;
  double amount = 0.0;  // m or rad
  std::vector<Waypoint> waypoints;
  double radius_m = 0.15;
  std::map<std::string, double> figures;  // by their names in the file
  std::vector<double> arrivals_s, end_state;
};

struct ControlCases {
  std::optional<PidCase> pid;
  std::optional<AllocationTable> allocation;
  std::vector<LoopCase> loops;
};

// Errors in one line: file, case, field, what was found, what is accepted.
Result<ControlCases> read_control_cases(std::string_view text, const std::string& name);

}  // namespace neritic::rov
