// A sonar's settings as facts, for the .json beside what it made: in the keys and units of scenes
// (assets/scenes/README.md), so that a sensor can be written from them again.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/scene/scene.hpp"
#include "sonar/quality.hpp"

namespace neritic::sonar {

// The terms that were named; what they rest on (frequency, water) where any is. Empty: none.
nlohmann::json terms_json(const scene::SonarTerms& terms);

// All of it but name, mount and track.
nlohmann::json sensor_json(const scene::Sonar& sonar);

// The sampling of a sonar: the level, its measured error, and who asked for it: max_error, or if 0
// the level's name in the scene, or if chosen nobody.
nlohmann::json quality_json(const QualityLevel& level, double max_error, bool chosen);

}  // namespace neritic::sonar
