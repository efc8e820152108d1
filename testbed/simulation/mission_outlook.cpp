#include "testbed/simulation/mission_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "rov/frames.hpp"
#include "testbed/simulation/modem_outlook.hpp"
#include "testbed/simulation/place_outlook.hpp"
#include "testbed/simulation/swim_outlook.hpp"
#include "testbed/simulation/thrust_outlook.hpp"

namespace neritic::testbed {
namespace {

// Slower ones count as that, so that no way is without end.
constexpr double kLeastSpeed_m_s = 0.01;
// A vehicle that is slower along its way makes none.
constexpr double kLeastWay_m_s = 0.05;
// Headings at which a vehicle may face a current.
constexpr int kHeadings = 72;

// The drag in water that flows so past a vehicle at rest, body axes.
Vec3 drag_n(const rov::Vehicle& vehicle, const Vec3& flow_m_s) {
  const rov::Vec6 flow = rov::vec6(flow_m_s, Vec3(0.0));
  rov::Vec6 drag = vehicle.linear_damping * flow;
  for (std::size_t i = 0; i < 3; ++i)
    drag[i] += vehicle.quadratic_damping[i] * std::abs(flow[i]) * flow[i];
  return drag.linear();
}

// The least share of the thrusters' force that holds it there, over all headings, and the drag.
struct Hold {
  double share = 1e300, drag_n = 0.0, thrust_n = 0.0;
};
// The direction against the drag at a heading, body axes; 0 in water at rest.
rov::Vec6 against_drag(const PhysicsVehicle& vehicle, const Vec3& flow_ned_m_s,
                       double heading_rad) {
  const Quat attitude = rov::heading_attitude(heading_rad);
  return rov::vec6(-rov::along(drag_n(vehicle.vehicle, glm::conjugate(attitude) * flow_ned_m_s)),
                   Vec3(0.0));
}
Hold hold_at(const PhysicsVehicle& vehicle, const Vec3& flow_ned_m_s, double heading_rad) {
  const Quat attitude = rov::heading_attitude(heading_rad);
  const double size_n =
      glm::length(drag_n(vehicle.vehicle, glm::conjugate(attitude) * flow_ned_m_s));
  if (!(size_n > 0.0)) return {0.0, 0.0, 0.0};
  const double most_n = most_along(vehicle, against_drag(vehicle, flow_ned_m_s, heading_rad));
  return {size_n / std::max(most_n, 1e-9), size_n, most_n};
}

// The heading near this one at which least of the push against the drag goes astray, by golden
// section: thrusters that push along one line alone hold it nowhere else.
double straightest(const PhysicsVehicle& vehicle, const Vec3& flow_ned_m_s, double heading_rad) {
  constexpr double kGolden = 0.6180339887498949;
  const auto astray = [&](double at_rad) {
    return push_along(vehicle, against_drag(vehicle, flow_ned_m_s, at_rad)).astray;
  };
  double from = heading_rad - 2.0 * kPi / kHeadings, to = heading_rad + 2.0 * kPi / kHeadings;
  for (int i = 0; i < 40; ++i) {
    const double inner = to - kGolden * (to - from), outer = from + kGolden * (to - from);
    (astray(inner) < astray(outer) ? to : from) = astray(inner) < astray(outer) ? outer : inner;
  }
  return 0.5 * (from + to);
}

Hold easiest_hold(const PhysicsVehicle& vehicle, const Vec3& flow_ned_m_s) {
  Hold best;
  for (int i = 0; i < kHeadings; ++i) {
    const Hold hold = hold_at(vehicle, flow_ned_m_s, 2.0 * kPi * i / kHeadings);
    if (hold.share < best.share) best = hold;
  }
  if (best.thrust_n > 0.0 || best.drag_n == 0.0) return best;
  for (int i = 0; i < kHeadings; ++i) {
    const Hold hold = hold_at(vehicle, flow_ned_m_s,
                              straightest(vehicle, flow_ned_m_s, 2.0 * kPi * i / kHeadings));
    if (hold.share < best.share) best = hold;
  }
  return best;
}

// Whether the current drags it away at any heading.
bool add_current(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                 std::vector<std::string>& lines) {
  std::vector<Vec3> places = vehicle.mission->waypoints_ned_m();
  places.push_back(vehicle.start.position_ned_m);
  Vec3 fastest(0.0);
  for (const Vec3& place : places) {
    const Vec3 current = world.current_ned_m_s(place, 0.0);
    if (glm::length(current) > glm::length(fastest)) fastest = current;
  }
  const Hold hold = easiest_hold(vehicle, fastest);
  if (hold.share <= 1.0) return false;
  lines.push_back(
      fmt::format("{}: the current of {:.3g} m/s drags it with {:.4g} N, its thrusters push with "
                  "{:.3g} N against it: it drifts away",
                  vehicle.name, glm::length(fastest), hold.drag_n, hold.thrust_n));
  return true;
}

// The component along a way of the current, at its end or start: where it is least.
double current_along(const PhysicsWorld& world, const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const Vec3 way = rov::along(to_ned_m - from_ned_m);
  return std::min(glm::dot(world.current_ned_m_s(from_ned_m, 0.0), way),
                  glm::dot(world.current_ned_m_s(to_ned_m, 0.0), way));
}

// The hardest place of a leg for a vehicle that moves along it so, over ground.
struct HardPlace {
  Hold hold{0.0, 0.0, 0.0};
  Vec3 current_m_s{0.0}, flow_m_s{0.0};
};
HardPlace hardest(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                  const MissionGuide::Leg& leg, double speed_m_s) {
  const Vec3 moves = speed_m_s * rov::along(leg.to_ned_m - leg.from_ned_m);
  HardPlace out;
  for (const auto& [place, heading_rad] : leg.points) {
    const Vec3 current = world.current_ned_m_s(place, 0.0), flow = current - moves;
    const Hold hold =
        heading_rad ? hold_at(vehicle, flow, *heading_rad) : easiest_hold(vehicle, flow);
    if (hold.share > out.hold.share) out = {hold, current, flow};
  }
  return out;
}

// Where a leg leads, as the end of a sentence.
std::string where_of(const PhysicsVehicle& vehicle, std::size_t leg) {
  const std::size_t count = vehicle.mission->waypoint_count();
  if (count > 0) return fmt::format("to waypoint {}", leg % count + 1);
  return "on its orbit";
}

// The leg on which the current keeps a vehicle from its way at any speed: the worst. Whether there
// is one.
bool add_no_way(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                std::span<const MissionGuide::Leg> legs, std::vector<std::string>& lines) {
  double worst = 1.0;
  std::string line;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const HardPlace hard = hardest(world, vehicle, legs[i], kLeastWay_m_s);
    if (hard.current_m_s == Vec3(0.0) || hard.hold.share <= worst) continue;
    worst = hard.hold.share;
    const bool stays = legs[i].from_ned_m == legs[i].to_ned_m;
    line = fmt::format(
        "{}: the current of {:.3g} m/s drags it with {:.4g} N{}, its thrusters push with {:.3g} N "
        "against it at the heading there: {}",
        vehicle.name, glm::length(hard.current_m_s), hard.hold.drag_n,
        stays
            ? ""
            : (vehicle.mission->waypoint_count() > 0 ? " on its way " : " ") + where_of(vehicle, i),
        hard.hold.thrust_n, stays ? "it drifts away" : "it leaves its line and may not arrive");
  }
  if (line.empty()) return false;
  lines.push_back(std::move(line));
  return true;
}

// The legs on which a vehicle does not reach its speed over ground, or makes no way by its speed
// through the water: the worst of them.
void add_slow(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
              std::span<const MissionGuide::Leg> legs, std::vector<std::string>& lines) {
  const double speed_m_s = std::abs(vehicle.mission->speed_m_s());
  if (!(speed_m_s > 0.0)) return;
  const bool ground = vehicle.mission->speed_over() == scene::SpeedOver::kGround;
  double worst = 1.0;
  std::string line;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double along_m_s = current_along(world, legs[i].from_ned_m, legs[i].to_ned_m);
    if (!ground && speed_m_s + along_m_s <= 0.0 && -along_m_s / speed_m_s > worst) {
      worst = -along_m_s / speed_m_s;
      line = fmt::format(
          "{}: {:.3g} m/s through the water makes no way {} against a current of {:.3g} m/s",
          vehicle.name, speed_m_s, where_of(vehicle, i), -along_m_s);
    }
    if (!ground || legs[i].from_ned_m == legs[i].to_ned_m) continue;
    const HardPlace hard = hardest(world, vehicle, legs[i], speed_m_s);
    if (hard.hold.share <= worst) continue;
    worst = hard.hold.share;
    line = fmt::format(
        "{}: {:.3g} m/s over ground {} is {:.3g} m/s through the water, whose drag is {:.4g} N; "
        "its thrusters push with {:.3g} N{}",
        vehicle.name, speed_m_s, where_of(vehicle, i), glm::length(hard.flow_m_s), hard.hold.drag_n,
        hard.hold.thrust_n,
        hard.hold.thrust_n > 0.0 ? ": it is slower there"
                                 : " with the other axes at rest: it may not arrive");
  }
  if (!line.empty()) lines.push_back(std::move(line));
}

// A way with its stops, and the number of waypoints that were reached.
struct Way {
  std::string name;
  Vec3 from_m{0.0}, at_m{0.0};  // its start, and where the traveller is
  std::vector<Vec3> waypoints_m;
  std::vector<double> holds_s;     // of each waypoint
  std::vector<double> speeds_m_s;  // over ground, to each waypoint
  std::size_t arrived = 0;
};

// Over ground, to each waypoint.
std::vector<double> speeds_of(const PhysicsWorld& world, const PhysicsVehicle& vehicle) {
  const double speed_m_s = vehicle.mission->speed_m_s();
  const bool water = vehicle.mission->speed_over() == scene::SpeedOver::kWater;
  std::vector<double> out;
  for (const auto& [from, to, points] : vehicle.mission->legs(vehicle.start, world.start()))
    out.push_back(speed_m_s == 0.0 ? kUsualSpeed_m_s
                  : water ? std::max(kLeastSpeed_m_s, speed_m_s + current_along(world, from, to))
                          : speed_m_s);
  return out;
}
std::vector<double> speeds_of(const PhysicsWorld& world, const PhysicsHuman& human) {
  const bool water = human.speed_over == scene::SpeedOver::kWater;
  std::vector<double> out;
  Vec3 from = human.start.human.root.position_ned_m;
  for (const Vec3& to : human.waypoints_ned_m) {
    const Vec3 current = world.current_ned_m_s(0.5 * (from + to), 0.0);
    const double speed_m_s =
        water ? made_good_m_s(human.speed_m_s, to - from, current) : human.speed_m_s;
    out.push_back(std::clamp(speed_m_s, kLeastSpeed_m_s, human.speed_m_s));
    from = to;
  }
  return out;
}

// At its start.
Way way_of(const PhysicsWorld& world, const PhysicsVehicle& vehicle) {
  const Vec3& from_m = vehicle.start.position_ned_m;
  return {vehicle.name,
          from_m,
          from_m,
          vehicle.mission->waypoints_ned_m(),
          vehicle.mission->holds_s(),
          speeds_of(world, vehicle)};
}

// The time to waypoint `last` at those speeds, with the stops before it.
double time_to_s(const Way& way, std::size_t last) {
  double out_s = 0.0;
  Vec3 from = way.from_m;
  for (std::size_t i = 0; i <= last; ++i) {
    out_s += glm::distance(from, way.waypoints_m[i]) / way.speeds_m_s[i];
    if (i < last) out_s += way.holds_s[i];
    from = way.waypoints_m[i];
  }
  return out_s;
}

// A battery that is empty before the way is done, though nothing but the electronics drew from it.
void add_battery(const PhysicsVehicle& vehicle, const Way& way, std::vector<std::string>& lines) {
  if (!vehicle.battery || way.waypoints_m.empty()) return;
  const rov::Battery& battery = *vehicle.file.parameters.battery;
  const double stored_wh = battery.charge * battery.capacity_wh;
  const double needed_s = time_to_s(way, way.waypoints_m.size() - 1);
  const bool lasts = battery.hotel_w == 0.0 || stored_wh * 3600.0 >= battery.hotel_w * needed_s;
  if (lasts && stored_wh > 0.0) return;
  lines.push_back(
      fmt::format("{}: its battery's {:.3g} Wh are gone before the {:.4g} s of its way are: its "
                  "electronics alone draw {:.3g} W",
                  vehicle.name, stored_wh, needed_s, battery.hotel_w));
}

// stalled_s: how long it has come no nearer to the next waypoint.
void add_unfinished(const Way& way, double seconds, std::optional<double> stalled_s,
                    std::vector<std::string>& lines) {
  if (way.arrived >= way.waypoints_m.size()) return;
  const double nominal_s = time_to_s(way, way.waypoints_m.size() - 1);
  const double next_s = time_to_s(way, way.arrived);
  const bool enough = seconds >= nominal_s + kSlack_s || seconds >= 2.0 * next_s + kSlack_s;
  if (!enough && !stalled_s) return;
  lines.push_back(fmt::format(
      "{}: {} of {} waypoints left after {:.4g} s, {:.3g} m to the next{}", way.name,
      way.waypoints_m.size() - way.arrived, way.waypoints_m.size(), seconds,
      glm::distance(way.at_m, way.waypoints_m[way.arrived]),
      stalled_s ? fmt::format(", no nearer to it for {:.0f} s", *stalled_s) : std::string()));
}

// Of a mission that repeats, and so has no end.
void add_stalled(const std::string& name, const Vec3& at_m, const Vec3& waypoint_m,
                 std::size_t number, std::optional<double> stalled_s,
                 std::vector<std::string>& lines) {
  if (!stalled_s) return;
  lines.push_back(fmt::format("{}: {:.3g} m to waypoint {}, no nearer to it for {:.0f} s", name,
                              glm::distance(at_m, waypoint_m), number, *stalled_s));
}

}  // namespace

std::vector<std::string> cannot_hold(const PhysicsWorld& world) {
  std::vector<std::string> lines;
  const PhysicsState start = world.start();
  for (const PhysicsVehicle& vehicle : world.vehicles()) {
    if (!vehicle.mission) continue;
    if (vehicle.battery) add_battery(vehicle, way_of(world, vehicle), lines);
    add_axes(vehicle, lines);
    add_buoyancy(vehicle, lines);
    add_trim(vehicle, lines);
    add_places(world, vehicle, lines);
    add_doppler_log(world, vehicle, lines);
    add_pressure(vehicle, lines);
    if (add_current(world, vehicle, lines)) continue;
    const auto legs = vehicle.mission->legs(vehicle.start, start);
    if (!add_no_way(world, vehicle, legs, lines)) add_slow(world, vehicle, legs, lines);
  }
  for (const PhysicsHuman& human : world.humans()) {
    add_places(world, human, lines);
    add_swim(world, human, lines);
  }
  add_ranging(world, start, lines);
  return lines;
}

std::vector<std::string> unfinished(const PhysicsWorld& world, const PhysicsState& state,
                                    double seconds, const MissionProgress* progress) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    const VehicleState& now = state.vehicles()[i];
    if (!vehicle.mission || now.mission.piloted != 0) continue;  // or somebody else flies it
    const MissionGuide& mission = *vehicle.mission;
    std::optional<double> stalled_s;
    if (progress) stalled_s = progress->stalled_vehicle_s(i);
    if (mission.waypoint_count() == 0) {
      if (const auto off_m = progress ? progress->off_place_m(i) : std::nullopt)
        lines.push_back(fmt::format("{}: {:.3g} m off {} at the end; accepted: up to {:g} m",
                                    vehicle.name, *off_m, mission.place_words(),
                                    MissionProgress::kAtPlace_m));
    } else if (mission.repeats()) {
      const std::size_t index = mission.waypoint_index(now.mission);
      add_stalled(vehicle.name, now.body.position_ned_m, mission.waypoints_ned_m()[index],
                  index + 1, stalled_s, lines);
    } else {
      Way way = way_of(world, vehicle);
      way.at_m = now.body.position_ned_m;
      way.arrived = now.mission.arrived;
      add_unfinished(way, seconds, stalled_s, lines);
    }
  }
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const PhysicsHuman& human = world.humans()[i];
    if (human.waypoints_ned_m.empty()) continue;
    const HumanPhysics& now = state.humans()[i];
    const Vec3& at_m = now.human.root.position_ned_m;
    const auto stalled_s = progress ? progress->stalled_human_s(i) : std::nullopt;
    if (human.repeat) {
      const std::size_t index = now.arrived % human.waypoints_ned_m.size();
      add_stalled(human.name, at_m, human.waypoints_ned_m[index], index + 1, stalled_s, lines);
    } else {
      add_unfinished(
          {human.name, human.start.human.root.position_ned_m, at_m, human.waypoints_ned_m,
           std::vector<double>(human.waypoints_ned_m.size()), speeds_of(world, human), now.arrived},
          seconds, stalled_s, lines);
    }
  }
  return lines;
}

}  // namespace neritic::testbed
