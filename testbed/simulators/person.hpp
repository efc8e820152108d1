// A person who wears the devices and swims by himself: limbs, fingers, buttons, heart and breath
// over time. He swims as the scene's swimmer does, by what he sees of the dive, so that the delay
// and the loss of his devices are between what he does and what he sees. One thread.
#pragma once

#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {

struct PersonActs {
  double time_s = 0.0;
  diver::JointRotations joints = diver::straight_joints();
  std::array<double, 10> flexion_rad{};  // thumb to little finger, left hand first
  std::uint64_t buttons = 0;
  double heart_bpm = 70.0, breath_bpm = 12.0;
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
  const PhysicsHuman& human_;
  diver::SwimmerState swimmer_;
  PersonActs acts_;
  const diver::LimbRecording* limbs_ = nullptr;
  const diver::ButtonRecording* pressed_ = nullptr;
};

}  // namespace neritic::testbed
