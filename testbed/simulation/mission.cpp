#include "testbed/simulation/mission.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Below, a way has no direction to face along.
constexpr double kLeastWay = 0.01;

}  // namespace

MissionGuide::MissionGuide(const scene::Scene& scene, const scene::Mission& mission,
                           const Movers& movers)
    : kind_(mission.kind),
      acceptance_m_(mission.acceptance_m),
      speed_m_s_(mission.speed_m_s),
      radius_m_(mission.radius_m),
      distance_m_(mission.distance_m),
      speed_over_(mission.speed_over),
      repeat_(mission.repeat),
      offset_frd_m_(rov::ned_from_world(mission.offset_m)),
      face_(face_of(scene, mission.facing, movers)),
      target_(scene, mission.target, movers),
      a_(scene, mission.between_a, movers),
      b_(scene, mission.between_b, movers) {
  for (const scene::MissionWaypoint& waypoint : mission.waypoints)
    waypoints_.push_back({rov::ned_from_world(waypoint.position_m),
                          face_of(scene, waypoint.facing, movers), waypoint.hold_s});
}

MissionGuide::Face MissionGuide::face_of(const scene::Scene& scene, const scene::Facing& facing,
                                         const Movers& movers) const {
  Face face{facing.heading_rad, std::nullopt, facing.tilt};
  if (facing.look_at) face.look_at.emplace(scene, *facing.look_at, movers);
  return face;
}

std::size_t MissionGuide::waypoint_index(const MissionState& mission) const {
  if (waypoints_.empty()) return 0;
  if (repeat_) return mission.left % waypoints_.size();
  return std::min<std::size_t>(mission.left, waypoints_.size() - 1);
}

std::vector<Vec3> MissionGuide::waypoints_ned_m() const {
  std::vector<Vec3> out;
  for (const Stop& stop : waypoints_) out.push_back(stop.position_ned_m);
  return out;
}

MissionGuide::Leg MissionGuide::leg(const Vec3& from_ned_m, const Vec3& to_ned_m, const Face& face,
                                    double start_rad, const PhysicsState& all) const {
  const Vec3 way = to_ned_m - from_ned_m;
  Leg out{from_ned_m, to_ned_m, {}};
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    LegPoint& point = out.points[i];
    point.place_ned_m = from_ned_m + 0.5 * static_cast<double>(i) * way;
    if (face.heading_rad) {
      point.heading_rad = face.heading_rad;
    } else if (face.look_at) {
      const Vec3 to =
          rov::ned_from_world(face.look_at->at(all, 0.0).position_m) - point.place_ned_m;
      if (std::hypot(to.x, to.y) > kLeastWay) point.heading_rad = std::atan2(to.y, to.x);
    } else if (std::hypot(way.x, way.y) > kLeastWay) {
      point.heading_rad = std::atan2(way.y, way.x);
    } else if (kind_ == scene::Mission::Kind::kStation) {
      point.heading_rad = start_rad;
    }
  }
  return out;
}

std::vector<MissionGuide::Leg> MissionGuide::legs(const rov::State& start,
                                                  const PhysicsState& all) const {
  constexpr int kParts = 8;  // of an orbit
  std::vector<Leg> out;
  const auto add = [&](const Vec3& from_ned_m, const Vec3& to_ned_m, const Face& face) {
    out.push_back(leg(from_ned_m, to_ned_m, face, rov::heading_of(start.attitude), all));
  };
  const auto add_stop = [&](const Vec3& from_ned_m, const Stop& to) {
    add(from_ned_m, to.position_ned_m, to.face.said() ? to.face : face_);
  };
  if (kind_ == scene::Mission::Kind::kStation)
    add(start.position_ned_m, start.position_ned_m, face_);
  if (kind_ == scene::Mission::Kind::kOrbit) {
    const Vec3 centre = rov::ned_from_world(target_.at(all, 0.0).position_m);
    const auto at = [&](int part) {
      const double angle = std::copysign(2.0 * kPi * part / kParts, speed_m_s_);
      return centre + radius_m_ * Vec3(std::cos(angle), std::sin(angle), 0.0);
    };
    for (int part = 0; part < kParts; ++part) add(at(part), at(part + 1), face_);
  }
  for (std::size_t i = 0; i < waypoints_.size(); ++i)
    add_stop(i == 0 ? start.position_ned_m : waypoints_[i - 1].position_ned_m, waypoints_[i]);
  if (repeat_ && waypoints_.size() > 1)
    add_stop(waypoints_.back().position_ned_m, waypoints_.front());
  return out;
}

std::vector<double> MissionGuide::holds_s() const {
  std::vector<double> out;
  for (const Stop& stop : waypoints_) out.push_back(stop.hold_s);
  return out;
}

bool MissionGuide::done(const MissionState& mission) const {
  return !repeat_ && mission.arrived >= waypoints_.size();
}

double MissionGuide::off_m(const PhysicsState& all, const rov::State& body, double time_s,
                           const MissionState& mission) const {
  if (kind_ == scene::Mission::Kind::kWaypoints)
    return glm::distance(body.position_ned_m, waypoints_[waypoint_index(mission)].position_ned_m);
  if (kind_ != scene::Mission::Kind::kOrbit)
    return glm::distance(body.position_ned_m, mission.wanted_ned_m);
  const Vec3 out = body.position_ned_m - rov::ned_from_world(target_.at(all, time_s).position_m);
  return std::hypot(std::hypot(out.x, out.y) - radius_m_, out.z);
}

const char* MissionGuide::place_words() const {
  using Kind = scene::Mission::Kind;
  switch (kind_) {
    case Kind::kWaypoints:
      return "its waypoint";
    case Kind::kStation:
      return "its station";
    case Kind::kOrbit:
      return "the circle of its orbit";
    case Kind::kFollow:
      return "its place beside whom it follows";
    case Kind::kStandBetween:
      return "its place between both";
  }
  return "its place";
}

rov::Setpoint MissionGuide::to_waypoint(const rov::State& body, double time_s,
                                        MissionState& mission) const {
  const bool last = !repeat_ && mission.left + 1 >= waypoints_.size();
  const Stop* stop = &waypoints_[waypoint_index(mission)];
  if (mission.arrived == mission.left && !done(mission) &&
      glm::distance(body.position_ned_m, stop->position_ned_m) < acceptance_m_) {
    ++mission.arrived;
    mission.arrived_s = time_s;
  }
  if (mission.arrived > mission.left && !last && time_s - mission.arrived_s >= stop->hold_s) {
    ++mission.left;
    mission.leg_from_ned_m = stop->position_ned_m;
    mission.speed_n = 0.0;
    stop = &waypoints_[waypoint_index(mission)];
  }
  const bool holds = mission.arrived > mission.left;
  if (holds) return rov::go_to({}, stop->position_ned_m);
  // Without a speed it is as fast as it can.
  const double speed_m_s = speed_m_s_ > 0.0 ? speed_m_s_ : std::numeric_limits<double>::infinity();
  return rov::go_to(moving(), body, mission.leg_from_ned_m, stop->position_ned_m, speed_m_s);
}

// A setpoint whose speed is the one that the mission means.
rov::Setpoint MissionGuide::moving() const {
  rov::Setpoint setpoint;
  if (speed_m_s_ == 0.0) return setpoint;
  setpoint.by_drag_alone = speed_over_ == scene::SpeedOver::kWater;
  setpoint.over_ground = speed_over_ == scene::SpeedOver::kGround;
  return setpoint;
}

void MissionGuide::turn(rov::Setpoint& setpoint, const Face& face, const Vec3& way_ned,
                        const PhysicsState& all, double time_s, const MissionState& mission) const {
  setpoint.attitude = rov::heading_attitude(rov::heading_of(mission.wanted_attitude));
  if (face.heading_rad)
    setpoint = rov::at_heading(setpoint, *face.heading_rad);
  else if (face.look_at)
    setpoint = rov::look_at(setpoint, rov::ned_from_world(face.look_at->at(all, time_s).position_m),
                            face.tilt);
  else if (std::hypot(way_ned.x, way_ned.y) > kLeastWay)
    setpoint = rov::at_heading(setpoint, std::atan2(way_ned.y, way_ned.x));
}

rov::Setpoint MissionGuide::update(const PhysicsState& all, const rov::State& body, double time_s,
                                   MissionState& mission) const {
  using Kind = scene::Mission::Kind;
  if (mission.piloted != 0) {  // the pilot gave it back somewhere else
    mission.piloted = 0;
    mission.speed_n = 0.0;
    mission.leg_from_ned_m = body.position_ned_m;
  }
  rov::Setpoint setpoint;
  Vec3 way(0.0);
  const Face* face = &face_;
  if (kind_ == Kind::kStation) {
    setpoint.position_ned_m = mission.leg_from_ned_m;
  } else if (kind_ == Kind::kWaypoints) {
    setpoint = to_waypoint(body, time_s, mission);
    const Stop& stop = waypoints_[waypoint_index(mission)];
    if (stop.face.said()) face = &stop.face;
    if (mission.arrived == mission.left) way = stop.position_ned_m - mission.leg_from_ned_m;
  } else if (kind_ == Kind::kOrbit) {
    const Vec3 centre = rov::ned_from_world(target_.at(all, time_s).position_m);
    setpoint = rov::orbit(moving(), body, centre, radius_m_, speed_m_s_);
    way = setpoint.velocity_ned_m_s;
  } else if (kind_ == Kind::kFollow) {
    const Pose target = target_.at(all, time_s);
    way = rov::ned_from_world(target_.velocity_m_s(all, time_s));
    setpoint = rov::follow({}, rov::ned_from_world(target.position_m), way,
                           rov::heading_of(rov::ned_from_world(target_.facing(all, time_s))),
                           offset_frd_m_);
  } else {
    setpoint = rov::stand_between({}, rov::ned_from_world(a_.at(all, time_s).position_m),
                                  rov::ned_from_world(b_.at(all, time_s).position_m), distance_m_);
  }
  if (kind_ != Kind::kStandBetween) turn(setpoint, *face, way, all, time_s, mission);
  mission.wanted_ned_m = setpoint.position_ned_m;
  mission.wanted_attitude = setpoint.attitude;
  return setpoint;
}

rov::Setpoint piloted_setpoint(const rov::Vec6& wrench, const rov::State& body,
                               MissionState& mission) {
  const bool begins = mission.piloted != 1;
  mission.piloted = 1;
  const double depth_m =
      begins || wrench[2] != 0.0 ? body.position_ned_m.z : mission.wanted_ned_m.z;
  const bool heading_free = begins || wrench[5] != 0.0;
  const double heading_rad =
      rov::heading_of(heading_free ? body.attitude : mission.wanted_attitude);
  rov::Setpoint setpoint;
  setpoint.position_ned_m = {body.position_ned_m.x, body.position_ned_m.y, depth_m};
  setpoint.attitude = rov::heading_attitude(heading_rad);
  setpoint.hold_north = setpoint.hold_east = false;
  setpoint.hold_depth = wrench[2] == 0.0;
  setpoint.hold_heading = wrench[5] == 0.0;
  mission.wanted_ned_m = setpoint.position_ned_m;
  mission.wanted_attitude = setpoint.attitude;
  return setpoint;
}

rov::Setpoint given_setpoint(const VehicleSetpoint& wanted, MissionState& mission) {
  mission.piloted = 2;
  rov::Setpoint setpoint;
  setpoint.position_ned_m = rov::ned_from_world(wanted.position_m);
  setpoint.velocity_ned_m_s = rov::ned_from_world(wanted.velocity_m_s);
  setpoint.attitude = rov::heading_attitude(wanted.heading_rad);
  mission.wanted_ned_m = setpoint.position_ned_m;
  mission.wanted_attitude = setpoint.attitude;
  return setpoint;
}

rov::Setpoint velocity_setpoint(const VehicleVelocity& wanted, const rov::State& body,
                                double period_s, MissionState& mission) {
  constexpr double kLeastAhead_m = 1.0, kMostAhead_s = 1.0, kMostTurnAhead_rad = 0.5;
  if (mission.piloted != 3) drift_with(body, mission);
  mission.piloted = 3;
  const double now_rad = rov::heading_of(body.attitude);
  const double ahead_rad = std::remainder(
      rov::heading_of(mission.wanted_attitude) + wanted.yaw_rate_rad_s * period_s - now_rad,
      2.0 * kPi);
  rov::Setpoint setpoint;
  setpoint.attitude = rov::heading_attitude(
      now_rad + std::clamp(ahead_rad, -kMostTurnAhead_rad, kMostTurnAhead_rad));
  setpoint.velocity_ned_m_s = setpoint.attitude * wanted.velocity_m_s;
  Vec3 ahead_m = mission.wanted_ned_m + setpoint.velocity_ned_m_s * period_s - body.position_ned_m;
  const double distance_m = glm::length(ahead_m);
  const double most_m =
      std::max(kLeastAhead_m, kMostAhead_s * glm::length(setpoint.velocity_ned_m_s));
  if (distance_m > most_m) ahead_m *= most_m / distance_m;
  setpoint.position_ned_m = body.position_ned_m + ahead_m;
  mission.wanted_ned_m = setpoint.position_ned_m;
  mission.wanted_attitude = setpoint.attitude;
  return setpoint;
}

void drift_with(const rov::State& body, MissionState& mission) {
  mission.piloted = 4;
  mission.wanted_ned_m = body.position_ned_m;
  mission.wanted_attitude = rov::heading_attitude(rov::heading_of(body.attitude));
}

MissionState mission_start(const rov::State& body) {
  MissionState mission;
  mission.leg_from_ned_m = mission.wanted_ned_m = body.position_ned_m;
  mission.wanted_attitude = rov::heading_attitude(rov::heading_of(body.attitude));
  return mission;
}

}  // namespace neritic::testbed
