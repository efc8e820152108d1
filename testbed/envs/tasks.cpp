#include "testbed/envs/tasks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array<std::string_view, 5> kTaskNames{"hover", "track", "dock", "follow", "shark"};

// A vehicle so far from its goal has failed.
constexpr double kLost_m = 5.0;
// The end of an episode adds one of these to its last reward. Every reward before it is 0 or more,
// except for the effort, so that failing early never pays.
constexpr double kLostWorth = -10.0, kDoneWorth = 10.0;
// The potential of the best place in a task that can be done, kBestPlace * kPotential, is less than
// kDoneWorth: being done is worth more than any place beside it.
constexpr double kBestPlace = 1.5, kPotential = 5.0;
static_assert(kBestPlace * kPotential < kDoneWorth);

// For the dock: a cone in front of it must be kept to, and its back is solid.
constexpr double kDockRadius_m = 0.15, kDockSpeed_m_s = 0.25, kDockTurn_rad = 0.2;
constexpr double kMouth_m = 1.0, kConeSlope = 0.5;

// For the diver: speeds of fin swimming (Zamparo et al. 2002 measured 0.4 to 0.9 m/s), turns that
// change as a random walk that returns to straight ahead.
constexpr double kTurnReturns_1_s = 0.5, kTurnWalk_rad_s = 0.25;
// The vehicle swims beside the diver at this place of the diver's heading: forward, starboard,
// down.
const Vec3 kBeside_m(0.5, 2.0, -0.3);

// For the shark: it comes on until a vehicle is near, then turns away for a while.
constexpr double kSharkShies_m = 2.5, kSharkBites_m = 1.0, kSharkAway_s = 6.0;
constexpr double kSharkTurn_rad_s = 0.8;

Vec3 direction(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad), 0.0};
}
double heading_to(const Vec3& from, const Vec3& to) {
  return std::atan2(to.y - from.y, to.x - from.x);
}
double turned_rad(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2.0 * kPi);
}

Vec3 on_path(const TaskState& s, double time_s) {
  Vec3 out = s.middle_ned_m;
  for (int i = 0; i < 3; ++i)
    out[i] += s.amplitude_m[i] * std::sin(s.rate_rad_s[i] * time_s + s.phase_rad[i]);
  return out;
}

void set_path_goal(double time_s, TaskState& s) {
  s.goal.position_ned_m = on_path(s, time_s);
  for (int i = 0; i < 3; ++i)
    s.goal.velocity_ned_m_s[i] =
        s.amplitude_m[i] * s.rate_rad_s[i] * std::cos(s.rate_rad_s[i] * time_s + s.phase_rad[i]);
  s.goal.point_ned_m = on_path(s, time_s + 1.0);
  s.goal.heading_rad = std::atan2(s.goal.velocity_ned_m_s.y, s.goal.velocity_ned_m_s.x);
}

void set_diver_goal(TaskState& s) {
  const Vec3 ahead = direction(s.diver_heading_rad), side(-ahead.y, ahead.x, 0.0);
  const Vec3 beside = kBeside_m.x * ahead + kBeside_m.y * side + Vec3(0.0, 0.0, kBeside_m.z);
  const Vec3 turn(0.0, 0.0, s.diver_turn_rad_s);
  s.goal.position_ned_m = s.diver_ned_m + beside;
  s.goal.velocity_ned_m_s = s.diver_speed_m_s * ahead + glm::cross(turn, beside);
  s.goal.heading_rad = heading_to(s.goal.position_ned_m, s.diver_ned_m);
  s.goal.point_ned_m = s.diver_ned_m;
}

// On the line from the diver to the shark, 2 m out, facing the shark.
void set_guard_goal(TaskState& s) {
  const Vec3 to_shark = s.shark_ned_m - s.diver_ned_m;
  const double distance_m = std::max(glm::length(to_shark), 1e-6);
  s.goal.position_ned_m = s.diver_ned_m + to_shark * (std::min(2.0, 0.5 * distance_m) / distance_m);
  s.goal.velocity_ned_m_s = s.diver_speed_m_s * direction(s.diver_heading_rad);
  s.goal.heading_rad = heading_to(s.diver_ned_m, s.shark_ned_m);
  s.goal.point_ned_m = s.shark_ned_m;
}

void swim(const Dice& dice, double step_s, TaskState& s) {
  s.diver_turn_rad_s += -kTurnReturns_1_s * s.diver_turn_rad_s * step_s +
                        kTurnWalk_rad_s * std::sqrt(step_s) * dice.normal(90);
  s.diver_heading_rad += s.diver_turn_rad_s * step_s;
  s.diver_ned_m += s.diver_speed_m_s * step_s * direction(s.diver_heading_rad);
}

void hunt(double step_s, const Vec3& vehicle_ned_m, TaskState& s) {
  if (glm::length(vehicle_ned_m - s.shark_ned_m) < kSharkShies_m) s.shark_away_s = kSharkAway_s;
  const double wanted_rad = s.shark_away_s > 0.0 ? heading_to(s.diver_ned_m, s.shark_ned_m)
                                                 : heading_to(s.shark_ned_m, s.diver_ned_m);
  const double turn_rad = turned_rad(s.shark_heading_rad, wanted_rad);
  s.shark_heading_rad +=
      std::clamp(turn_rad, -kSharkTurn_rad_s * step_s, kSharkTurn_rad_s * step_s);
  s.shark_ned_m += s.shark_speed_m_s * step_s * direction(s.shark_heading_rad);
  // It comes to the diver's depth.
  s.shark_ned_m.z += std::clamp(s.diver_ned_m.z - s.shark_ned_m.z, -0.3 * step_s, 0.3 * step_s);
  s.shark_away_s = std::max(0.0, s.shark_away_s - step_s);
}

double turn_to_goal_rad(const TaskState& s, const rov::WaterMotion& motion) {
  return std::abs(turned_rad(rov::heading_of(motion.attitude), s.goal.heading_rad));
}

// The worth of the vehicle's place, heading and level, 0 to kBestPlace.
double place_worth(const TaskState& s, const rov::WaterMotion& motion) {
  const double off_m = glm::length(s.goal.position_ned_m - motion.position_ned_m);
  // Up of the body against up: 1 level, -1 overturned.
  const double level =
      1.0 - 2.0 * (motion.attitude.x * motion.attitude.x + motion.attitude.y * motion.attitude.y);
  return std::exp(-off_m) + 0.3 * std::exp(-turn_to_goal_rad(s, motion)) + 0.1 * (1.0 + level);
}

}  // namespace

Result<Task> task_of(std::string_view name) {
  for (std::size_t i = 0; i < kTaskNames.size(); ++i)
    if (kTaskNames[i] == name) return static_cast<Task>(i);
  return refusal("task", fmt::format("'{}'", printable(name)), join(kTaskNames));
}

std::string_view name_of(Task task) {
  return kTaskNames.at(static_cast<std::size_t>(task));
}

Start start_of(Task task, const Dice& dice) {
  Start out;
  TaskState& s = out.state;
  const double heading_rad = dice.between(60, -kPi, kPi);
  const Vec3 around(dice.between(61, -1.5, 1.5), dice.between(62, -1.5, 1.5),
                    dice.between(63, -1.0, 1.0));
  const Vec3 place(0.0, 0.0, 10.0);
  s.goal = {.position_ned_m = place, .heading_rad = heading_rad, .point_ned_m = place};
  out.position_ned_m = place + around;
  out.heading_rad = heading_rad + dice.between(64, -1.0, 1.0);
  switch (task) {
    case Task::kHover:
      break;
    case Task::kTrack:
      s.middle_ned_m = place;
      // As fast as 0.2 to 0.7 m/s on its axes.
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::uint64_t>(i);
        s.amplitude_m[i] = dice.between(65 + k, 0.5, i == 2 ? 1.0 : 2.5);
        s.rate_rad_s[i] = dice.between(68 + k, 0.2, 0.7) / s.amplitude_m[i] * (i == 2 ? 0.3 : 1.0);
        s.phase_rad[i] = dice.between(71 + k, -kPi, kPi);
      }
      set_path_goal(0.0, s);
      out.position_ned_m = s.goal.position_ned_m + 0.5 * around;
      out.heading_rad = s.goal.heading_rad;
      break;
    case Task::kDock: {
      const double off_rad = dice.between(65, -0.4, 0.4);
      out.position_ned_m = place - dice.between(66, 2.0, 4.0) * direction(heading_rad + off_rad);
      out.position_ned_m.z += dice.between(67, -0.5, 0.5);
      s.goal.point_ned_m = place - kMouth_m * direction(heading_rad);
      break;
    }
    case Task::kFollow:
    case Task::kShark:
      s.diver_ned_m = place;
      s.diver_heading_rad = heading_rad;
      s.diver_speed_m_s = task == Task::kFollow ? dice.between(65, 0.2, 0.6) : 0.2;
      if (task == Task::kFollow) {
        set_diver_goal(s);
        out.position_ned_m = s.goal.position_ned_m + 0.5 * around;
      } else {
        const double from_rad = dice.between(66, -kPi, kPi);
        s.shark_ned_m = place + dice.between(67, 6.0, 10.0) * direction(from_rad);
        s.shark_ned_m.z += dice.between(68, -1.0, 1.0);
        s.shark_heading_rad = from_rad + kPi;
        s.shark_speed_m_s = dice.between(69, 0.4, 0.7);
        set_guard_goal(s);
        out.position_ned_m = s.goal.position_ned_m + around;
      }
      out.heading_rad = s.goal.heading_rad;
      break;
  }
  return out;
}

void advance(Task task, const Dice& dice, double time_s, double step_s, const Vec3& vehicle_ned_m,
             TaskState& s) {
  switch (task) {
    case Task::kHover:
    case Task::kDock:
      return;
    case Task::kTrack:
      return set_path_goal(time_s, s);
    case Task::kFollow:
      swim(dice, step_s, s);
      return set_diver_goal(s);
    case Task::kShark:
      swim(dice, step_s, s);
      hunt(step_s, vehicle_ned_m, s);
      return set_guard_goal(s);
  }
}

double potential_of(Task task, const TaskState& s, const rov::WaterMotion& motion) {
  return task == Task::kDock ? kPotential * place_worth(s, motion) : 0.0;
}

Worth worth_of(Task task, const TaskState& s, const rov::WaterMotion& motion,
               const rov::Vec6& velocity, double effort, double before) {
  const Vec3 off = s.goal.position_ned_m - motion.position_ned_m;
  const double off_m = glm::length(off), turn_rad = turn_to_goal_rad(s, motion);
  const double gained = potential_of(task, s, motion) - before;
  Worth out;
  out.reward = (task == Task::kDock ? gained : place_worth(s, motion)) - 0.05 * effort;
  // A failure's place is worth nothing (Ng, Harada, Russell 1999: the potential of an end is 0).
  const Worth lost{kLostWorth - before, true};
  // Not < : NaN is lost too.
  if (!(off_m <= kLost_m) && task != Task::kShark) return lost;
  if (task == Task::kDock) {
    const Vec3 axis = direction(s.goal.heading_rad);
    const double before_m = glm::dot(off, axis), beside_m = glm::length(off - before_m * axis);
    if (off_m < kDockRadius_m && glm::length(velocity.linear()) < kDockSpeed_m_s &&
        turn_rad < kDockTurn_rad)
      return {kDoneWorth + gained, true};
    const bool in_back = before_m < -kDockRadius_m;
    const bool in_rim = before_m < kMouth_m &&
                        beside_m > kDockRadius_m + kConeSlope * std::max(before_m, 0.0) + 0.1;
    if (in_back || in_rim) return lost;
  }
  if (task == Task::kShark) {
    if (!(glm::length(motion.position_ned_m - s.diver_ned_m) <= 4.0 * kLost_m)) return lost;
    if (glm::length(s.shark_ned_m - s.diver_ned_m) < kSharkBites_m) return lost;
  }
  return out;
}

}  // namespace neritic::testbed
