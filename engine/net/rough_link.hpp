// A network that delays, loses, repeats, cuts and corrupts packets, for the simulators of devices
// and for tests. The same seed gives the same faults. One thread.
#pragma once

#include <queue>

#include "engine/core/clock.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

struct LinkFaults {
  double delay_s = 0.0;   // of every packet
  double jitter_s = 0.0;  // and evenly up to this much more, so that packets overtake one another
  // Shares of packets, 0 to 1.
  double loss = 0.0, repeat = 0.0, cut = 0.0, corrupt = 0.0, garbage = 0.0;
  std::uint64_t seed = 1;
};

class RoughLink {
 public:
  explicit RoughLink(const LinkFaults& faults) : faults_(faults) {}
  struct Packet {
    TimeNs due_ns = 0;
    std::uint64_t number = 0;  // of those that are due at once the first goes first
    std::vector<std::byte> bytes;
    bool operator>(const Packet& other) const {
      return due_ns != other.due_ns ? due_ns > other.due_ns : number > other.number;
    }
  };
  void send(TimeNs at_ns, std::vector<std::byte> bytes);
  bool empty() const { return waiting_.empty(); }
  // The next packet to arrive. Precondition: !empty().
  const Packet& next() const { return waiting_.top(); }
  Packet take_next();
  std::uint64_t sent() const { return sent_; }
  std::uint64_t lost() const { return lost_; }

 private:
  LinkFaults faults_;
  std::priority_queue<Packet, std::vector<Packet>, std::greater<>> waiting_;
  std::uint64_t sent_ = 0, lost_ = 0, queued_ = 0;
};

}  // namespace neritic::net
