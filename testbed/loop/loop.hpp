// The loop of every program that runs a scene: `render`, `dive` with and without pictures, the
// benchmark. They differ in what they give it: a clock, and any of simulation, sensors, sinks.
// Each iteration is one frame; without sensors it is one step of the simulation. The thread that
// runs it owns Vulkan.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "testbed/loop/clock.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/step_sink.hpp"
#include "testbed/sensors/frame_sink.hpp"
#include "testbed/sensors/ping_schedule.hpp"

namespace neritic::testbed {

// Cameras and sonars of the session's scene that someone wants.
struct LoopSensors {
  Session* session = nullptr;
  std::vector<std::size_t> cameras, sonars;
  Capture capture;
  bool own_rates = false;  // each at its own rate; else all in each frame
};

struct LoopStop {
  std::uint64_t frames = 0;           // 0: no limit
  std::function<bool()> interrupted;  // asked before each frame; empty: never
};

// All that is pointed to outlives the loop.
struct LoopParts {
  Clock clock;
  LivePhysics* physics = nullptr;
  std::vector<SampleSource*> sources;  // polled by the physics
  std::optional<LoopSensors> sensors;
  std::vector<StepSink*> step_sinks;
  std::vector<FrameSink*> frame_sinks;
  LoopStop stop;
};

class Loop {
 public:
  explicit Loop(LoopParts parts);
  // Once. Step sinks are finished also if a frame fails.
  Status run();

  std::uint64_t frames() const { return frames_; }
  double wall_s() const { return wall_s_; }
  bool interrupted() const { return interrupted_; }
  std::uint64_t dropped() const { return parts_.clock.dropped(); }

 private:
  Status run_frames();
  Status frame();
  Status sense(const FrameTime& at);
  void take_due(FrameRequest& request);
  // Asks whether the user stopped the run, or a source or a sink failed.
  bool stopped();
  Status finish(const Status& status);

  LoopParts parts_;
  std::optional<StepSinks> steps_;        // with physics and sinks
  std::optional<PingSchedule> schedule_;  // of the sensors, cameras first
  std::uint64_t frames_ = 0;
  double wall_s_ = 0.0;
  bool interrupted_ = false;
};

}  // namespace neritic::testbed
