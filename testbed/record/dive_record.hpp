// The record of a simulation, kept as it goes: a row of numbers each control period, and
// figures of the whole. One thread: the one that steps.
#pragma once

#include <string>
#include <vector>

#include "testbed/record/human_record.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

struct RecordOptions {
  bool rows = false;         // keep rows
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
  std::uint64_t silent = 0;      // bits of groups of inputs whose source is not heard
  std::uint64_t hash = 0;        // of the whole state, divers too
  rov::SensorReadings readings;  // the newest of each sensor that it has
  std::optional<rov::NavigationEstimate> estimate;  // of one that flies on what it measures
};

struct DiveFigures {
  double path_m = 0.0, largest_speed_m_s = 0.0, largest_tilt_rad = 0.0;
  double shallowest_m = 1e9, deepest_m = -1e9;  // of its origin, below the still surface
  std::vector<double> arrivals_s;               // of its waypoints
  // For a vehicle that flies by its own sensors: the distance from its estimated position.
  std::optional<double> navigation_error_m, largest_navigation_error_m;
};

class DiveRecorder {
 public:
  DiveRecorder(const PhysicsWorld& world, const RecordOptions& options);

  // Each step's result in turn, the start first.
  void add(const sim::Snapshot<PhysicsState>& snapshot);

  const std::vector<DiveRow>& rows() const { return rows_; }
  const std::vector<DiveFigures>& figures() const { return figures_; }
  const HumanRecorder& humans() const { return humans_; }

 private:
  bool row_due(std::size_t vehicle, std::uint64_t step) const;
  bool human_row_due(std::uint64_t step) const;
  DiveRow row_of(std::size_t vehicle, const sim::Snapshot<PhysicsState>& snapshot) const;

  const PhysicsWorld& world_;
  RecordOptions options_;
  std::vector<DiveRow> rows_;
  std::vector<DiveFigures> figures_;
  PhysicsState last_;
  bool begun_ = false;
  HumanRecorder humans_;
};

// Rows as a table with a heading, in the order of time; world axes, degrees, body axes forward,
// starboard, down. It has the thrusters of the vehicle with most, and the sensors that any vehicle
// has; what a vehicle has not, or has not heard yet, is empty. Divers have columns of their own:
// gas, breath, jacket, effort, tissues.
std::string csv_of(const PhysicsWorld& world, const std::vector<DiveRow>& rows,
                   const std::vector<HumanRow>& human_rows);

}  // namespace neritic::testbed
