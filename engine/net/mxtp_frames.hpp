// Puts a suit's frames together from their datagrams: a frame counts when all of its parts came, in
// any order. Parts of frames that are older than the newest whole one are dropped and counted.
// A segment that was refused keeps its last good value. One thread.
#pragma once

#include <vector>

#include "engine/net/counter_track.hpp"
#include "engine/net/mxtp.hpp"

namespace neritic::net {

struct SuitFrame {
  std::uint64_t sample = 0;   // without wraps
  std::uint64_t time_ms = 0;  // the sender's clock without wraps
  TimeNs first_ns = 0;        // arrival of its first part
  std::array<MxtpPose, kMxtpBodySegments> body{};
  // Left hand, right hand: the carpus, then three of the thumb and four of each finger.
  std::array<std::array<MxtpPose, kMxtpHandSegments>, 2> hands{};
  bool has_hands = false;
};

class SuitFrames {
 public:
  // Frames of that character alone.
  explicit SuitFrames(std::uint8_t character = 0) : character_(character) {}
  // The frame that this datagram completes; valid until the next call. nullptr: none yet.
  const SuitFrame* take(const MxtpDatagram& datagram, TimeNs arrived_ns, LinkCounts& counts);

  // Frames that may be incomplete at once, and datagrams of one.
  static constexpr std::size_t kPending = 16, kMostParts = 16;

 private:
  struct Pending {
    std::uint32_t sample = 0;
    std::uint32_t time_ms = 0;
    std::uint32_t parts = 0;  // bit i: datagram i came
    int last = -1;            // the number of the last one; -1: it did not come yet
    TimeNs at_ns = 0;
    std::vector<MxtpPose> poses;
    bool hands = false;
    bool used = false;
  };
  Pending* pending_of(const MxtpHeader& header, TimeNs arrived_ns, LinkCounts& counts);
  const SuitFrame* publish(Pending& pending, std::uint8_t props, LinkCounts& counts);

  std::uint8_t character_;
  CounterTrack samples_{32};
  std::array<Pending, kPending> pending_;
  std::array<bool, kMxtpBodySegments> known_{};
  SuitFrame frame_;
  std::uint32_t time_ms_ = 0;
  bool timed_ = false;
};

}  // namespace neritic::net
