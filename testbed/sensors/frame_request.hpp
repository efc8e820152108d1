// One frame of a scene: which sensors and views, at what time, and what of each is wanted. Plain
// values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/render/views.hpp"
#include "engine/scene/motion.hpp"

namespace neritic::testbed {

struct Capture {
  bool color = true;     // of cameras and view sets
  bool geometry = true;  // depth, normals, labels, instances, of cameras, view sets and sonars
  bool motion = true;    // of cameras and view sets; with color only
  // Read-backs are declared, so that the frame can be read to a FrameResult. Else the frame's
  // handles are all there is, and nothing leaves the GPU.
  bool to_host = true;
};
// Colour for passes that draw with it, nothing at the host: what a window asks for.
inline constexpr Capture kColorOnGpu{
    .color = true, .geometry = false, .motion = false, .to_host = false};

// A view set that is no camera of the scene: a window's, a headset's views, the sides of a cube.
// One multiview pass draws all its views.
struct ViewsRequest {
  std::string name;  // of its passes; no sensor's or other view set's of the same frame
  render::ViewSet views;
  scene::Exposure exposure;
  bool antialias = false;
  Capture capture = kColorOnGpu;
};

struct FrameRequest {
  double time_s = 0.0;
  double next_time_s = 1.0 / 30.0;  // motion leads there
  std::uint32_t frame = 0;
  std::vector<std::size_t> cameras, sonars;  // indices into the scene's
  // The number of each sonar's ping: noise and a scanner's step follow from it. Empty: all are the
  // frame-th.
  std::vector<std::uint32_t> pings;
  Capture capture;  // of cameras and sonars
  std::vector<ViewsRequest> views;
  // Moves some objects instead of their tracks and clips; nullptr: none.
  const scene::SimulatedMotion* simulated = nullptr;
};

}  // namespace neritic::testbed
