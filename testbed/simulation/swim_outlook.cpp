#include "testbed/simulation/swim_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "diver/kinematics.hpp"
#include "diver/swimmer_constants.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Steady speeds sway with the beats by a few percent.
constexpr double kBeyond = 1.05;

// "fins of 0.4 x 0.2 m" or "bare feet".
std::string feet_of(const PhysicsHuman& human) {
  const auto& fins = human.file.parameters.gear.fins;
  if (!fins) return "bare feet";
  return fmt::format("fins of {:g} x {:g} m", fins->length_m, fins->width_m);
}

// The way of a swim plan that is the steepest beyond what the rates of ascent and descent allow.
void add_steep_way(const PhysicsHuman& human, std::vector<std::string>& lines) {
  constexpr double kSteep = 1.25, kLeastSpeed_m_s = 0.01;
  double most = kSteep;
  std::string line;
  Vec3 from = human.start.human.root.position_ned_m;
  for (std::size_t i = 0; i < human.waypoints_ned_m.size(); ++i) {
    const Vec3& to = human.waypoints_ned_m[i];
    const double level_m = std::hypot(to.x - from.x, to.y - from.y), down_m = to.z - from.z;
    const double rate_m_s =
        down_m > 0.0 ? diver::swimming::kMostSink_m_s : diver::swimming::kMostRise_m_s;
    const double level_s = level_m / std::max(human.speed_m_s, kLeastSpeed_m_s);
    const double change_s = std::abs(down_m) / rate_m_s;
    from = to;
    if (std::abs(down_m) < diver::swimming::kWellOff_m || change_s <= most * level_s) continue;
    most = change_s / std::max(level_s, 1e-9);
    line = fmt::format(
        "{}: waypoint {} lies {:.3g} m {} and {:.3g} m on: at {:.2g} m a minute that takes {:.0f} "
        "s, so that the diver circles there",
        human.name, i + 1, std::abs(down_m), down_m > 0.0 ? "deeper" : "higher", level_m,
        60.0 * rate_m_s, change_s);
  }
  if (!line.empty()) lines.push_back(std::move(line));
}

// A waypoint of a plan, and the faster of the currents at it and where the way to it begins.
struct SwimWay {
  Vec3 way_ned{0.0}, current_ned_m_s{0.0};
  std::size_t number = 0;  // from 1 on
};
std::vector<SwimWay> ways_of(const PhysicsWorld& world, const PhysicsHuman& human) {
  std::vector<SwimWay> out;
  Vec3 from = human.start.human.root.position_ned_m;
  for (std::size_t i = 0; i < human.waypoints_ned_m.size(); ++i) {
    const Vec3& to = human.waypoints_ned_m[i];
    for (const Vec3& place : {from, to})
      out.push_back({to - from, world.current_ned_m_s(place, 0.0), i + 1});
    from = to;
  }
  return out;
}

// The plan's fastest way through the water, where that is beyond what legs reach.
void add_too_fast(const PhysicsHuman& human, const std::vector<SwimWay>& ways, double fastest_m_s,
                  std::vector<std::string>& lines) {
  const bool ground = human.speed_over == scene::SpeedOver::kGround;
  double most_m_s = kBeyond * fastest_m_s;
  std::string line;
  for (const SwimWay& way : ways) {
    const double needed_m_s =
        ground ? through_water_m_s(human.speed_m_s, way.way_ned, way.current_ned_m_s)
               : human.speed_m_s;
    if (needed_m_s <= most_m_s) continue;
    most_m_s = needed_m_s;
    line = ground && way.current_ned_m_s != Vec3(0.0)
               ? fmt::format(
                     "{}: {:.3g} m/s over ground to waypoint {} is {:.3g} m/s through the "
                     "water",
                     human.name, human.speed_m_s, way.number, needed_m_s)
               : fmt::format("{}: {:.3g} m/s to waypoint {} found", human.name, human.speed_m_s,
                             way.number);
    line += fmt::format("; accepted: up to {:.2g} m/s, which legs reach with {}", fastest_m_s,
                        feet_of(human));
  }
  if (!line.empty()) lines.push_back(std::move(line));
}

// Whether the current keeps the diver from a waypoint at the plan's speed, or at any.
bool add_no_way(const PhysicsHuman& human, const std::vector<SwimWay>& ways, double fastest_m_s,
                std::vector<std::string>& lines) {
  const bool ground = human.speed_over == scene::SpeedOver::kGround;
  const double speed_m_s = ground ? fastest_m_s : std::min(human.speed_m_s, fastest_m_s);
  for (const SwimWay& way : ways) {
    if (made_good_m_s(speed_m_s, way.way_ned, way.current_ned_m_s) > 0.0) continue;
    const bool legs = made_good_m_s(fastest_m_s, way.way_ned, way.current_ned_m_s) > 0.0;
    lines.push_back(fmt::format(
        "{}: {:.3g} m/s through the water makes no way to waypoint {} in a current of {:.3g} m/s; "
        "{}",
        human.name, speed_m_s, way.number, glm::length(way.current_ned_m_s),
        legs ? fmt::format("accepted: more, up to the {:.2g} m/s that legs reach with {}",
                           fastest_m_s, feet_of(human))
             : fmt::format("legs reach no more with {}", feet_of(human))));
    return true;
  }
  return false;
}

}  // namespace

double made_good_m_s(double through_water_m_s, const Vec3& way_ned, const Vec3& current_ned_m_s) {
  const Vec3 way = rov::along(Vec3(way_ned.x, way_ned.y, 0.0));
  if (way == Vec3(0.0)) return through_water_m_s;
  const Vec3 drift(current_ned_m_s.x, current_ned_m_s.y, 0.0);
  const double with = glm::dot(drift, way), aside = glm::length(drift - with * way);
  if (aside >= through_water_m_s) return 0.0;
  return std::max(0.0, with + std::sqrt((through_water_m_s - aside) * (through_water_m_s + aside)));
}

double fastest_m_s(const PhysicsHuman& human) {
  constexpr double kDepth_m = 10.0, kFar_m = 1000.0, kAsked_m_s = 1.2, kBegins_s = 20.0,
                   kEnds_s = 30.0, kStep_s = diver::kLongestSubstep_s;
  diver::HumanState state =
      diver::start_at(human.body, {0.0, 0.0, kDepth_m}, Quat(1.0, 0.0, 0.0, 0.0),
                      diver::rotations_of(diver::streamlined(human.body)));
  diver::SwimmerState swimmer;
  diver::HumanInputs inputs;
  double begin_m = 0.0;
  for (double now_s = 0.0; now_s < kEnds_s; now_s += kStep_s) {
    if (now_s < kBegins_s) begin_m = state.root.position_ned_m.x;
    diver::swim(human.body, human.file.swimmer, {{kFar_m, 0.0, kDepth_m}, kAsked_m_s}, state,
                swimmer, kStep_s, inputs);
    state = diver::step(human.body, state, inputs, kStep_s);
  }
  return std::max(0.0, state.root.position_ned_m.x - begin_m) / (kEnds_s - kBegins_s);
}

void add_swim(const PhysicsWorld& world, const PhysicsHuman& human,
              std::vector<std::string>& lines) {
  // No gear slows a diver to this; plans that ask less in still water need no trial.
  constexpr double kSurely_m_s = 0.25;
  if (human.waypoints_ned_m.empty()) return;
  const std::vector<SwimWay> ways = ways_of(world, human);
  const bool still = std::ranges::all_of(
      ways, [](const SwimWay& way) { return way.current_ned_m_s == Vec3(0.0); });
  if (!still || human.speed_m_s > kSurely_m_s) {
    const double reached_m_s = fastest_m_s(human);
    if (!add_no_way(human, ways, reached_m_s, lines)) add_too_fast(human, ways, reached_m_s, lines);
  }
  add_steep_way(human, lines);
}

}  // namespace neritic::testbed
