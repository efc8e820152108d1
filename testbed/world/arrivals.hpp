// When readings reach a client: at once, or after a delay, with jitter and loss by stream, as over
// a network. The measurements and their times stay as they are; the same seed gives the same
// arrivals. Plain value; one thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

struct LinkOptions {
  double delay_s = 0.0;   // of every reading
  double jitter_s = 0.0;  // and evenly up to this much more: readings may overtake one another
  double loss = 0.0;      // share that never arrives, 0 to 1

  bool direct() const { return delay_s == 0.0 && jitter_s == 0.0 && loss == 0.0; }
};

// The arrival of a stream's reading; nothing: it is lost. Depends on seed, stream and sequence
// alone.
std::optional<TimeNs> arrival_of(const LinkOptions& link, std::uint64_t seed, std::uint32_t stream,
                                 std::uint64_t sequence, TimeNs sent_ns);

// Items on their way, the next to arrive first; of those that arrive at once the first sent.
template <class Item>
class OnTheWay {
 public:
  void send(TimeNs arrival_ns, Item item) {
    waiting_.push_back({arrival_ns, sent_++, std::move(item)});
    std::push_heap(waiting_.begin(), waiting_.end(), later);
  }
  bool due(TimeNs now_ns) const {
    return !waiting_.empty() && waiting_.front().arrival_ns <= now_ns;
  }
  // Precondition: due().
  Item take() {
    std::pop_heap(waiting_.begin(), waiting_.end(), later);
    Item item = std::move(waiting_.back().item);
    waiting_.pop_back();
    return item;
  }
  std::size_t size() const { return waiting_.size(); }
  void clear() { waiting_.clear(); }

 private:
  struct Entry {
    TimeNs arrival_ns = 0;
    std::uint64_t number = 0;
    Item item;
  };
  static bool later(const Entry& a, const Entry& b) {
    return a.arrival_ns != b.arrival_ns ? a.arrival_ns > b.arrival_ns : a.number > b.number;
  }
  std::vector<Entry> waiting_;  // a heap
  std::uint64_t sent_ = 0;
};

}  // namespace neritic::testbed
