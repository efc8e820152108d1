// Snapshots of a state, and what the state is at any time between or just after the two newest:
// exact, interpolated or predicted, and said so. The physics thread publishes; each reader belongs
// to one thread. Times are those of the clock that drives the steps.
#pragma once

#include <cstdint>

#include "engine/core/clock.hpp"
#include "engine/core/math.hpp"
#include "engine/sim/triple_buffer.hpp"

namespace neritic::sim {

template <class State>
struct Snapshot {
  State state{};
  std::uint64_t step = 0;
  double time_s = 0.0;  // simulated: step * step_s
  TimeNs due_ns = 0;    // when the clock asked for this step; lock-step: the simulated time
  std::uint64_t hash = 0;
};

// The two newest, published together: a slow reader still gets neighbours.
template <class State>
struct SnapshotPair {
  Snapshot<State> previous, newest;
};

enum class BlendKind {
  kExact,         // a snapshot of just that time
  kInterpolated,  // between the two
  kPredicted,     // after the newer, along the line through both
  kHeld,          // outside of what can be said: the older one, or the prediction at its limit
};

template <class State>
struct Blended {
  State state{};
  BlendKind kind = BlendKind::kExact;
};

// Where a time lies between the two: share 0 is the older, 1 the newer, more is prediction.
struct BlendShare {
  double share = 1.0;
  BlendKind kind = BlendKind::kExact;
};
BlendShare blend_share(TimeNs previous_ns, TimeNs newest_ns, TimeNs time_ns, TimeNs max_predict_ns);

// Positions along the line, attitudes along the shortest turn; share may pass 1.
Pose blend_pose(const Pose& older, const Pose& newer, double share);

// The reader's end of a hand-off. Belongs to one thread.
template <class State>
class SnapshotReader {
 public:
  explicit SnapshotReader(TripleBuffer<SnapshotPair<State>>& source) : source_(&source) {}

  // Takes what is new; true where there was something.
  bool update() { return source_->update(); }
  const Snapshot<State>& newest() const { return source_->newest().newest; }
  const Snapshot<State>& previous() const { return source_->newest().previous; }

  // blend(older, newer, share) gives the state at a share of the way.
  template <class Blend>
  Blended<State> at(TimeNs time_ns, Blend&& blend, TimeNs max_predict_ns = 100'000'000) const {
    const auto& pair = source_->newest();
    const BlendShare where =
        blend_share(pair.previous.due_ns, pair.newest.due_ns, time_ns, max_predict_ns);
    if (where.share == 1.0) return {pair.newest.state, where.kind};
    if (where.share == 0.0) return {pair.previous.state, where.kind};
    return {blend(pair.previous.state, pair.newest.state, where.share), where.kind};
  }

 private:
  TripleBuffer<SnapshotPair<State>>* source_;
};

}  // namespace neritic::sim
