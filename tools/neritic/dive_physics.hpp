// `neritic dive --headless` of a scene with physics: the vehicles' dive without a picture, and so
// without a Vulkan device. One thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "testbed/motion/live_physics.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// Whether the flags ask for the physics alone: headless, and nothing that needs a picture.
bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene);
// kBadInput for flags of physics where there is none, or that exclude each other.
Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene);

// The scene's physics as the flags want it, with pictures or without: from its start or a saved
// state. Precondition: PhysicsWorld::needed.
Result<std::unique_ptr<testbed::LivePhysics>> make_dive_physics(const DiveFlags& flags,
                                                                const scene::Scene& scene,
                                                                testbed::LivePhysics::Pace pace);

// Precondition: asks_for_physics_alone.
Status dive_physics(const DiveFlags& flags, const scene::Scene& scene, const Interrupt& interrupt);

}  // namespace neritic::tools
