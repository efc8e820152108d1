// The one hand-off between the network and the simulation: a queue that never grows beyond its
// capacity and makes nobody wait to put something in. Any thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace neritic::testbed {

template <class Item>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  // False, and the item stays as it was: the queue is full.
  bool push(Item&& item) {
    {
      const std::lock_guard lock(mutex_);
      if (items_.size() >= capacity_) return false;
      items_.push_back(std::move(item));
    }
    filled_.notify_one();
    return true;
  }
  // Beyond the capacity too: for a sender whose items another bound limits.
  void push_always(Item&& item) {
    {
      const std::lock_guard lock(mutex_);
      items_.push_back(std::move(item));
    }
    filled_.notify_one();
  }
  // At most `most` items, the oldest first. Waits for the first so long.
  std::deque<Item> take(std::size_t most, std::chrono::nanoseconds wait = {}) {
    std::unique_lock lock(mutex_);
    if (wait.count() > 0) filled_.wait_for(lock, wait, [this] { return !items_.empty(); });
    if (items_.size() <= most) return std::exchange(items_, {});
    std::deque<Item> taken;
    for (; taken.size() < most; items_.pop_front()) taken.push_back(std::move(items_.front()));
    return taken;
  }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<Item> items_;
};

}  // namespace neritic::testbed
