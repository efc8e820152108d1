#include "testbed/simulators/person.hpp"

#include <algorithm>
#include <cmath>

#include "diver/swimmer.hpp"

namespace neritic::testbed {
namespace {

// Assumptions, so that signals change as a swimmer's do: from rest to the quickest kick.
constexpr double kRestHeart_bpm = 70.0, kEffortHeart_bpm = 60.0;
constexpr double kRestBreath_bpm = 10.0, kEffortBreath_bpm = 8.0;
constexpr double kFollow_s = 30.0;  // heart and breath follow the effort
constexpr double kClench_s = 7.0, kClench_rad = 0.4;

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
  acts_.flexion_rad.fill(0.5 * kClench_rad * (1.0 - std::cos(2.0 * kPi * time_s / kClench_s)));
  return acts_;
}

}  // namespace neritic::testbed
