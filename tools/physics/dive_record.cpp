#include "tools/physics/dive_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "rov/frames.hpp"

namespace neritic::tools {
namespace {

Pose world_pose_of(const rov::State& body) {
  return rov::world_pose(body.position_ned_m, body.attitude);
}

double tilt_of(const Quat& q) {
  return std::acos(std::clamp(1.0 - 2.0 * (q.x * q.x + q.y * q.y), -1.0, 1.0));
}

struct EulerAngles {
  double heading_rad, pitch_rad, roll_rad;
};

// Of an attitude in marine axes: heading, then pitch, then roll (Fossen 2011, eq. 2.45).
EulerAngles euler_of(const Quat& q) {
  return {rov::heading_of(q), std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
          std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))};
}

// Headings from 0 to 360.
double compass_deg(double heading_rad) {
  const double deg = degrees(heading_rad);
  return deg < 0.0 ? deg + 360.0 : deg;
}

constexpr const char* kColumns =
    "time_s,vehicle,x_m,y_m,z_m,depth_m,qw,qx,qy,qz,heading_deg,pitch_deg,roll_deg,surge_m_s,"
    "sway_m_s,heave_m_s,roll_deg_s,pitch_deg_s,yaw_deg_s,current_x_m_s,current_y_m_s,current_z_m_s,"
    "wanted_x_m,wanted_y_m,wanted_z_m,wanted_heading_deg,error_m,waypoint,arrived,near_points,"
    "touched_steps";

void append_numbers(std::string& out, std::initializer_list<double> numbers) {
  for (const double number : numbers) fmt::format_to(std::back_inserter(out), ",{:.9g}", number);
}

void append_row(std::string& out, const PhysicsWorld& world, const DiveRow& row,
                std::size_t thrusters) {
  const PhysicsVehicle& vehicle = world.vehicles()[row.vehicle];
  const Vec3& p = row.world_from_body.position_m;
  const Quat& q = row.world_from_body.rotation;
  const auto [heading, pitch, roll] = euler_of(rov::ned_from_world(q));
  const rov::Vec6& v = row.velocity;
  const Vec3 &wanted = row.wanted.position_m, &c = row.current_m_s;
  fmt::format_to(std::back_inserter(out), "{:.9g},{}", row.time_s, vehicle.name);
  append_numbers(out, {p.x,
                       p.y,
                       p.z,
                       -p.y,
                       q.w,
                       q.x,
                       q.y,
                       q.z,
                       compass_deg(heading),
                       degrees(pitch),
                       degrees(roll),
                       v[0],
                       v[1],
                       v[2],
                       degrees(v[3]),
                       degrees(v[4]),
                       degrees(v[5]),
                       c.x,
                       c.y,
                       c.z,
                       wanted.x,
                       wanted.y,
                       wanted.z,
                       compass_deg(rov::heading_of(rov::ned_from_world(row.wanted.rotation))),
                       glm::distance(p, wanted)});
  fmt::format_to(std::back_inserter(out), ",{},{},{},{}", row.waypoint, row.arrived,
                 row.near_points, row.touched_steps);
  for (std::size_t i = 0; i < thrusters; ++i) {
    if (i < vehicle.vehicle.thruster_count)
      append_numbers(out, {row.command_n[i], row.force_n[i]});
    else
      out += ",,";
  }
  fmt::format_to(std::back_inserter(out), ",{:016x}\n", row.hash);
}

}  // namespace

DiveRecorder::DiveRecorder(const PhysicsWorld& world, const RecordOptions& options)
    : world_(world),
      options_(options),
      figures_(world.vehicles().size()),
      tracks_(world.vehicles().size()) {}

bool DiveRecorder::row_due(std::size_t vehicle, std::uint64_t step) const {
  if (options_.row_rate_hz == 0.0) return world_.control_due(vehicle, step);
  const double rows_a_step = options_.row_rate_hz * world_.step_s();
  const auto rows = [&](std::uint64_t steps) {
    return std::floor(static_cast<double>(steps) * rows_a_step + 1e-9);
  };
  return step == 0 || rows(step) != rows(step - 1);
}

DiveRow DiveRecorder::row_of(std::size_t index, const sim::Snapshot<PhysicsState>& snapshot) const {
  const PhysicsVehicle& vehicle = world_.vehicles()[index];
  const VehicleState& state = snapshot.state.vehicles[index];
  DiveRow row;
  row.time_s = snapshot.time_s;
  row.vehicle = index;
  row.world_from_body = world_pose_of(state.body);
  row.velocity = state.body.velocity;
  row.current_m_s =
      rov::world_from_ned(world_.current_ned_m_s(state.body.position_ned_m, snapshot.time_s));
  row.command_n = state.command_n;
  row.force_n = rov::thruster_forces(vehicle.vehicle, state.body, state.body.held);
  row.wanted = rov::world_pose(state.mission.wanted_ned_m, state.mission.wanted_attitude);
  row.waypoint = vehicle.mission ? vehicle.mission->waypoint_index(state.mission) : 0;
  row.arrived = state.mission.arrived;
  row.near_points = state.contact.near_points;
  row.touched_steps = state.contact.touched_steps;
  row.hash = snapshot.hash;
  return row;
}

void DiveRecorder::add(const sim::Snapshot<PhysicsState>& snapshot) {
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const VehicleState &now = snapshot.state.vehicles[i], &before = last_.vehicles[i];
    DiveFigures& figures = figures_[i];
    if (snapshot.step > 0) {
      figures.path_m += glm::distance(now.body.position_ned_m, before.body.position_ned_m);
      if (now.mission.arrived > before.mission.arrived)
        figures.arrivals_s.push_back(snapshot.time_s);
    }
    figures.largest_speed_m_s =
        std::max(figures.largest_speed_m_s, glm::length(now.body.velocity.linear()));
    figures.largest_tilt_rad = std::max(figures.largest_tilt_rad, tilt_of(now.body.attitude));
    if (options_.tracks) {
      const Pose pose = world_pose_of(now.body);
      tracks_[i].places.push_back({snapshot.time_s, pose.position_m});
      tracks_[i].attitudes.push_back({snapshot.time_s, pose.rotation});
    }
    if (options_.rows && row_due(i, snapshot.step)) rows_.push_back(row_of(i, snapshot));
  }
  last_ = snapshot.state;
}

std::string csv_of(const PhysicsWorld& world, const std::vector<DiveRow>& rows) {
  std::size_t thrusters = 0;
  for (const PhysicsVehicle& vehicle : world.vehicles())
    thrusters = std::max<std::size_t>(thrusters, vehicle.vehicle.thruster_count);
  std::string out = kColumns;
  for (std::size_t i = 1; i <= thrusters; ++i)
    out += fmt::format(",command_{}_n,thrust_{}_n", i, i);
  out += ",hash\n";
  for (const DiveRow& row : rows) append_row(out, world, row, thrusters);
  return out;
}

Status fly_ahead(scene::Scene& scene, double until_s) {
  if (!PhysicsWorld::needed(scene)) return {};
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  const auto simulation = world->simulation({.readers = 0, .log = false});
  DiveRecorder recorder(*world, {.tracks = true});
  recorder.add(simulation->newest());
  while (simulation->newest().time_s < until_s) {
    simulation->advance(1);
    recorder.add(simulation->newest());
  }
  for (std::size_t i = 0; i < world->vehicles().size(); ++i)
    scene.objects[world->vehicles()[i].object].mount.track = std::move(recorder.tracks()[i]);
  return {};
}

}  // namespace neritic::tools
