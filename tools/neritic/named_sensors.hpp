// The sensors of a scene that `--sensor` names, for every subcommand that has the flag.
#pragma once

#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::tools {

// Indices into the scene's cameras and sonars, in its order.
struct NamedSensors {
  std::vector<std::size_t> cameras, sonars;
};

// No names: every sensor. kBadInput for a name that the scene does not have.
Result<NamedSensors> named_sensors(const std::vector<std::string>& names,
                                   const scene::Scene& scene);

}  // namespace neritic::tools
