// A person's view of the loop's frames: a display with its views, and the person's actions. The
// loop calls it once a frame, in the order of the functions here; testbed/view has the one of
// `dive`. Rendering thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/xr/display.hpp"
#include "testbed/sensors/frame_request.hpp"
#include "testbed/sensors/sensor_frame.hpp"

namespace neritic::testbed {

class FrameView {
 public:
  virtual ~FrameView() = default;
  // Waits until the display wants a frame.
  virtual Result<xr::FrameVerdict> begin_frame() = 0;
  // When the frame is seen, if the display says so; whether it is seen at all, and not hidden.
  virtual std::optional<TimeNs> display_at_ns() const = 0;
  virtual bool shown() const = 0;
  // From begin_frame, unless the user quit, to end_frame.
  virtual bool in_frame() const = 0;
  // The user's actions since the last frame; true: quits.
  virtual bool take_input() = 0;
  // Each sonar gives one of this number of pings that are due.
  virtual std::uint32_t ping_every() const { return 1; }
  // The views that the display wants, from where the head is now.
  virtual void add_views(FrameRequest& request) = 0;
  // Adds the passes that show the frame; where it is hidden, those that keep its panels alone.
  virtual Status declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                         bool last) = 0;
  virtual gpu::Frames::SubmitSync sync() const = 0;
  // value: of the submission; absent: nothing was submitted.
  virtual Status end_frame(std::optional<std::uint64_t> value) = 0;
  // After the last frame.
  virtual Status finish() = 0;
};

}  // namespace neritic::testbed
