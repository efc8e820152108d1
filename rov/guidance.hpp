// Blocks that a planner composes: each takes a setpoint and returns it with one thing changed
// (where to be, or where to face), so that "orbit the wreck while looking at the diver" is
// look_at(orbit(...), diver). World axes north, east, down, metres. Pure functions; any thread.
#pragma once

#include <span>
#include <vector>

#include "rov/controller.hpp"

namespace neritic::rov {

// Where to be.
// Straight to a point; with a speed along the line from a point: the setpoint is beside the vehicle
// on the line and moves, so that speed and line are held, and stands at the end in time to brake.
// It moves at most kGather_m_s faster than the vehicle; an infinite speed is as fast as it can.
inline constexpr double kGather_m_s = 1.0;
Setpoint go_to(Setpoint s, const Vec3& point);
Setpoint go_to(Setpoint s, const State& state, const Vec3& from, const Vec3& point,
               double speed_m_s);
// Round a vertical axis through centre, at its depth, from where the vehicle is; positive speeds
// turn from north to east. It speeds up as above.
Setpoint orbit(Setpoint s, const State& state, const Vec3& centre, double radius_m,
               double speed_m_s);
// At a place in the axes of something that moves: forward, starboard, down of its heading.
Setpoint follow(Setpoint s, const Vec3& target, const Vec3& target_velocity_m_s,
                double target_heading_rad, const Vec3& offset_m);
// On the line from a to b at distance_m from b (negative: the middle), facing b.
Setpoint stand_between(Setpoint s, const Vec3& a, const Vec3& b, double distance_m = -1.0);

// Against a steady push, such as a current's, that holds the vehicle off its place: the
// controller's integral advances near the setpoint alone. The place moves on by what is learnt into
// lean_ned_m while the vehicle stands beside it, up to kMostLean_m. Call it last, once a control
// period.
inline constexpr double kMostLean_m = 1.2;
Setpoint lean(Setpoint s, const State& state, double period_s, Vec3& lean_ned_m);

// Where to face. Level, the heading alone; tilted, the pitch too.
Setpoint look_at(Setpoint s, const Vec3& point, bool tilted = false);
Setpoint at_heading(Setpoint s, double heading_rad);

struct Waypoint {
  Vec3 position_ned_m{0.0};
  double heading_rad = 0.0;
};

// Flies to one waypoint after another and stays at the last. One thread owns it.
class WaypointFollower {
 public:
  WaypointFollower(std::vector<Waypoint> waypoints, double radius_m = 0.15)
      : waypoints_(std::move(waypoints)), radius_m_(radius_m) {}
  // Call it once a control period. Accepts the waypoint where the vehicle is within the radius.
  Setpoint update(const State& state);
  // Waypoints accepted so far.
  std::size_t reached() const { return reached_; }
  bool done() const { return reached_ == waypoints_.size(); }

 private:
  std::vector<Waypoint> waypoints_;
  double radius_m_;
  std::size_t reached_ = 0;
};

}  // namespace neritic::rov
