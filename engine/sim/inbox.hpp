// What enters a simulation: any thread pushes messages, the stepping thread drains them at a step
// boundary, oldest first. Bounded: when full, the oldest gives way to the newest and is counted. A
// message with a number that is not finite is refused and counted.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/sim/fields.hpp"

namespace neritic::sim {

struct InboxCounts {
  std::uint64_t accepted = 0, refused = 0;  // refused: NaN or infinite
  std::uint64_t dropped = 0;                // accepted, then pushed out by newer ones
};

template <class Message>
class Inbox {
 public:
  explicit Inbox(std::size_t capacity) : ring_(capacity) {
    NERITIC_CHECK(capacity > 0, "capacity {}", capacity);
  }

  // Any thread. False where the message is refused.
  bool push(const Message& message) {
    const bool finite = all_finite(message);
    const std::lock_guard lock(mutex_);
    if (!finite) {
      ++counts_.refused;
      return false;
    }
    ++counts_.accepted;
    ring_[(first_ + count_) % ring_.size()] = message;
    if (count_ < ring_.size()) {
      ++count_;
    } else {
      first_ = (first_ + 1) % ring_.size();
      ++counts_.dropped;
    }
    return true;
  }

  // The consumer: moves all into out (whose memory is reused), oldest first.
  void drain(std::vector<Message>& out) {
    out.clear();
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < count_; ++i) out.push_back(ring_[(first_ + i) % ring_.size()]);
    first_ = count_ = 0;
  }

  InboxCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Message> ring_;
  std::size_t first_ = 0, count_ = 0;
  InboxCounts counts_;
};

}  // namespace neritic::sim
