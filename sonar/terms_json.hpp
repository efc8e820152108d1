// A sonar's settings as facts, for the .json beside what it made: in the keys and units of scenes
// (assets/scenes/README.md), so that a sensor can be written from them again.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/scene/scene.hpp"

namespace neritic::sonar {

// The terms that were named; what they rest on (frequency, water) where any is. Empty: none.
nlohmann::json terms_json(const scene::SonarTerms& terms);

// All of it but name, mount and track.
nlohmann::json sensor_json(const scene::Sonar& sonar);

}  // namespace neritic::sonar
