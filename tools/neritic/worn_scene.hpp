// A scene whose diver a person is: one who wears a headset, or swims by keys (`dive --swim`).
#pragma once

#include <string>

#include "engine/core/result.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::tools {

struct WornScene {
  scene::Scene scene;
  std::string text;  // what its file would say; a recording keeps it
};

// A diver moves by physics, whom a person can be.
bool has_diver(const scene::Scene& scene);
// A model's file that is shown alone, in which nobody dives.
bool is_model(const scene::Scene& scene);

// The scene with the diver "wearer" after all that its file says: assets/divers/recreational.toml,
// prone, with the eyes where the scene's first camera is and the head where that looks, at least
// 1 m deep, with a camera "eyes"; and bubbles where the scene has others'. Physics is on from then
// on: what is solid stops the diver. size: as load_scene_or_model().
// kBadInput for a model, which is no scene; kIo where assets/ does not lie above the program.
Result<WornScene> with_wearer(const scene::Scene& scene, const std::string& size);

}  // namespace neritic::tools
