// Errors about sonars for a scene's author: one line with the scene's file, the sonar's name and
// the key. Any thread.
#pragma once

#include "engine/core/result.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::testbed {

// The error with file and sonar before it, where it does not name them itself.
Error of_sonar(const scene::Scene& scene, const scene::Sonar& sonar, Error error);

// Whether the sonar can be planned, before there is a device.
Status check_sonar(const scene::Scene& scene, const scene::Sonar& sonar);

}  // namespace neritic::testbed
