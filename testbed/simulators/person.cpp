#include "testbed/simulators/person.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "diver/swimmer.hpp"
#include "engine/core/random.hpp"

namespace neritic::testbed {
namespace {

// Assumptions, so that signals change as a swimmer's do: from rest to the quickest kick.
constexpr double kRestHeart_bpm = 70.0, kEffortHeart_bpm = 60.0;
constexpr double kRestBreath_bpm = 10.0, kEffortBreath_bpm = 8.0;
constexpr double kFollow_s = 30.0;  // heart and breath follow the effort
constexpr double kClench_s = 7.0, kClench_rad = 0.4;
// Places around his course, for as long as people look at things (Rayner 1998, Psychological
// Bulletin 124, 372: 0.2 to 0.5 s in scenes).
constexpr double kWidest_rad = radians(20.0), kHighest_rad = radians(12.0);
constexpr double kShortestLook_s = 0.2, kLongestLook_s = 0.5;
// A saccade's duration (Carpenter 1988: 21 ms, and 2.2 ms a degree).
constexpr double kSaccade_s = 0.021, kSaccade_s_rad = 0.0022 * 180.0 / kPi;
// He blinks for 0.15 s every 4 s (Stern, Walrath and Goldstein 1984, Psychophysiology 21, 22: 15 to
// 20 a minute, 0.1 to 0.4 s).
constexpr double kBlinkEvery_s = 4.0, kBlink_s = 0.15;

}  // namespace

SimulatedPerson::SimulatedPerson(const PhysicsHuman& human)
    : human_(human), swimmer_(human.start.swimmer) {}

void SimulatedPerson::follow(const diver::LimbRecording* limbs,
                             const diver::ButtonRecording* buttons) {
  limbs_ = limbs;
  pressed_ = buttons;
}

const PersonActs& SimulatedPerson::act(const HumanPhysics& seen, double time_s, double dt_s) {
  diver::HumanInputs limbs;
  diver::swim(human_.body, human_.file.swimmer, swim_goal(human_, seen), seen.human, swimmer_, dt_s,
              limbs);
  acts_.time_s = time_s;
  acts_.joints = limbs_ ? limbs_->at(time_s, true) : limbs.joints;
  acts_.buttons = pressed_ ? pressed_->at(time_s).value_or(0) : limbs.buttons;
  const double effort = std::clamp(
      swimmer_.frequency_hz / human_.file.swimmer.most_frequency_hz * swimmer_.effort, 0.0, 1.0);
  const double share = std::min(1.0, dt_s / kFollow_s);
  acts_.heart_bpm += share * (kRestHeart_bpm + kEffortHeart_bpm * effort - acts_.heart_bpm);
  acts_.breath_bpm += share * (kRestBreath_bpm + kEffortBreath_bpm * effort - acts_.breath_bpm);
  look(seen, time_s);
  acts_.flexion_rad.fill(0.5 * kClench_rad * (1.0 - std::cos(2.0 * kPi * time_s / kClench_s)));
  return acts_;
}

void SimulatedPerson::look(const HumanPhysics& seen, double time_s) {
  if (time_s >= next_look_s_) {
    const auto draw = [&](std::uint64_t i) { return random_uniform({0x65796573, 0, looks_}, i); };
    const Vec3 course = diver::world_from_ned(seen.human.root.attitude * Vec3(1.0, 0.0, 0.0));
    const double yaw = std::atan2(course.x, -course.z) + kWidest_rad * (2.0 * draw(0) - 1.0);
    const double pitch = kHighest_rad * (2.0 * draw(1) - 1.0);
    from_ = to_;
    to_ = Vec3(std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
    turned_s_ = time_s;
    next_look_s_ = time_s + kShortestLook_s + (kLongestLook_s - kShortestLook_s) * draw(2);
    ++looks_;
  }
  const double angle_rad = std::acos(std::clamp(glm::dot(from_, to_), -1.0, 1.0));
  const double share =
      std::clamp((time_s - turned_s_) / (kSaccade_s + kSaccade_s_rad * angle_rad), 0.0, 1.0);
  // Fast in the middle, at rest at both ends. Looks are at most 90 degrees apart.
  const double turned = 0.5 - 0.5 * std::cos(kPi * share);
  const Vec3 between = glm::mix(from_, to_, turned);
  const double length = glm::length(between);
  acts_.gaze = length > 0.0 ? between / length : to_;
  acts_.eyes_open = std::fmod(time_s, kBlinkEvery_s) < kBlinkEvery_s - kBlink_s;
}

}  // namespace neritic::testbed
