// A person who wears the devices and swims by himself: limbs, fingers, buttons, heart, breath
// and gaze over time. He swims as the scene's swimmer does, by what he sees of the dive, so that
// the delay and the loss of his devices are between what he does and what he sees. One thread.
#pragma once

#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {

struct PersonActs {
  double time_s = 0.0;
  diver::JointRotations joints = diver::straight_joints();
  std::array<double, 10> flexion_rad{};  // thumb to little finger, left hand first
  std::uint64_t buttons = 0;
  double heart_bpm = 70.0, breath_bpm = 12.0;
  Vec3 gaze{0.0, 0.0, -1.0};  // in the world, of length 1
  bool eyes_open = true;
};

class SimulatedPerson {
 public:
  // human: of the scene; outlives this.
  explicit SimulatedPerson(const PhysicsHuman& human);
  // The person's acts in the next dt_s, for the body that he sees.
  const PersonActs& act(const HumanPhysics& seen, double time_s, double dt_s);
  const PersonActs& acts() const { return acts_; }
  // Limbs, or buttons, as a file says instead; it outlives this.
  void follow(const diver::LimbRecording* limbs, const diver::ButtonRecording* buttons);

 private:
  void look(const HumanPhysics& seen, double time_s);

  const PhysicsHuman& human_;
  diver::SwimmerState swimmer_;
  PersonActs acts_;
  const diver::LimbRecording* limbs_ = nullptr;
  const diver::ButtonRecording* pressed_ = nullptr;
  // The eyes turn from one place to the next, and stay there until the next look.
  Vec3 from_{0.0, 0.0, -1.0}, to_{0.0, 0.0, -1.0};
  double turned_s_ = 0.0, next_look_s_ = 0.0;
  std::uint64_t looks_ = 0;
};

}  // namespace neritic::testbed
