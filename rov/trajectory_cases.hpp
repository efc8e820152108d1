// Cases of trajectories from a file of the format rov_vectors/1: a vehicle, inputs over time, and
// samples of an accurate solution. Any thread.
//
// JSON, world NED, body FRD. [] holds the default of a member that may be missing.
//   format ["rov_vectors/1"]
//   thrusters: position_frd_m, direction_frd: rows of three [the BlueROV2 Heavy's eight]
//   scenarios: list of
//     id [case N]
//     params: m_kg, I_CO_kgm2 (3 rows of 3), r_g_m, r_b_m [0], M_A, D_L (6 rows of 6) [0],
//       D_Q_diag [0], W_N [9.82 m], B_N [W]
//     current_ned_mps [0]; initial: p_ned [0], q_wxyz [1, 0, 0, 0], nu_frd [0]
//     thruster_mode: none, force (at once), lag1, vb3, vb_poly, t200_16V (both at once) [none]
//     thruster_time_constant_s: T of lag1, which needs it
//     input_segments: t0, t1, tau_body [0], thruster_force_cmd_N [0]; outside of all: 0
//     input_normalised_V, input_pwm_us: one row of eight per segment, used where the segment gives
//       no force: F of vb_poly, or column thrust_N_16V of t200_thrust.csv beside the file
//     tau_sin: null or {A, omega (rad/s), phase (rad)}, six numbers each: A sin(omega t + phase)
//       is added to the wrench, t being the case's time [null]
//     samples: t, and of p_ned, q_wxyz, nu_frd, thruster_force_N what is compared
//     fixed_step_end_error: {rk4_60Hz: [position, velocity], ...} [none]
//     reference_error_estimate: how wrong the samples may be, in any of their numbers [0]
// conventions, equations, sources, allocation_6x8, pinv_8x6, quat_norm_error and closed_form are
// not read, nor is any text under another name. Other members are errors.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/case_file.hpp"
#include "rov/vehicle.hpp"

namespace neritic::rov {

// A wrench that swings as a sine on each axis.
struct SineWrench {
  Vec6 amplitude, rad_s, phase_rad;

  Vec6 at(double t_s) const {
    Vec6 out;
    for (std::size_t i = 0; i < 6; ++i)
      if (amplitude[i] != 0.0) out[i] = amplitude[i] * std::sin(rad_s[i] * t_s + phase_rad[i]);
    return out;
  }
};

struct InputSegment {
  double t0_s = 0.0, t1_s = 0.0;
  Vec6 wrench;
  std::array<double, kMaxThrusters> thruster_n{};
};

struct TrajectorySample {
  double t_s = 0.0;
  std::optional<Vec3> position_ned_m;
  std::optional<Quat> attitude;
  std::optional<Vec6> velocity;
  std::vector<double> thruster_n;  // empty: not compared
};

// The error at the end that the file's own fixed-step integrator had.
struct PromisedError {
  std::string integrator;  // "rk4", "semi_euler"
  double hz = 0.0, position_m = 0.0, velocity = 0.0;
};

struct TrajectoryCase {
  std::string id;
  Vehicle vehicle;
  Vec3 current_ned_m_s{0.0}, position_ned_m{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};
  Vec6 velocity;
  std::vector<InputSegment> segments;  // in order, apart or touching
  std::optional<SineWrench> sine;
  std::vector<TrajectorySample> samples;  // rising
  std::vector<PromisedError> promised;
  double reference_error = 0.0;
};

// Errors in one line: file, case, field, what was found, what is accepted. folder: the file's.
Result<std::vector<TrajectoryCase>> read_trajectories(std::string_view text,
                                                      const std::string& name,
                                                      const std::filesystem::path& folder = {});

}  // namespace neritic::rov
