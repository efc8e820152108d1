#include "testbed/view/frame_timeline.hpp"

#include <algorithm>

namespace neritic::testbed {

void FrameTimeline::begin(TimeNs now) {
  current_ = {.number = begun_++, .waiting = now};
}

void FrameTimeline::end(TimeNs now, std::optional<std::uint64_t> submission) {
  current_.ended = now;
  frames_.push_back(std::move(current_));
  submissions_.push_back(submission.value_or(0));
  current_ = {};
  if (frames_.size() <= kMostFrames) return;
  frames_.pop_front();
  submissions_.pop_front();
}

void FrameTimeline::passes_of(std::uint64_t submission, std::span<const gpu::PassTime> passes) {
  const auto found = std::find(submissions_.rbegin(), submissions_.rend(), submission);
  if (found == submissions_.rend()) return;
  FrameTimes& frame = frames_[static_cast<std::size_t>(submissions_.rend() - found) - 1];
  frame.passes.clear();
  for (const gpu::PassTime& pass : passes)
    if (pass.name != "record") frame.passes.push_back(pass);  // the host's
}

}  // namespace neritic::testbed
