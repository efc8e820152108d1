// The operator's console: what lies over the view in a window beside the diver's instruments.
// Participants, the sonars' fans, times, notes, the recording's light, the keys. It works the run's
// clock and files by key. Rendering thread.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/sim/run_clock.hpp"
#include "engine/xr/desktop/overlay.hpp"
#include "engine/xr/display.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/sensors/participants.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/view/dive_fan.hpp"
#include "testbed/view/dive_panels.hpp"
#include "testbed/view/dive_pilot.hpp"
#include "testbed/view/dive_times.hpp"
#include "testbed/view/picker.hpp"
#include "testbed/view/quality_governor.hpp"
#include "testbed/view/run_keeper.hpp"
#include "testbed/view/run_numbers.hpp"
#include "testbed/view/view_memory.hpp"
#include "testbed/view/viewpoints.hpp"

namespace neritic::testbed {

struct ConsoleOptions {
  std::vector<xr::ActionDesc> actions;  // as they are bound
  std::vector<std::size_t> sonars;      // of the scene, those that have a panel
  sim::RunClock* clock = nullptr;       // of the run, for its pace
  const RunKeeper* keeper = nullptr;
  LivePhysics* physics = nullptr;    // whose numbers are drawn; nullptr: nothing moves by physics
  ViewMemory memory;                 // as the last window looked
  const Devices* devices = nullptr;  // of the run
  bool steers = false;               // a key flies a vehicle or swims a diver
  hud::Units units = hud::Units::kMetric;
  std::string task;  // for the person; the panels are off until they are asked for
};

// State of the view in this frame.
struct ConsoleFrame {
  const xr::ViewGroup& group;
  const ViewChoice& choice;
  const DivePilot& pilot;
  const DiveTimes& times;
  double elapsed_s = 0.0, time_s = 0.0;
  Quality quality;
  std::vector<PanelRect> taken;  // by a diver's instruments, pixels
  // The picture of the camera that inset() names; empty: it is not drawn in this frame.
  graph::ImageHandle inset;
  // Beside a headset that is worn: the wearer's head.
  std::optional<Pose> world_from_head;
  int worn = -1;  // the object of the diver who wears it; -1: none, he looks from a viewpoint
};

class Console {
 public:
  // session and overlay outlive it.
  static Result<std::unique_ptr<Console>> create(Session& session, xr::Overlay& overlay,
                                                 const ConsoleOptions& options);

  xr::InputClaims claims() const { return overlay_.claims(); }
  void take(const DiveInput& input);
  // The camera of the scene whose picture lies in a panel; nothing: none.
  std::optional<std::size_t> inset() const { return show_panels_ ? inset_ : std::nullopt; }
  // Where the user clicked in the picture, since this was asked last: 0 to 1 from left and top.
  std::optional<Vec2> take_click() { return std::exchange(clicked_, std::nullopt); }
  // Words at a place of the picture, for a while.
  void mark(Picked picked);
  // The panel that the cursor is over, of the whole picture.
  std::optional<xr::PanelPart> panel_under_cursor() const { return hovered_; }
  ViewMemory memory() const;
  // A line for a while.
  void note(std::string text);
  // Vehicles, divers and animals: where they are and what they do. eye_m: of the view.
  void look(const scene::MotionSource& motion, double time_s, const DivePilot& pilot,
            const Vec3& eye_m);
  // Each ping becomes its sonar's fan, also while the panels are hidden: they show the newest when
  // they are back.
  Status declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame);
  // The panel over the view's first group; nothing where all is hidden.
  Result<std::optional<xr::PanelLayer>> declare(graph::FrameGraph& graph,
                                                const ConsoleFrame& frame);

 private:
  Console(Session& session, xr::Overlay& overlay, const ConsoleOptions& options);
  PanelFacts facts(graph::FrameGraph& graph, const ConsoleFrame& frame);
  std::string recording() const;
  std::optional<DiverGauge> diver_gauge(int object) const;
  Readout readout(const ConsoleFrame& frame) const;
  std::string standing_hint(bool worn) const;
  void draw(graph::FrameGraph& graph, const ConsoleFrame& frame);
  void add_on_demand(graph::FrameGraph& graph, const ConsoleFrame& frame, PanelFacts& facts);
  void draw_mark(TimeNs now_ns, float scale, std::span<const PanelRect> instruments) const;
  void look_at_cursor();
  void show_sonars();
  void toggle_graphs();
  void work_sonars(const DiveInput& input);

  Session& session_;
  xr::Overlay& overlay_;
  ConsoleOptions options_;
  std::unique_ptr<SonarFans> fans_;
  std::string note_;
  TimeNs note_until_ns_ = 0;
  bool show_panels_ = true, show_times_ = false;
  std::optional<std::size_t> help_page_;
  std::size_t help_pages_ = 1;
  std::size_t first_sonar_ = 0;  // of the panels
  std::vector<Participant> participants_;
  std::vector<ParticipantRow> rows_;  // of this frame
  std::vector<MapMark> marks_;
  MapMark eye_;
  MapTrails trails_;
  RunNumbers numbers_;
  GraphChoice graphs_;
  bool show_map_ = false, show_graphs_ = false;
  std::optional<std::size_t> inset_;
  double gain_db_ = 0.0, range_part_ = 1.0;  // of the sonars' pictures
  std::optional<Vec2> clicked_;
  std::optional<Picked> picked_;
  TimeNs picked_until_ns_ = 0;
  std::optional<xr::PanelPart> hovered_;
};

}  // namespace neritic::testbed
