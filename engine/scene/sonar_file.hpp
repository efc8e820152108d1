// One acoustic sensor from a file of its own, as assets/sensors holds them, without a scene. Any
// thread; reads files.
#pragma once

#include <filesystem>

#include "engine/scene/scene.hpp"

namespace neritic::scene {

// The keys of a scene's [[sonars]] but those that say where it is mounted, at the top of the file;
// it may include another. Named after the file unless it says. kBadInput as load_scene says it.
Result<Sonar> load_sonar(const std::filesystem::path& path);

}  // namespace neritic::scene
