// A person's view of a run: a display with all its views, a camera to fly or the
// head that the display tracks, a vehicle flown by hand, the sonars' fans, panels, screenshots.
// The loop calls it once a frame. Rendering thread.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/xr/desktop/overlay.hpp"
#include "engine/xr/display.hpp"
#include "testbed/loop/dive_camera.hpp"
#include "testbed/loop/dive_fan.hpp"
#include "testbed/loop/dive_pilot.hpp"
#include "testbed/loop/dive_times.hpp"
#include "testbed/loop/screenshots.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

struct DiveViewOptions {
  std::size_t camera = 0;            // of the scene: where the view begins, its exposure
  std::vector<std::size_t> sonars;   // of the scene, those that have a panel
  bool summary = false;              // keep samples of times for one
  std::filesystem::path screenshot;  // of the last frame; empty: none
  bool may_close = false;            // any frame may be the last
  bool may_fly = true;               // a vehicle by hand; not in a replay
};

class DiveView {
 public:
  // overlay may be nullptr: no panels; physics too: nothing to fly. All outlive the view.
  static Result<std::unique_ptr<DiveView>> create(Session& session, xr::Display& display,
                                                  xr::Overlay* overlay, LivePhysics* physics,
                                                  const DiveViewOptions& options);
  // Waits for the GPU, which may still use the fans and the screenshot after a failure.
  ~DiveView();

  // A frame, in this order. Waits until the display wants one.
  Result<xr::FrameVerdict> begin_frame();
  // When the frame is seen, if the display says so; whether it is seen at all, and not hidden.
  std::optional<TimeNs> display_at_ns() const { return frame_.display_at_ns; }
  // From begin_frame, unless the user quit, to end_frame.
  bool in_frame() const { return in_frame_; }
  bool shown() const { return frame_.verdict == xr::FrameVerdict::kDraw; }
  // The user's actions since the last frame; true: quits.
  bool take_input();
  // The keys' samples, for the simulation.
  SampleSource& pilot() { return pilot_; }
  // The views that the display wants, from where the head is now.
  void add_views(FrameRequest& request);
  // Adds the passes that show the frame; where it is hidden, those that keep the fans alone.
  Status declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s, bool last);
  gpu::Frames::SubmitSync sync() const;
  // value: of the submission; absent: nothing was submitted.
  Status end_frame(std::optional<std::uint64_t> value);
  // After the last frame.
  Status finish();

  const DiveTimes& times() const { return times_; }

 private:
  DiveView(Session& session, xr::Display& display, xr::Overlay* overlay, DivePilot pilot,
           const DiveViewOptions& options);
  Status declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame);
  Result<graph::ImageHandle> declare_overlay(graph::FrameGraph& graph, double time_s);
  Status collect_times(std::uint64_t completed);

  Session& session_;
  xr::Display& display_;
  xr::Overlay* overlay_;
  DiveViewOptions options_;
  FreeCamera camera_;
  DivePilot pilot_;
  Pose first_pose_, world_from_head_;
  std::unique_ptr<SonarFans> fans_;  // with an overlay
  Screenshots screenshots_;
  xr::DisplayFrame frame_;
  std::string note_;
  TimeNs note_until_ns_ = 0;
  bool show_help_ = false, show_panels_ = true, in_frame_ = false;
  TimeNs last_frame_ns_ = 0;  // 0: none, or it was hidden
  double elapsed_s_ = 0.0;
  std::deque<std::uint64_t> in_flight_;  // submissions whose times are not collected yet
  DiveTimes times_;
};

}  // namespace neritic::testbed
