// Holds a vehicle at a setpoint, u = K_P (s* - s) + integral K_I (s* - s) dt - K_D s', on all six
// axes, and turns u into thruster commands. World axes north, east, down; body axes forward,
// starboard, down. Pure functions over plain states; any thread.
#pragma once

#include <array>

#include "rov/allocation.hpp"
#include "rov/dynamics.hpp"
#include "rov/pid.hpp"

namespace neritic::rov {

// The wanted pose. Axes that are not held are left to the pilot: neither corrected nor damped.
struct Setpoint {
  Vec3 position_ned_m{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};
  // How the setpoint itself moves; its drag is fed forward. By drag alone: a velocity through the
  // water, for which that drag is all the thrust along it; the speed over ground comes as it may.
  Vec3 velocity_ned_m_s{0.0};
  bool by_drag_alone = false;
  // Its velocity along its way is one over ground: level_inputs() learns the push that the water,
  // or whatever else holds the vehicle, takes from it.
  bool over_ground = false;
  bool hold_north = true, hold_east = true, hold_depth = true;
  bool hold_heading = true;
  bool hold_level = true;  // roll and pitch
  Vec6 pilot;              // a wrench on top, body axes
};

struct ControlGains {
  std::array<PidAxis, 6> axes;
  double period_s = 0.02;
  Saturation saturation = Saturation::kScale;
  // Weight, buoyancy and righting moment are given on top, as the vehicle's parameters have them:
  // without it the integral has to, and at large tilts cannot.
  bool feed_forward = false;
};
// For the BlueROV2 Heavy at 50 Hz.
ControlGains default_gains();

struct ControlState {
  Vec6 integral;
  double speed_n = 0.0;  // of Setpoint::over_ground (thrust_priority.hpp); 0: nothing learnt yet
};

// The direction of a vector; of one of no length 0.
Vec3 along(const Vec3& vector);

// [R^T (p* - p); log(q^-1 q*)]: metres and radians in body axes, the short way round.
Vec6 pose_error(const Vec3& position, const Quat& attitude, const Vec3& wanted_position,
                const Quat& wanted_attitude);

// The cut of u where it exceeds u_max.
enum class Clip {
  kEachAxis,  // by itself
  // The pull to a position far away by one factor for its three axes, so that it keeps its
  // direction at any tilt of the body: a share of a long way is not a correction of depth.
  kDirection,
};
// The wrench M_RB u and what is fed forward. state.velocity is taken over ground.
Vec6 control_wrench(const Vehicle& vehicle, const ControlGains& gains, const Setpoint& setpoint,
                    const State& state, ControlState& control, Clip clip = Clip::kEachAxis);

// The wrench that balances the drag at this velocity through the water, along the motion, body
// axes.
Vec6 drag_of(const Vehicle& vehicle, const Vec3& velocity_m_s);

// The same, clipped in each axis, as thruster commands. Precondition: the allocator is of this
// vehicle.
Inputs control_inputs(const Vehicle& vehicle, const Allocator& allocator, const ControlGains& gains,
                      const Setpoint& setpoint, const State& state, ControlState& control);

// A setpoint where the vehicle is: station keeping.
Setpoint stay(const State& state);
// The pilot flies; depth or heading are held as they are.
Setpoint depth_hold(const State& state, const Vec6& pilot);
Setpoint heading_hold(const State& state, const Vec6& pilot);

// Rotation about down, positive from north to east; and that of an attitude.
Quat heading_attitude(double heading_rad);
double heading_of(const Quat& attitude);
// The shorter rotation as its axis times its angle, rad.
Vec3 rotation_vector(Quat rotation);

}  // namespace neritic::rov
