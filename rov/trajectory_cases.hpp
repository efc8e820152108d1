// Cases of trajectories from a file of the form rov_vectors/1: a vehicle, inputs over time, and
// samples of an accurate solution. Any thread.
//
// The form, as such files document it (JSON; what is optional has its default in brackets):
//   thrusters: position_frd_m, direction_frd, rows of three [the BlueROV2 Heavy's eight]
//   scenarios: list of
//     id [case N]
//     params: m_kg, I_CO_kgm2 (rows or a diagonal), r_g_m, r_b_m [0], M_A, D_L (rows or a diagonal)
//       [0], D_Q_diag [0], W_N [9.82 m], B_N [W]
//     current_ned_mps [0]; initial: p_ned [0], q_wxyz [1, 0, 0, 0], nu_frd [0]
//     thruster_mode: none, force (at once), lag1, vb3 [none]; vb_poly and t200_16V are force too
//     lag1_T_s, or T, in the case, its params or in thrusters: T of lag1, s; or "T = 0.1" in the
//     text
//       of thrusters.lag1 or doc
//     input_segments: t0, t1, tau_body [0], thruster_force_cmd_N [0]; outside of all: 0
//     input_normalised_V, input_pwm_us: a row a segment, where no force is given: F of vb_poly, or
//       by the column thrust_N_16V of t200_thrust.csv beside the file
//     tau_sin: tau += amplitude sin(omega t + phase), t the case's time; an object or a list of
//     them
//       (sine_wrench.hpp) [none]
//     samples: t, and of p_ned, q_wxyz, nu_frd, thruster_force_N what is compared
//     fixed_step_end_error: {rk4_60Hz: [position, velocity], ...} [none]
//     reference_error_estimate: how wrong the samples are, in any of their numbers [0]
// Other members (doc, closed_form, ...) are notes and are passed over; in params, initial and
// input_segments texts alone are, and others are errors.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/case_file.hpp"
#include "rov/sine_wrench.hpp"
#include "rov/vehicle.hpp"

namespace neritic::rov {

struct InputSegment {
  double t0_s = 0.0, t1_s = 0.0;
  Vec6 wrench;
  std::array<double, kMaxThrusters> thruster_n{};
  std::vector<SineWrench> sines;
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
  std::vector<SineWrench> sines;
  std::vector<TrajectorySample> samples;  // rising
  std::vector<PromisedError> promised;
  double reference_error = 0.0;
};

// Errors in one line: file, case, field, what was found, what is accepted. folder: the file's.
Result<std::vector<TrajectoryCase>> read_trajectories(std::string_view text,
                                                      const std::string& name,
                                                      const std::filesystem::path& folder = {});

}  // namespace neritic::rov
