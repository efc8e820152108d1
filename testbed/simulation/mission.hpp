// A vehicle's mission as setpoints: what the scene says, composed of the blocks of rov/guidance.hpp
// once a control period. Built once, then only read; any thread. North, east, down.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "rov/guidance.hpp"
#include "testbed/simulation/places.hpp"

namespace neritic::testbed {

class MissionGuide {
 public:
  MissionGuide(const scene::Scene& scene, const scene::Mission& mission, const Movers& movers);

  // Where to be now. all: the states before this step; the mission's own state is advanced.
  rov::Setpoint update(const PhysicsState& all, const rov::State& body, double time_s,
                       MissionState& mission) const;
  // 0 where it has none.
  std::size_t waypoint_count() const { return waypoints_.size(); }
  // The waypoint that it flies to or holds at.
  std::size_t waypoint_index(const MissionState& mission) const;
  double acceptance_m() const { return acceptance_m_; }
  bool repeats() const { return repeat_; }
  double speed_m_s() const { return speed_m_s_; }  // 0: none is said
  scene::SpeedOver speed_over() const { return speed_over_; }
  // The legs between its waypoints, from start on, and the leg back if it repeats. An orbit has
  // eight legs, a station its place alone.
  struct LegPoint {
    Vec3 place_ned_m{0.0};
    std::optional<double> heading_rad;  // where it faces there; none: anywhere
  };
  struct Leg {
    Vec3 from_ned_m{0.0}, to_ned_m{0.0};
    std::array<LegPoint, 3> points;  // start, middle, end
  };
  // start: the vehicle's; all: where what it looks at is, at time 0.
  std::vector<Leg> legs(const rov::State& start, const PhysicsState& all) const;
  std::vector<Vec3> waypoints_ned_m() const;
  std::vector<double> holds_s() const;  // of each waypoint
  // All waypoints reached, of a mission that does not repeat.
  bool done(const MissionState& mission) const;
  // At a waypoint: it stays there for its hold, or since it was the last.
  bool holds(const MissionState& mission) const { return mission.arrived > mission.left; }
  // How far the body truly is from where the mission has it: the waypoint ahead, the nearest place
  // of an orbit's circle, else the place that is wanted of it.
  double off_m(const PhysicsState& all, const rov::State& body, double time_s,
               const MissionState& mission) const;
  // What it is off, as the end of a sentence: "its station".
  const char* place_words() const;

 private:
  struct Face {
    std::optional<double> heading_rad;
    std::optional<Place> look_at;
    bool tilt = false;
    bool said() const { return heading_rad || look_at; }
  };
  struct Stop {
    Vec3 position_ned_m{0.0};
    Face face;
    double hold_s = 0.0;
  };
  Leg leg(const Vec3& from_ned_m, const Vec3& to_ned_m, const Face& face, double start_rad,
          const PhysicsState& all) const;
  Face face_of(const scene::Scene& scene, const scene::Facing& facing, const Movers& movers) const;
  rov::Setpoint to_waypoint(const rov::State& body, double time_s, MissionState& mission) const;
  rov::Setpoint moving() const;
  void turn(rov::Setpoint& setpoint, const Face& face, const Vec3& way_ned, const PhysicsState& all,
            double time_s, const MissionState& mission) const;

  scene::Mission::Kind kind_;
  double acceptance_m_, speed_m_s_, radius_m_, distance_m_;
  scene::SpeedOver speed_over_;
  bool repeat_;
  Vec3 offset_frd_m_;
  Face face_;
  std::vector<Stop> waypoints_;
  Place target_, a_, b_;
};

// While a pilot flies: depth and heading held where they are since the pilot let go of them, level
// always. The pilot's wrench comes on top.
rov::Setpoint piloted_setpoint(const rov::Vec6& wrench, const rov::State& body,
                               MissionState& mission);
// From outside: there, level, at that heading.
rov::Setpoint given_setpoint(const VehicleSetpoint& wanted, MissionState& mission);
// From outside: a place that moves so, level, with its heading; it begins where the body is and
// runs ahead of it by a second's way at most, so that a vehicle that is held does not dash off
// later. Once a control period of period_s.
rov::Setpoint velocity_setpoint(const VehicleVelocity& wanted, const rov::State& body,
                                double period_s, MissionState& mission);
// From outside: nothing is held while thrusters get their forces directly.
void drift_with(const rov::State& body, MissionState& mission);

// At the start: nothing reached, and held is where the body is.
MissionState mission_start(const rov::State& body);

}  // namespace neritic::testbed
