// What frames are shown on: a desktop window, nothing at all (offscreen), a headset in a later
// version. One frame is: begin_frame (waits until the display wants one, says when it will be seen
// and through which eyes), declare and submit with the image and semaphores it gave, end_frame.
// Rendering thread.
#pragma once

#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"

namespace neritic::xr {

// One view of the display. head: where the wearer's or the desktop camera's eyes are between.
struct EyeView {
  Pose head_from_eye;
  FrustumTangents tangents;
};

enum class FrameVerdict {
  kDraw,  // declare, submit, end_frame
  kSkip,  // nobody would see it (minimised, between sizes): go round again, no end_frame
  kQuit,  // the user closed it
};

struct DisplayFrame {
  FrameVerdict verdict = FrameVerdict::kSkip;
  // When the picture will be seen, on the host clock: what moves is drawn where it is then.
  TimeNs predicted_display_ns = 0;
  std::uint32_t width = 1, height = 1;  // pixels of one eye's picture
  std::vector<EyeView> eyes;
};

class Display {
 public:
  virtual ~Display() = default;
  virtual Result<DisplayFrame> begin_frame() = 0;
  // The image that this frame's picture must be written to, completely; its contents are undefined
  // before. Between begin_frame and end_frame.
  virtual const gpu::Image& target() const = 0;
  // How the graph must leave it: the access of the output that the caller declares.
  virtual graph::Access target_access() const = 0;
  // What the frame's submission has to wait for and signal.
  virtual gpu::Frames::SubmitSync sync() const = 0;
  // Shows the picture. After the frame was submitted.
  virtual Status end_frame() = 0;
  // Vertical field of view of displays that have none of their own.
  virtual void set_vertical_fov(double rad) = 0;
};

// The target in the frame's graph, undefined until it is written.
inline graph::ImageHandle import_target(graph::FrameGraph& graph, const Display& display) {
  return graph.import_image(display.target(), {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                               VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED});
}

}  // namespace neritic::xr
