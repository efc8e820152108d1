#include "testbed/record/dive_record.hpp"

#include <algorithm>
#include <cmath>

#include "rov/frames.hpp"
#include "testbed/simulation/periods.hpp"

namespace neritic::testbed {
namespace {

Pose world_pose_of(const rov::State& body) {
  return rov::world_pose(body.position_ned_m, body.attitude);
}

double tilt_of(const Quat& q) {
  return std::acos(std::clamp(1.0 - 2.0 * (q.x * q.x + q.y * q.y), -1.0, 1.0));
}

constexpr double kHumanRows_hz = 10.0;

}  // namespace

void append(DiveRows& to, const DiveRows& more) {
  to.vehicles.insert(to.vehicles.end(), more.vehicles.begin(), more.vehicles.end());
  to.humans.insert(to.humans.end(), more.humans.begin(), more.humans.end());
}

std::size_t bytes_of(const DiveRows& rows) {
  return rows.vehicles.size() * sizeof(DiveRow) + rows.humans.size() * sizeof(HumanRow);
}

DiveRecorder::DiveRecorder(const PhysicsWorld& world, const RecordOptions& options,
                           double stepped_s)
    : world_(world),
      options_(options),
      figures_(world.vehicles().size()),
      last_(world.start()),
      stepped_before_s_(stepped_s),
      humans_(world),
      progress_(world) {}

bool DiveRecorder::row_due(std::size_t vehicle, std::uint64_t step) const {
  if (options_.row_rate_hz == 0.0) return world_.control_due(vehicle, step);
  return period_begins(step, world_.step_s(), 1.0 / options_.row_rate_hz);
}

bool DiveRecorder::human_row_due(std::uint64_t step) const {
  const double hz = options_.row_rate_hz == 0.0 ? kHumanRows_hz : options_.row_rate_hz;
  return period_begins(step, world_.step_s(), 1.0 / hz);
}

DiveRow DiveRecorder::row_of(std::size_t index, const sim::Snapshot<PhysicsState>& snapshot) const {
  const PhysicsVehicle& vehicle = world_.vehicles()[index];
  const VehicleState& state = snapshot.state.vehicles()[index];
  DiveRow row;
  row.time_s = snapshot.time_s;
  row.vehicle = index;
  row.world_from_body = world_pose_of(state.body);
  row.velocity = state.body.velocity;
  row.current_m_s =
      rov::world_from_ned(world_.water_ned(state.body.position_ned_m, snapshot.time_s).current_m_s);
  row.command_n = state.command_n;
  row.force_n = rov::thruster_forces(vehicle.vehicle, state.body, state.body.held);
  row.wanted = rov::world_pose(state.mission.wanted_ned_m, state.mission.wanted_attitude);
  row.waypoint = vehicle.mission ? vehicle.mission->waypoint_index(state.mission) : 0;
  row.arrived = state.mission.arrived;
  row.near_points = state.contact.near_points;
  row.touched_steps = state.contact.touched_steps;
  row.silent = silent_groups(state.groups);
  row.hash = snapshot.hash;
  if (const rov::SensorReadings* readings = world_.readings(snapshot.state, index))
    row.readings = *readings;
  if (vehicle.tether) row.tether = snapshot.state.tethers()[*vehicle.tether];
  row.estimate = world_.estimate(snapshot.state, index);
  return row;
}

void DiveRecorder::clear_rows() {
  rows_.vehicles.clear();
  rows_.humans.clear();
}

double DiveRecorder::off_waypoint_m(std::size_t vehicle, const VehicleState& state,
                                    std::uint64_t count) const {
  const std::vector<Vec3> places = world_.vehicles()[vehicle].mission->waypoints_ned_m();
  return glm::distance(state.body.position_ned_m, places[count % places.size()]);
}

void DiveRecorder::add(const sim::Snapshot<PhysicsState>& snapshot) {
  if (!begun_) from_s_ = snapshot.time_s;
  newest_s_ = snapshot.time_s;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const VehicleState &now = snapshot.state.vehicles()[i], &before = last_.vehicles()[i];
    DiveFigures& figures = figures_[i];
    if (begun_) {
      figures.path_m += glm::distance(now.body.position_ned_m, before.body.position_ned_m);
      if (now.mission.arrived > before.mission.arrived) {
        figures.arrivals_s.push_back(snapshot.time_s);
        figures.misses_m.push_back(off_waypoint_m(i, now, now.mission.arrived - 1));
      }
    }
    figures.largest_speed_m_s =
        std::max(figures.largest_speed_m_s, glm::length(now.body.velocity.linear()));
    figures.shallowest_m = std::min(figures.shallowest_m, now.body.position_ned_m.z);
    figures.deepest_m = std::max(figures.deepest_m, now.body.position_ned_m.z);
    if (const auto estimate = world_.estimate(snapshot.state, i)) {
      figures.navigation_error_m = glm::distance(estimate->position_ned_m, now.body.position_ned_m);
      figures.largest_navigation_error_m =
          std::max(figures.largest_navigation_error_m.value_or(0.0), *figures.navigation_error_m);
      if (begun_ && world_.navigation(snapshot.state, i)->begun_anew >
                        world_.navigation(last_, i)->begun_anew)
        figures.navigation_anew_s.push_back(snapshot.time_s);
    }
    if (const rov::BatteryState* battery = world_.battery(snapshot.state, i)) {
      figures.battery_charge = battery->charge;
      if (battery->empty != 0 && !figures.battery_empty_from_s)
        figures.battery_empty_from_s = snapshot.time_s;
    }
    figures.largest_tilt_rad = std::max(figures.largest_tilt_rad, tilt_of(now.body.attitude));
    if (options_.rows && row_due(i, snapshot.step)) rows_.vehicles.push_back(row_of(i, snapshot));
  }
  humans_.add(snapshot);
  progress_.add(snapshot);
  if (options_.rows && human_row_due(snapshot.step))
    for (std::size_t i = 0; i < humans_.figures().size(); ++i)
      rows_.humans.push_back(human_row(world_, i, snapshot));
  last_ = snapshot.state;
  begun_ = true;
}

}  // namespace neritic::testbed
