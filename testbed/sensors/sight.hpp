// Why a sensor shows nothing: its own carrier is in its way, or nothing is within its reach. From
// the geometry that it sees. Pure functions; any thread.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/scene/scene.hpp"
#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

// One line with the way out, for the scene's author; nothing where the sensor sees something.
// frame: with depth and instances.
std::optional<std::string> blindness(const scene::Scene& scene, const scene::Camera& camera,
                                     const CameraFrame& frame);
// heads: of one ping, with depth and instances of their sectors, which may miss what is smaller
// than their pixels. hears: whether the ping heard something of no class.
std::optional<std::string> blindness(const scene::Scene& scene, const scene::Sonar& sonar,
                                     std::span<const SonarFrame> heads, bool hears = false);

}  // namespace neritic::testbed
