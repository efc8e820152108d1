// Whether vehicles and divers come nearer to where their missions have them: fed each step of a
// run, asked at its end (mission_outlook.hpp). One thread: the one that steps. North, east, down.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The speed of missions that name none, and to reach a station, an orbit or another's side: half of
// what the shipped vehicles reach.
inline constexpr double kUsualSpeed_m_s = 0.5;
// To speed up, settle and turn.
inline constexpr double kSlack_s = 10.0;

class MissionProgress {
 public:
  // A participant is at a station, an orbit's circle or another's side if it is no farther off.
  static constexpr double kAtPlace_m = 2.0;
  // Who comes no nearer for so long makes no way.
  static constexpr double kStalled_s = 20.0;

  explicit MissionProgress(const PhysicsWorld& world);

  // Each step's result in turn, the start first.
  void add(const sim::Snapshot<PhysicsState>& snapshot);

  // How long a vehicle or diver comes no nearer to the waypoint ahead, up to the newest step; none:
  // it does, it is there, or nothing leads it there.
  std::optional<double> stalled_vehicle_s(std::size_t vehicle) const;
  std::optional<double> stalled_human_s(std::size_t human) const;
  // How far a vehicle with a mission other than waypoints is off its place; none: within
  // kAtPlace_m, or still on its way there.
  std::optional<double> off_place_m(std::size_t vehicle) const;

 private:
  // The way to one goal.
  struct Way {
    bool led = false;                     // to a goal, at the newest step
    std::uint64_t goal = 0;               // waypoints before it, all rounds together
    double begun_s = 0.0, first_m = 0.0;  // the distance at its start
    double off_m = 0.0;
    // The distance when it last came nearer, and when that was.
    double nearest_m = 0.0, nearest_s = 0.0;
  };
  // speed_m_s: at which it should come nearer; slower ones have less to show.
  void go_on(Way& way, std::uint64_t goal, double off_m, double speed_m_s);
  std::optional<double> stalled_s(const Way& way) const;

  const PhysicsWorld& world_;
  std::vector<Way> vehicles_, humans_;
  double now_s_ = 0.0;
};

}  // namespace neritic::testbed
