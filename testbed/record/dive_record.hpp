// The record of a simulation, made as it goes: a row of numbers each control period, and
// figures of the whole. One thread: the one that steps.
#pragma once

#include <vector>

#include "testbed/record/human_record.hpp"
#include "testbed/simulation/mission_progress.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

struct RecordOptions {
  bool rows = false;         // make rows
  double row_rate_hz = 0.0;  // 0: one each control period, of divers ten a second
};

// A vehicle at an instant.
struct DiveRow {
  double time_s = 0.0;
  std::size_t vehicle = 0;
  Pose world_from_body;   // model axes
  rov::Vec6 velocity;     // body axes forward, starboard, down
  Vec3 current_m_s{0.0};  // world
  std::array<double, rov::kMaxThrusters> command_n{}, force_n{};
  Pose wanted;  // world_from_body
  std::size_t waypoint = 0;
  std::uint64_t arrived = 0, near_points = 0, touched_steps = 0;
  std::uint64_t silent = 0;           // bits of groups of inputs whose source is not heard
  std::uint64_t hash = 0;             // of the whole state, divers too
  rov::SensorReadings readings;       // the newest of each sensor that it has
  std::optional<TetherState> tether;  // of one with a tether of the scene
  std::optional<rov::NavigationEstimate> estimate;  // of one that flies on what it measures
};

struct DiveFigures {
  double path_m = 0.0, largest_speed_m_s = 0.0, largest_tilt_rad = 0.0;
  double shallowest_m = 1e9, deepest_m = -1e9;  // of its origin, below the still surface
  // At its waypoints: when it takes itself to be there, and how far off it truly is then.
  std::vector<double> arrivals_s, misses_m;
  std::optional<double> battery_charge;  // of 1, where it has a battery
  std::optional<double> battery_empty_from_s;
  // For a vehicle that flies by its own sensors: the distance from its estimated position.
  std::optional<double> navigation_error_m, largest_navigation_error_m;
  std::vector<double> navigation_anew_s;  // when that was lost and began anew
};

// Each list in the order of time.
struct DiveRows {
  std::vector<DiveRow> vehicles;
  std::vector<HumanRow> humans;
  bool empty() const { return vehicles.empty() && humans.empty(); }
};
void append(DiveRows& to, const DiveRows& more);
std::size_t bytes_of(const DiveRows& rows);

class DiveRecorder {
 public:
  // stepped_s: the seconds that this run stepped before it went to a saved state.
  DiveRecorder(const PhysicsWorld& world, const RecordOptions& options, double stepped_s = 0.0);

  // Each step's result in turn, the start first.
  void add(const sim::Snapshot<PhysicsState>& snapshot);

  // The rows of the steps since they were last cleared: whoever makes rows clears them.
  const DiveRows& rows() const { return rows_; }
  void clear_rows();
  const std::vector<DiveFigures>& figures() const { return figures_; }
  // The scene time from which on the figures tell: 0, or that of a restored state; the seconds that
  // this run has stepped, those before a restored state too.
  double from_s() const { return from_s_; }
  double stepped_s() const { return stepped_before_s_ + newest_s_ - from_s_; }
  const HumanRecorder& humans() const { return humans_; }
  const MissionProgress& progress() const { return progress_; }

 private:
  bool row_due(std::size_t vehicle, std::uint64_t step) const;
  bool human_row_due(std::uint64_t step) const;
  // How far it truly is from the waypoint that follows so many, all rounds together.
  double off_waypoint_m(std::size_t vehicle, const VehicleState& state, std::uint64_t count) const;
  DiveRow row_of(std::size_t vehicle, const sim::Snapshot<PhysicsState>& snapshot) const;

  const PhysicsWorld& world_;
  RecordOptions options_;
  DiveRows rows_;
  std::vector<DiveFigures> figures_;
  PhysicsState last_;
  bool begun_ = false;
  double from_s_ = 0.0, newest_s_ = 0.0, stepped_before_s_ = 0.0;
  HumanRecorder humans_;
  MissionProgress progress_;
};

}  // namespace neritic::testbed
