// What one sensor has in a frame's graph: CPU data that must outlive the run, and the buffers that
// the host reads afterwards. Private to Session.
#pragma once

#include "tools/session/session.hpp"

namespace neritic::tools {

struct ViewWork {
  std::size_t index = 0;
  render::ViewSet views;
  render::DrawList draws;
  // Readback; nullptr: not asked for.
  const gpu::Buffer *depth = nullptr, *normal = nullptr, *label = nullptr, *color = nullptr,
                    *motion = nullptr;
};

struct CameraWork : ViewWork {
  graph::ImageHandle color_image;
};

struct SonarWork : ViewWork {
  Session::SonarState* state = nullptr;
  sonar::SonarGather::Outputs outputs;
};

struct FrameWork {
  render::FrameState state;
  std::vector<std::unique_ptr<CameraWork>> cameras;
  std::vector<std::unique_ptr<SonarWork>> sonars;
};

struct Session::SonarState {
  scene::Sonar made_from;
  sonar::Gather mode = sonar::Gather::kPlane;
  sonar::PixelSize size;
  double pixels_per_cell = 1.0;  // asked for; the device's largest image may allow less
  bool reflectivity = true;      // by object; false: all are 1
  std::unique_ptr<sonar::SonarGather> gather;
  gpu::Buffer sums, keys;  // host-readable
};

}  // namespace neritic::tools
