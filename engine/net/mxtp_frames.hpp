// Puts a suit's frames together from their datagrams: a frame counts when all of its parts came, in
// any order, with all of the body's segments. Parts of frames that are older than the newest whole
// one are dropped and counted. A segment that was refused keeps its last good value for half a
// second. One thread.
#pragma once

#include <optional>
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
  bool restarted = false;  // the first frame of a device that was started again
};

class SuitFrames {
 public:
  // Frames of that character alone.
  explicit SuitFrames(std::uint8_t character = 0) : character_(character) {}
  // The frame that this datagram completes; valid until the next call. nullptr: none yet.
  const SuitFrame* take(const MxtpDatagram& datagram, TimeNs arrived_ns, LinkCounts& counts);

  // Frames that may be incomplete at once, and datagrams of one.
  static constexpr std::size_t kPending = 16, kMostParts = 16;
  // A segment's value is not used for longer.
  static constexpr TimeNs kKept_ns = 500'000'000;
  // Frames in a row that lacked parts or segments.
  std::uint64_t incomplete() const { return incomplete_; }
  // Why no whole frame counts, in words; empty: they count.
  std::string trouble() const { return samples_.trouble(); }

 private:
  struct Pending {
    std::uint32_t sample = 0;
    std::uint32_t time_ms = 0;
    std::uint32_t parts = 0;  // bit i: datagram i came
    int last = -1;            // the number of the last one; -1: it did not come yet
    TimeNs at_ns = 0;
    std::vector<MxtpPose> poses;
    std::uint32_t refused = 0;  // items that came and are not among the poses
    bool hands = false;
    bool used = false;
  };
  Pending* pending_of(const MxtpHeader& header, TimeNs arrived_ns, LinkCounts& counts);
  const SuitFrame* publish(Pending& pending, std::uint8_t props, LinkCounts& counts);
  static bool has_body(const Pending& pending);

  std::uint8_t character_;
  CounterTrack samples_{32};
  std::array<Pending, kPending> pending_;
  // Arrivals of each segment's last good value.
  std::array<std::optional<TimeNs>, kMxtpBodySegments> body_ns_;
  std::array<std::optional<TimeNs>, 2 * kMxtpHandSegments> hands_ns_;
  std::uint64_t incomplete_ = 0;
  bool restarted_ = false;
  SuitFrame frame_;
  std::uint32_t time_ms_ = 0;
  bool timed_ = false;
};

}  // namespace neritic::net
