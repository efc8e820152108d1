// Checks which flags of `neritic dive` go together: kBadInput for those that do not. Pure; any
// thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// Whether the flags ask for the physics alone: headless, and nothing that needs a picture.
bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene);
// Before anything is read: values, and flags that a window, a headset or a replay cannot have.
Status check_dive_flags(const DiveFlags& flags);
// Flags of physics where there is none, or that exclude each other.
Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene);
// pictures: whether the run draws any.
Status check_serve_flags(const DiveFlags& flags, const scene::Scene& scene, bool pictures);

}  // namespace neritic::tools
