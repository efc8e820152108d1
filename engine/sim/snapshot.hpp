// Snapshots of a state, the two newest at a time. The stepping thread publishes; each reader
// belongs to one thread and may come and go at any time. Times are those of the clock that drives
// the steps.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/math.hpp"
#include "engine/sim/triple_buffer.hpp"

namespace neritic::sim {

template <class State>
struct Snapshot {
  State state{};
  std::uint64_t step = 0;  // taken since time 0
  double time_s = 0.0;     // simulated: step * step_s
  TimeNs due_ns = 0;       // when the clock asked for this step; lock-step: as host_ns
  // The same on the host's clock, by which devices stamp; in simulated time that is the scene's.
  TimeNs host_ns = 0;
  std::uint64_t hash = 0;  // state_hash(step, state)

  // To be added to a time of the host's clock for the scene's.
  TimeNs scene_from_host_ns() const { return std::llround(time_s * 1e9) - host_ns; }
};

// The two newest, published together: a slow reader still gets neighbours.
template <class State>
struct SnapshotPair {
  Snapshot<State> previous, newest;
};

// Positions along the line, attitudes along the shortest turn; share may pass 1.
Pose blend_pose(const Pose& older, const Pose& newer, double share);

template <class State>
class SnapshotReader;

// Keeps the two newest snapshots and hands them to every reader. One thread puts; any thread makes
// and drops readers, meanwhile too. Outlives its readers.
template <class State>
class SnapshotSource {
 public:
  explicit SnapshotSource(const Snapshot<State>& start) : ring_{start, start, start} {}
  SnapshotSource(const SnapshotSource&) = delete;
  SnapshotSource& operator=(const SnapshotSource&) = delete;
  ~SnapshotSource() { NERITIC_CHECK(outlets_.empty(), "{} readers left", outlets_.size()); }

  // The thread that puts writes next(), whose content is of any earlier time, and puts it: it is
  // the newest then, and what was the newest is the previous.
  Snapshot<State>& next() { return ring_[(newest_ + 1) % 3]; }
  void put() {
    const std::lock_guard lock(mutex_);
    newest_ = (newest_ + 1) % 3;
    publish_all();
  }
  // The same thread: both become this one, as if nothing had been before.
  void restart(const Snapshot<State>& start) {
    const std::lock_guard lock(mutex_);
    ring_ = {start, start, start};
    publish_all();
  }
  // The same thread; valid until it puts twice.
  const Snapshot<State>& newest() const { return ring_[newest_]; }

  // Any thread. The new reader begins with the newest.
  SnapshotReader<State> reader();

 private:
  friend class SnapshotReader<State>;
  using Outlet = TripleBuffer<SnapshotPair<State>>;

  const Snapshot<State>& previous() const { return ring_[(newest_ + 2) % 3]; }
  SnapshotPair<State> copy() const {
    const std::lock_guard lock(mutex_);
    return {previous(), newest()};
  }
  void publish(Outlet& outlet) const {
    outlet.draft().previous = previous();
    outlet.draft().newest = newest();
    outlet.publish();
  }
  void publish_all() const {
    for (Outlet* outlet : outlets_) publish(*outlet);
  }
  void add(Outlet& outlet) {
    const std::lock_guard lock(mutex_);
    publish(outlet);
    outlets_.push_back(&outlet);
  }
  void remove(Outlet& outlet) {
    const std::lock_guard lock(mutex_);
    std::erase(outlets_, &outlet);
  }

  mutable std::mutex mutex_;  // guards newest_ and the list; snapshots in use are not written
  std::array<Snapshot<State>, 3> ring_;
  std::size_t newest_ = 0;
  std::vector<Outlet*> outlets_;
};

// One end of a hand-off. Belongs to one thread at a time; movable. Drop it before its source.
template <class State>
class SnapshotReader {
 public:
  SnapshotReader(SnapshotReader&& other) noexcept
      : source_(other.source_), outlet_(std::move(other.outlet_)) {}
  SnapshotReader& operator=(SnapshotReader&& other) noexcept {
    std::swap(source_, other.source_);
    std::swap(outlet_, other.outlet_);
    return *this;
  }
  ~SnapshotReader() {
    if (outlet_) source_->remove(*outlet_);
  }

  // Takes the newest pair; true where one was put since the last call.
  bool update() { return outlet_->update(); }
  const Snapshot<State>& newest() const { return outlet_->newest().newest; }
  const Snapshot<State>& previous() const { return outlet_->newest().previous; }

 private:
  friend class SnapshotSource<State>;
  using Outlet = TripleBuffer<SnapshotPair<State>>;

  // Memory is allocated before the source is locked, so that the stepping thread waits for one copy
  // at most.
  explicit SnapshotReader(SnapshotSource<State>& source)
      : source_(&source), outlet_(std::make_unique<Outlet>(source.copy())) {
    source.add(*outlet_);
    outlet_->update();
  }

  SnapshotSource<State>* source_;
  std::unique_ptr<Outlet> outlet_;
};

template <class State>
SnapshotReader<State> SnapshotSource<State>::reader() {
  return SnapshotReader<State>(*this);
}

}  // namespace neritic::sim
