// `neritic dive --headless` of a scene with physics: the vehicles' dive without a picture, and so
// without a Vulkan device. One thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// Whether the flags ask for the physics alone: headless, and nothing that needs a picture.
bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene);
// kBadInput for flags of physics where there is none, or beside those of pictures.
Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene);

// Precondition: asks_for_physics_alone.
Status dive_physics(const DiveFlags& flags, const scene::Scene& scene, const Interrupt& interrupt);

}  // namespace neritic::tools
