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
#pragma once

#include <array>
#include <cstdint>

#include "rov/vehicle.hpp"

namespace neritic::rov {

// What acts on a vehicle during one step. Plain bytes: logged and replayed as they are. fields()
// names all of them, for hashes and logs.
struct Inputs {
  Vec6 wrench;  // tau beside the thrusters', body axes, N and N m
  std::array<double, kMaxThrusters> thruster_n{};  // commands; before lag, limits and failure
  Vec3 current_ned_m_s{0.0};  // steady during the step, of all the water around the vehicle
  Vec3 tether_anchor_ned_m{0.0};
  std::uint64_t failed_thrusters = 0;  // bit i: thruster i gives nothing, its lag runs out

  static void fields(auto&& field, auto& self) {
    field("wrench", self.wrench);
    field("thruster_n", self.thruster_n);
    field("current_ned_m_s", self.current_ned_m_s);
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
// What one newton each, times the forces, gives: B f.
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
};
// wrench: everything but drag, weight, buoyancy and tether. Returns the three rates in its members.
WaterMotion motion_rate(const Vehicle& vehicle, const WaterMotion& motion, const Vec6& wrench,
                        const Inputs& inputs);
// Weight, buoyancy and tether: -g(q) and the tether's pull, body axes.
Vec6 static_wrench(const Vehicle& vehicle, const WaterMotion& motion, const Inputs& inputs);

}  // namespace neritic::rov
