// Chooses one of several senders at a port: the first whose packets are good is used until it has
// been silent for a second, or for as long as its kind may be. Packets of the others are not used.
// A sender is known by a number in its packets, or by its address. Plain value; one thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/clock.hpp"

namespace neritic::net {

class SenderChoice {
 public:
  explicit SenderChoice(TimeNs silence_ns = 1'000'000'000) : silence_ns_(silence_ns) {}

  // Whether a packet that arrived then may be used; one of another sender is noted.
  bool admits(std::uint64_t sender, TimeNs arrived_ns);
  // An admitted packet was good: its sender is the one that is used from now on. True: another one
  // was before.
  bool use(std::uint64_t sender, TimeNs arrived_ns);
  // Another sender, after kTold packets of it between each of which less than the silence went by,
  // the last of them within the silence before the newest packet.
  std::optional<std::uint64_t> other() const;

  static constexpr int kTold = 10;

 private:
  TimeNs silence_ns_;
  std::optional<std::uint64_t> used_;
  TimeNs used_ns_ = 0, newest_ns_ = 0;  // arrivals: of its newest packet, of anybody's
  std::uint64_t other_ = 0;
  TimeNs other_ns_ = 0;
  int others_ = 0;
};

}  // namespace neritic::net
