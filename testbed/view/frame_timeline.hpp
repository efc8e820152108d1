// When each phase of a frame was: what the host did from the wait for the display to the end of the
// frame, and how long the device took for its passes. Plain value; rendering thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/gpu/frames.hpp"

namespace neritic::testbed {

// Host clock; 0: the frame did not get so far. The phases follow one another: wait for the display
// until begun, simulation and declaration until declared, recording until recorded, submission
// until submitted, the display's end of frame until ended.
struct FrameTimes {
  std::uint64_t number = 0;
  TimeNs waiting = 0, begun = 0, declared = 0, recorded = 0, submitted = 0, ended = 0;
  std::optional<TimeNs> display_at;  // when the display says that it is seen
  double view_scale = 1.0;           // of the view's resolution
  // The device's passes in their order; not when each began, which host clocks do not know.
  std::vector<gpu::PassTime> passes;
};

class FrameTimeline {
 public:
  // An hour at 5 frames a second; beyond, the oldest go.
  static constexpr std::size_t kMostFrames = 18000;

  // A frame's phases, in their order. begin() drops a frame that did not end.
  void begin(TimeNs now);
  FrameTimes& current() { return current_; }
  // submission: its number, where there was one; its passes come later.
  void end(TimeNs now, std::optional<std::uint64_t> submission);
  void passes_of(std::uint64_t submission, std::span<const gpu::PassTime> passes);

  const std::deque<FrameTimes>& frames() const { return frames_; }

 private:
  FrameTimes current_;
  std::uint64_t begun_ = 0;
  std::deque<FrameTimes> frames_;
  std::deque<std::uint64_t> submissions_;  // of frames_; 0: none
};

}  // namespace neritic::testbed
