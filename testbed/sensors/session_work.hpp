// What one sensor has in a frame's graph: CPU data that must outlive the run, and the buffers that
// the host reads afterwards. Private to Session.
#pragma once

#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

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

struct SonarWork;

struct FrameWork {
  render::FrameState state;
  std::vector<std::unique_ptr<CameraWork>> cameras;
  std::vector<std::unique_ptr<SonarWork>> sonars;
  FrameWork();
  ~FrameWork();
};

// One eye's or sector's images of a view, where they were asked for, after the frame is done.
std::vector<ViewImages> decode_views(const ViewWork& work);

}  // namespace neritic::testbed
