// When the frames of a run are. Two kinds: the host's clock, which waits for each frame unless a
// display has waited already; and simulated times, which do not wait. Nothing else paces a run.
// Plain value; the thread of the loop.
#pragma once

#include <optional>

#include "engine/sim/run_clock.hpp"
#include "engine/sim/step_pacer.hpp"

namespace neritic::testbed {

struct FrameTime {
  double time_s = 0.0;       // of the scene
  double next_time_s = 0.0;  // of the frame after it, as far as is known now
  // When it is seen or, without a display, was due; on the clock that paces the run.
  TimeNs run_ns = 0;
  TimeNs host_ns = 0;  // the same on the host's clock; simulated: 0
};

class Clock {
 public:
  enum class Frames { kSteps, kPictures };
  // The host's. If a display says when it shows the frames, their times are the display's, but
  // those of one whose time stands go on by the host's after a second.
  // Otherwise a frame is due each period. After a delay, steps are caught up (sim::StepPacer);
  // pictures are not, so that a late one does not make the next ones hurry. Time runs on over
  // what is dropped. run: that a person may stop or speed up, on which the frames' times are; it
  // outlives this.
  static Clock real(double start_s, double period_s, Frames frames = Frames::kSteps,
                    sim::RunClock* run = nullptr);
  // Frame k is at start_s + k * period_s. Nothing waits.
  static Clock simulated(double start_s, double period_s);
  // The same at (first + k) * period_s: the times of a simulation's steps from that one on, bit for
  // bit.
  static Clock steps(std::uint64_t first, double period_s);

  bool is_real() const { return real_; }
  // Waits for the next frame. display_at_ns: when a display that has waited already will show it.
  FrameTime next(std::optional<TimeNs> display_at_ns);
  std::uint64_t dropped() const { return pacer_ ? pacer_->counts().dropped : 0; }

 private:
  Clock(bool real, double start_s, double period_s, Frames kind, sim::RunClock* run)
      : real_(real), start_s_(start_s), period_s_(period_s), kind_(kind), run_(run) {}
  TimeNs wait_for_due();
  void see(TimeNs display_at_ns);

  bool real_;
  double start_s_, period_s_;
  Frames kind_;
  sim::RunClock* run_;
  std::uint64_t frames_ = 0;           // so far, with those before the first
  TimeNs begun_ns_ = 0, seen_ns_ = 0;  // of the first and the newest frame of a display
  // When the time of a display moved on last, by the host's clock, and to what; and when a frame
  // was asked for last, on the clock that paces the run.
  TimeNs moved_ns_ = 0, moved_to_ns_ = 0, saw_ns_ = 0;
  std::optional<sim::StepPacer> pacer_;  // without a display
  // Frames that the pacer gave last, and those of them that were not taken yet.
  int given_ = 0, due_ = 0;
};

}  // namespace neritic::testbed
