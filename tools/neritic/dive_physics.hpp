// `neritic dive --headless` of a scene with physics: the vehicles' dive without a picture, and so
// without a Vulkan device. One thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/run_record.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// Whether the flags ask for the physics alone: headless, and nothing that needs a picture.
bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene);
// kBadInput for flags of physics where there is none, or that exclude each other.
Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene);

// The scene's physics as the flags want it, with pictures or without: from its start or a saved
// state. clock: that paces its thread; nullptr: the host's. Precondition: PhysicsWorld::needed.
Result<std::unique_ptr<testbed::LivePhysics>> make_dive_physics(const DiveFlags& flags,
                                                                const scene::Scene& scene,
                                                                testbed::LivePhysics::Pace pace,
                                                                sim::StepClock* clock = nullptr);

// A recording that is run again: it steers, and each state is compared with it. It stays where it
// is: the check borrows from the source.
struct Replay {
  testbed::RecordedSource source;
  testbed::RecordingCheck check;
  std::string file;

  // start_step: where the run begins. kBadInput for a recording of another scene or without steps.
  static Result<std::unique_ptr<Replay>> read(const std::string& file,
                                              const testbed::PhysicsWorld& world,
                                              std::uint64_t start_step);
  std::uint64_t steps() const { return source.log().steps(); }
  double seconds() const { return static_cast<double>(steps()) * source.log().step_s; }
  // On standard output: how many steps were as recorded.
  void tell() const;
};

// kUnsupported where a mission is not finished though the run was long enough (mission_outlook.hpp)
// and nothing is saved to go on from. Not while the physics' thread runs.
Status check_finished(const DiveFlags& flags, const testbed::LivePhysics& physics);

// Precondition: asks_for_physics_alone.
Status dive_physics(const DiveFlags& flags, const scene::Scene& scene, const Interrupt& interrupt);

}  // namespace neritic::tools
