// The live program's frame loop: one display, one free camera, the scene's sonars at their own
// rates, panels over it. Each frame declares only what it needs. Rendering thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/xr/desktop/overlay.hpp"
#include "engine/xr/display.hpp"
#include "testbed/loop/dive_camera.hpp"
#include "testbed/loop/dive_fan.hpp"
#include "testbed/loop/dive_pilot.hpp"
#include "testbed/loop/dive_times.hpp"
#include "testbed/sensors/ping_schedule.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

struct DiveOptions {
  std::uint64_t frames = 0;          // stop after so many; 0: no limit
  double seconds = 0.0;              // of simulated time, then stop; 0: no limit
  std::filesystem::path screenshot;  // the last frame's picture; empty: none
  std::size_t camera = 0;            // of the scene, the one that is flown
  std::vector<std::size_t> sonars;   // of the scene, those that ping
  bool panels = true;                // draw them (else the camera's picture only)
  bool summary = false;              // keep samples for one
  bool may_close = false;            // any frame may be the last
  LivePhysics* physics = nullptr;    // of the scene's vehicles; outlives the Dive
};

class Dive {
 public:
  // overlay may be nullptr: no panels. All must outlive the Dive.
  Dive(gpu::Device& device, Session& session, xr::Display& display, xr::Overlay* overlay,
       const DiveOptions& options);
  Status run();

  std::uint64_t frames_drawn() const { return frames_drawn_; }
  double seconds() const { return seconds_; }
  const DiveTimes& times() const { return times_; }

 private:
  struct Shot {
    std::filesystem::path path;
    Readback texels;
    std::uint32_t width = 0, height = 0;
    bool bgra = false, by_key = false;
    std::uint64_t done = 0;  // the frame that fills it
  };
  Status frame(const xr::DisplayFrame& display_frame, bool last);
  void take_input(double elapsed_s);
  void aim_camera(const xr::DisplayFrame& display_frame);
  void add_due_sonars(FrameRequest& request);
  Status declare(graph::FrameGraph& graph, const xr::DisplayFrame& display_frame, bool last,
                 std::unique_ptr<SensorFrame>& live);
  Result<graph::ImageHandle> declare_overlay(graph::FrameGraph& graph, const SensorFrame& live);
  Status declare_shot(graph::FrameGraph& graph, const xr::ShownPicture& shown);
  Status write_shot(bool at_end);

  gpu::Device& device_;
  Session& session_;
  xr::Display& display_;
  xr::Overlay* overlay_;
  DiveOptions options_;
  FreeCamera camera_;
  DivePilot pilot_;
  Pose first_pose_, world_from_head_;
  std::unique_ptr<SonarFans> fans_;
  PingSchedule schedule_;  // of options_.sonars
  ReadbackPool readback_;
  std::optional<Shot> shot_;
  std::string note_;
  TimeNs note_until_ns_ = 0;
  bool show_help_ = false, show_panels_ = true, shot_wanted_ = false, quit_ = false;
  TimeNs start_ns_ = 0, last_frame_ns_ = 0;
  double time_s_ = 0.0, elapsed_s_ = 0.0, seconds_ = 0.0;
  std::uint64_t frames_drawn_ = 0, last_submitted_ = 0;
  DiveTimes times_;
};

}  // namespace neritic::testbed
