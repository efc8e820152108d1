// The instruments over a view: layouts of hud/ as panels of the display. In a window each lies at
// its place, texel on pixel; where the display tracks a head, it is locked to head, wrist or world.
// A picture is drawn on the CPU, and uploaded only when it changed. Rendering thread.
#pragma once

#include <memory>
#include <vector>

#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/xr/display.hpp"
#include "hud/hud.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/instruments/instrument_feed.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/view/hud_places.hpp"

namespace neritic::testbed {

// Of pictures with new numbers, a second of the viewer, and of looks at the feed, a second of the
// scene: the last minute misses no breath where time runs fast.
inline constexpr double kHudRate_hz = 5.0;

struct DiveHudOptions {
  std::vector<hud::LayoutKind> layouts;  // empty: none
  hud::Units units = hud::Units::kMetric;
  std::size_t diver = 0;  // number of the diver among the world's
  // Names of the sonar and the camera that the console shows; empty: none.
  std::string sonar, camera;
};

// A picture of this frame's graph that can be copied; empty: none.
struct ConsolePicture {
  graph::ImageHandle image;
  std::uint32_t width = 0, height = 0;
};

// Where the panels are seen.
struct HudView {
  const xr::ViewGroup& group;  // its first view is the window's
  bool tracked = false;        // the display knows where the head is
  Pose world_from_stage;       // the display's space
  Pose world_from_view;        // of that first view
  // The left hand that instruments are worn on, at the wrist; absent: it is not tracked, and they
  // are held before the eyes, above the mask's where that is shown.
  std::optional<Pose> world_from_wrist = {};
  bool stage_at_eyes = false;  // the stage's origin is where the head was, not the floor
  // When the picture is seen, on a clock that neither stops nor hurries with the scene's; where
  // nobody waits for the pictures, their own time. Alarms last and flash by it.
  double seen_s = 0.0;
  ConsolePicture sonar, camera;  // the newest, where wants_pictures() said so
};

class DiveHud {
 public:
  // Borrows device, frames and physics, which must have that diver.
  // devices: of the run; nullptr: none.
  DiveHud(gpu::Device& device, gpu::Frames& frames, LivePhysics& physics, DiveHudOptions options,
          const Devices* devices = nullptr);
  // The instruments of any feed; options.diver is ignored.
  DiveHud(gpu::Device& device, gpu::Frames& frames, std::unique_ptr<InstrumentFeed> feed,
          DiveHudOptions options);

  // Adds the panels of this frame to the layers; those of which something changed are drawn anew.
  Status declare(graph::FrameGraph& graph, const HudView& view, std::vector<xr::Layer>& layers);

  // The pixels of a window that the instruments take from its panels.
  std::vector<PanelRect> taken(const xr::ViewGroup& group) const;

  // Whether the console is shown; whether a picture of it that is seen then takes new ones of sonar
  // and camera.
  bool shows_console() const { return shown(hud::LayoutKind::kConsole); }
  bool wants_pictures(double seen_s) const { return shows_console() && is_due(seen_s); }

  // The next choice: each layout alone, then none, then those of the options.
  void cycle();

 private:
  struct Instrument {
    hud::Hud hud;
    std::uint32_t height_px = 0;
    gpu::Image image;  // of the hud's picture, once it was uploaded
  };
  bool look(const HudView& view, bool anew);
  bool is_due(double seen_s) const;
  void lay_over(graph::FrameGraph& graph, const Instrument& instrument, const HudView& view,
                graph::ImageHandle& image) const;
  Result<graph::ImageHandle> declare_picture(graph::FrameGraph& graph, Instrument& instrument,
                                             std::uint32_t height_px, bool anew,
                                             const HudView& view);
  Status make_image(Instrument& instrument);
  // rect: of a window.
  xr::PanelLayer place(const Instrument& instrument, const HudView& view,
                       const PanelRect& rect) const;
  std::vector<HudPlace> places(const xr::ViewGroup& group) const;
  bool shown(hud::LayoutKind layout) const;

  gpu::Device& device_;
  gpu::Frames& frames_;
  std::unique_ptr<InstrumentFeed> feed_;
  DiveHudOptions options_;
  std::vector<Instrument> instruments_;  // one a layout, so that alarms and traces go on unseen
  std::size_t choice_ = 0;               // 0: the options'
  hud::DiveData data_;
  hud::OperatorData about_;
  std::vector<hud::StreamHealth> streams_;  // of about_
  double next_s_ = -1.0;                    // the scene time of the next look at the feed
  double next_seen_s_ = -1.0;               // when the next picture with new numbers is seen
  bool flash_ = false;                      // of the newest picture
};

}  // namespace neritic::testbed
