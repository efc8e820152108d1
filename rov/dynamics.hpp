// Motion of a vehicle in water: Fossen's equation in six degrees of freedom,
//   M_RB nu' + C_RB(nu) nu + M_A nu_r' + C_A(nu_r) nu_r + D_L nu_r + D_Q |nu_r| nu_r + g(q) = tau
// (Fossen 2011, eq. 8.1 to 8.3), nu_r = nu - [R^T v_c; 0] the velocity through the water.
// World axes north, east, down; body axes forward, starboard, down, about the body's origin.
// Pure functions without allocation; any thread.
//
// How it is computed: Newton's laws are the same in axes that move with a steady current, so the
// rigid body's terms may take nu_r as well, and all mass terms are one: with the momenta
// [P; L] = M nu_r, M = M_RB + M_A, Kirchhoff's equations give
//   M nu_r' = tau - D(nu_r) nu_r - g(q) - [w x P; w x L + v_r x P]
// which is the above exactly, the Munk moment and M_A nu_c' in a current included.
//
// Water that speeds up pulls along what floats in it: its acceleration a = Du/Dt adds to tau
//   M_A [R^T a; 0] + rho V [R^T a; r_b x R^T a],
// as on a sphere in any slowly varying flow (Auton, Hunt, Prud'homme 1988, J. Fluid Mech. 197, eq.
// 3.1, without the lift of its vorticity), so that what is neutrally buoyant and drifts goes with
// the water. nu_r then is in axes that gather speed as the current on the vehicle's way does, b =
// du/dt + (v grad) u, which takes M [R^T b; 0] off. Water that turns or shears about the vehicle
// gives no moment.
#pragma once

#include <array>
#include <cstdint>

#include "rov/vehicle.hpp"

namespace neritic::rov {

// The actions on a vehicle during one step. Plain bytes: logged and replayed as they are. fields()
// names all of them, for hashes and logs.
struct Inputs {
  Vec6 wrench;  // tau beside the thrusters', body axes, N and N m
  std::array<double, kMaxThrusters> thruster_n{};  // commands; before lag, limits and failure
  Vec3 current_ned_m_s{0.0};  // at the step's start, of all the water around the vehicle
  // How that changes where the vehicle is, as it moves: b.
  Vec3 current_change_ned_m_s2{0.0};
  Vec3 water_acceleration_ned_m_s2{0.0};  // of the water itself, Du/Dt: a
  Vec3 tether_anchor_ned_m{0.0};
  std::uint64_t failed_thrusters = 0;  // bit i: thruster i gives nothing, its lag runs out

  static void fields(auto&& field, auto& self) {
    field("wrench", self.wrench);
    field("thruster_n", self.thruster_n);
    field("current_ned_m_s", self.current_ned_m_s);
    field("current_change_ned_m_s2", self.current_change_ned_m_s2);
    field("water_acceleration_ned_m_s2", self.water_acceleration_ned_m_s2);
    field("tether_anchor_ned_m", self.tether_anchor_ned_m);
    field("failed_thrusters", self.failed_thrusters);
  }
};

struct State {
  Vec3 position_ned_m{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};  // ned_from_body
  Vec6 velocity;                      // nu, absolute, body axes
  std::array<LagState, kMaxThrusters> lag{};
  // The last good value of each input, and how many were refused (step.hpp).
  Inputs held;
  std::uint64_t refused_inputs = 0;

  static void fields(auto&& field, auto& self) {
    field("position_ned_m", self.position_ned_m);
    field("attitude", self.attitude);
    field("velocity", self.velocity);
    field("lag", self.lag);
    field("held", self.held);
    field("refused_inputs", self.refused_inputs);
  }
};

struct StateRate {
  Vec3 position_m_s{0.0};
  Quat attitude{0.0, 0.0, 0.0, 0.0};
  Vec6 velocity;  // nu', absolute
  std::array<LagState, kMaxThrusters> lag{};
};

// Precondition: state and inputs are finite. Thruster forces as the lag's state gives them.
StateRate derivative(const Vehicle& vehicle, const State& state, const Inputs& inputs);

// The command that thruster i follows: 0 where it failed, else cut to its limits.
double followed_command(const Vehicle& vehicle, const Inputs& inputs, std::size_t i);
// Force along each thruster's direction, now.
std::array<double, kMaxThrusters> thruster_forces(const Vehicle& vehicle, const State& state,
                                                  const Inputs& inputs);
// The wrench of one newton each, times the forces: B f.
Vec6 thruster_wrench(const Vehicle& vehicle, const std::array<double, kMaxThrusters>& forces_n);

// nu_r of the state in this current, and back.
Vec6 through_water(const Quat& attitude, const Vec6& velocity, const Vec3& current_ned_m_s);
Vec6 over_ground(const Quat& attitude, const Vec6& through_water, const Vec3& current_ned_m_s);

// 1/2 nu_r^T M nu_r, joule; and that of weight and buoyancy, 0 upright at the surface. In still
// water without inputs their sum never grows.
double kinetic_energy(const Vehicle& vehicle, const State& state, const Vec3& current_ned_m_s);
double potential_energy(const Vehicle& vehicle, const State& state);

// Motion through the water: what the integrators integrate.
struct WaterMotion {
  Vec3 position_ned_m{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};
  Vec6 velocity;  // nu_r
  Vec3 current_ned_m_s{0.0};
};
// wrench: everything but drag, weight, buoyancy, tether and accelerating water. Returns the rates
// in its members.
WaterMotion motion_rate(const Vehicle& vehicle, const WaterMotion& motion, const Vec6& wrench,
                        const Inputs& inputs);
// Weight, buoyancy and tether: -g(q) and the tether's pull, body axes.
Vec6 static_wrench(const Vehicle& vehicle, const WaterMotion& motion, const Inputs& inputs);
// The part of accelerating water in the rate of M nu_r, body axes; 0 in a steady, uniform current.
Vec6 water_wrench(const Vehicle& vehicle, const Quat& attitude, const Inputs& inputs);

}  // namespace neritic::rov
