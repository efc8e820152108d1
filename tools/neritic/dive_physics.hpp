// `neritic dive --headless` of a scene with physics: the vehicles' dive without a picture, and so
// without a Vulkan device. One thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/dive_record.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"
#include "tools/neritic/recorded_scene.hpp"

namespace neritic::tools {

// The scene's physics as the flags want it, with pictures or without: from its start, a saved state
// or where a recording begins (nullptr: there is none). clock: that paces its thread; nullptr: the
// host's. Precondition: PhysicsWorld::needed.
Result<std::unique_ptr<testbed::LivePhysics>> make_dive_physics(const DiveFlags& flags,
                                                                const scene::Scene& scene,
                                                                const testbed::SampleLog* recorded,
                                                                testbed::LivePhysics::Pace pace,
                                                                sim::StepClock* clock = nullptr);

// kUnsupported where a mission is not finished though the run was long enough, makes no way or is
// off its place (mission_outlook.hpp), and nothing is saved to go on from. Not while the physics'
// thread runs.
Status check_finished(const DiveFlags& flags, const testbed::LivePhysics& physics,
                      const testbed::DiveRecorder& recorder);

// recorded: of --replay. Precondition: asks_for_physics_alone.
Status dive_physics(const DiveFlags& flags, const scene::Scene& scene,
                    std::optional<testbed::SampleLog> recorded, const Interrupt& interrupt);

}  // namespace neritic::tools
