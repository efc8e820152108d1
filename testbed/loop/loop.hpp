// The loop of every program that runs a scene: `render`, `dive` with and without pictures, the
// benchmark. They differ in what they give it: a clock, and any of a simulation, sensors, a view,
// sources and sinks. Each iteration is one frame; without sensors it is one step of the simulation.
// The thread that runs it owns Vulkan.
#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "testbed/loop/clock.hpp"
#include "testbed/loop/frame_view.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/step_sink.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/sensors/frame_sink.hpp"
#include "testbed/sensors/image_consumer.hpp"
#include "testbed/sensors/ping_schedule.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

// Cameras and sonars of the session's scene that someone wants. Any other is never declared.
struct LoopSensors {
  Session* session = nullptr;
  // For the view's panels and the frame sinks.
  std::vector<std::size_t> cameras, sonars;
  Capture capture;                        // to_host: for frame sinks
  bool own_rates = false;                 // each at its own rate; else all in each frame
  std::vector<ImageConsumer*> consumers;  // each with a schedule of its own
};

struct LoopStop {
  std::uint64_t frames = 0;  // with a view those that it shows; 0: no limit
  // Scene time since the first frame; 0: no limit. The last frame is at just that time, and the
  // physics ends with the first step that reaches it.
  double seconds = 0.0;
  std::function<bool()> interrupted;  // asked before each frame and step; empty: never
};

// Everything that is pointed to outlives the loop. After the run the physics no longer refers to
// the sources and sinks.
struct LoopParts {
  Clock clock;
  LivePhysics* physics = nullptr;
  std::optional<LoopSensors> sensors;
  FrameView* view = nullptr;  // with sensors
  // The pictures that objects show; with sensors, whose session has their places.
  scene::ObjectPictures* pictures = nullptr;
  std::vector<SampleSource*> sources;  // polled by the physics
  std::vector<StepSink*> step_sinks;
  std::vector<FrameSink*> frame_sinks;
  LoopStop stop;
};

class Loop {
 public:
  explicit Loop(LoopParts parts);
  // Once. Step sinks are finished also if a frame fails.
  Status run();
  // run() in parts, for someone who holds the clock: begin() once, then frames, then end() with the
  // first failure. stopped() between them tells of a failed source or sink.
  void begin();
  Status turn() { return frame(); }
  Status end(const Status& status);
  // Asks whether the user stopped the run, or a source or a step sink failed.
  bool stopped();

  std::uint64_t frames() const { return frames_; }
  double wall_s() const { return wall_s_; }
  bool interrupted() const { return interrupted_; }
  std::uint64_t dropped() const { return parts_.clock.dropped(); }

 private:
  Status run_frames();
  void restart_images();
  Status frame();
  // display_at_ns: when the view's display shows it.
  Status frame_at(std::optional<TimeNs> display_at_ns);
  double advance(const FrameTime& at);
  bool is_last(double time_s) const;
  // A frame's request, and who asked for what of it.
  struct Wanted {
    FrameRequest request;
    // For the frame sinks.
    std::vector<std::size_t> cameras, sonars;
    bool for_sinks = false;
    std::vector<std::vector<ImageConsumer::Asked>> of_consumers;
  };
  Wanted wanted_at(const FrameTime& at, double time_s);
  Status sense(Wanted wanted);
  Status show(Wanted wanted);
  Status give_done(bool wait);
  Status give(const Wanted& wanted, FrameResult result);
  Status finish(const Status& status);

  LoopParts parts_;
  std::optional<StepSinks> steps_;        // with physics and sinks
  std::optional<PingSchedule> schedule_;  // of the sensors, cameras first
  struct Pending {
    std::unique_ptr<SensorFrame> frame;
    Wanted wanted;
  };
  std::deque<Pending> pending_;            // submitted; the sinks do not have them yet
  std::uint64_t frames_ = 0, sensed_ = 0;  // frames; those that are for frame sinks
  double wall_s_ = 0.0;
  TimeNs begun_ns_ = 0;
  std::uint64_t restored_ = 0;                              // of the physics, as it was last seen
  double end_s_ = std::numeric_limits<double>::infinity();  // the scene time at which it ends
  bool started_ = false, interrupted_ = false, quit_ = false, last_ = false;
};

}  // namespace neritic::testbed
