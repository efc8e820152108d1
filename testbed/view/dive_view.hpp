// A person's view of a run: a display with all its views, a camera to fly or the
// head that the display tracks, a vehicle flown by hand, the operator's console, screenshots.
// Rendering thread.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/sim/run_clock.hpp"
#include "engine/xr/display.hpp"
#include "testbed/loop/frame_view.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/view/console.hpp"
#include "testbed/view/dive_hud.hpp"
#include "testbed/view/dive_pilot.hpp"
#include "testbed/view/dive_prepare.hpp"
#include "testbed/view/dive_times.hpp"
#include "testbed/view/frame_timeline.hpp"
#include "testbed/view/picker.hpp"
#include "testbed/view/quality_governor.hpp"
#include "testbed/view/screenshots.hpp"
#include "testbed/view/viewpoints.hpp"
#include "testbed/view/wearer.hpp"

namespace neritic::testbed {

// A view's width or height at a scale of it, at least 1.
std::uint32_t scaled(std::uint32_t pixels, double scale);

struct DiveViewOptions {
  std::vector<xr::ActionDesc> actions = dive_actions();  // that the display was made with
  std::size_t viewpoint = 0;          // of viewpoints_of(scene): where the view begins
  std::vector<std::size_t> sonars;    // of the scene, those that have a panel
  bool summary = false;               // keep samples of times for one
  std::filesystem::path screenshot;   // of the last frame; empty: none
  bool may_fly = true;                // a vehicle by hand; not in a replay
  std::optional<DiveHudOptions> hud;  // instruments of a diver; needs physics with that diver
  // Where the machine needs longer for a frame than the display's period, quality comes down.
  bool governed = false;
  double least_budget_ms = 0.0;    // that quality is asked for, however short the period is
  sim::RunClock* clock = nullptr;  // of the run, for keys that stop or speed it up
  double frame_s = 1.0 / 30.0;     // that a step of time shows
  bool timeline = false;           // keep each frame's phases
  // Begins a frame while the device still draws the one before: more pictures, which are seen later
  // after what they show. For runs in simulated time.
  bool overlap = false;
  // The run's state and recording by key, with physics on a thread; empty: they give a note why
  // not.
  std::optional<RunKeeperOptions> keep;
  std::string no_keys_for_files;
  std::string nobody_to_steer;       // the note of the key that takes control, where it takes none
  std::string no_instruments;        // the note of the key for them, without `hud`
  ViewMemory memory;                 // as the last window looked
  const Devices* devices = nullptr;  // whose health the panels show; outlives the view
  bool beside_headset = false;       // the overlay is of a window beside it
  bool swim = false;  // the keys swim the first diver from the start; needs one, and a window
  hud::Units units = hud::Units::kMetric;  // of the panels
  std::string task;  // words for the person, in place of the operator's panels; empty: none
};

class DiveView final : public FrameView {
 public:
  // overlay may be nullptr: no panels; physics too: nothing to fly. All outlive the view. Where the
  // display's frames must not come late it draws its views unseen, so that their pipelines are
  // made.
  static Result<std::unique_ptr<DiveView>> create(Session& session, xr::Display& display,
                                                  xr::Overlay* overlay, LivePhysics* physics,
                                                  const DiveViewOptions& options);
  // Waits for the GPU, which may still use the fans and the screenshot after a failure.
  ~DiveView() override;

  Result<xr::FrameVerdict> begin_frame() override;
  std::optional<TimeNs> display_at_ns() const override { return frame_.display_at_ns; }
  bool in_frame() const override { return in_frame_; }
  bool shown() const override { return frame_.verdict == xr::FrameVerdict::kDraw; }
  bool take_input() override;
  std::uint32_t ping_every() const override;
  void add_views(FrameRequest& request) override;
  Status declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                 bool last) override;
  gpu::Frames::SubmitSync sync() const override;
  Status end_frame(std::optional<std::uint64_t> value) override;
  Status finish() override;

  // The keys' samples, for the simulation.
  SampleSource& pilot() { return pilot_; }
  // The person's, as a diver of the scene; nullptr: it has none, or it is a replay.
  SampleSource* wearer() { return wearer_ ? &*wearer_ : nullptr; }
  // Records by key: to be given each step; nullptr: nothing is recorded by key.
  StepSink* recorder() { return keeper_ ? &keeper_->sink() : nullptr; }
  const DiveTimes& times() const { return times_; }
  // The time for a frame; 0: quality is full, or nothing was shown yet.
  double budget_ms() const { return governor_ ? governor_->budget_ms() : 0.0; }
  const FrameTimeline& timeline() const { return timeline_; }
  const ViewChoice& choice() const { return choice_; }
  // How the window looks now, but for its size; nothing: it has no panels.
  std::optional<ViewMemory> memory() const;

 private:
  DiveView(Session& session, xr::Display& display, DivePilot pilot, const DiveViewOptions& options);
  Status prepare();
  Status draw_unseen(std::span<const xr::ViewGroup> groups, const UnseenPicture& picture,
                     bool sonars);
  ViewsRequest request_of(std::size_t group, std::uint32_t light) const;
  Pose world_from_stage(const scene::MotionSource& motion, double time_s);
  bool swum_by_keys(DiveInput& input);
  Status declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame);
  void take_time(const DiveInput& input);
  void take_click();
  void switch_lamps();
  std::uint32_t worn_object(const scene::MotionSource& motion, double time_s) const;
  DiveHudOptions choose_console_sensors();
  void add_inset(FrameRequest& request, const scene::MotionSource& motion);
  void add_console_camera(FrameRequest& request, const scene::MotionSource& motion);
  double seen_s(double time_s) const;
  Status declare_console_sonar(graph::FrameGraph& graph, const SensorFrame& frame);
  Status declare_hud(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                     std::vector<xr::Layer>& layers);
  void keep_run(const DiveInput& input);
  bool steers() const;
  std::string no_jacket() const;
  // A headset is worn, and an operator watches in a window beside it.
  bool watched() const { return options_.beside_headset && frame_.world_from_head.has_value(); }
  void tell(const std::string& note);
  Quality quality() const { return governor_ ? governor_->quality() : Quality{}; }
  double view_scale() const { return quality().view_scale; }
  Status await_device();
  Status collect_times(std::uint64_t completed);
  void govern();
  void add_work(std::span<const gpu::PassTime> passes, bool pinged);

  Session& session_;
  xr::Display& display_;
  LivePhysics* physics_ = nullptr;
  DiveViewOptions options_;
  ViewChoice choice_;
  DivePilot pilot_;
  std::optional<Wearer> wearer_;
  Pose world_from_stage_;  // of the last frame
  bool wears_ = true;      // is the diver; false: looks from another viewpoint
  bool placed_ = false;    // the stage was placed for a picture
  Pose world_from_head_;
  std::optional<RunKeeper> keeper_;
  std::unique_ptr<Console> console_;  // with an overlay
  std::unique_ptr<DiveHud> hud_;
  // What the HUD's console shows: indices into the scene's; absent: it has none.
  std::optional<std::size_t> console_sonar_, console_camera_;
  std::unique_ptr<SonarFans> console_fans_;  // while the console was shown
  // Of the request's view sets: the console's inset, the HUD's camera; absent: not in this frame.
  std::optional<std::size_t> inset_view_, camera_view_;
  std::optional<QualityGovernor> governor_;
  double lamp_share_ = 1.0;    // of those that the key switches
  bool works_jacket_ = false;  // a key of the jacket is held
  Screenshots screenshots_;
  Picker picker_;
  xr::DisplayFrame frame_;
  bool in_frame_ = false;
  TimeNs last_frame_ns_ = 0;  // 0: none, or it was hidden
  double elapsed_s_ = 0.0;
  bool pinged_ = false;  // sonars are drawn in this frame
  struct Flight {
    std::uint64_t value;
    bool pinged;
  };
  std::deque<Flight> in_flight_;  // submissions whose times are not collected yet
  DiveTimes times_;
  mutable FrameTimeline timeline_;  // sync() says when the recording ended
};

}  // namespace neritic::testbed
