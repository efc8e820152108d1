// Maps a device's clock to the host's. A packet that was sent at s by the device's clock and
// arrived at a by the host's says that the host's clock is at most a - s ahead: the way took some
// time. Over the last two minutes a line under all such points is kept that lies near to them: the
// one nearest on average (linear programming over the lower convex hull: Moon, Skelly, Towsley
// 1999, Estimation and removal of clock skew from network delay measurements, INFOCOM), its slope
// averaged over pairs of quick packets that lie far apart. Jitter does not move it; nor does a
// packet whose time was corrupted, since a point counts if others near it agree; of a device that
// sends less than four packets a second each point counts. One way alone cannot tell a constant
// delay from an offset: the shortest way counts as none. Exchanges both ways do tell (LSL, NTP),
// and then bound the offset from both sides. Plain value; one thread.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "engine/core/clock.hpp"

namespace neritic::net {

struct ClockEstimate {
  bool known = false;
  double offset_s = 0.0;    // host minus device, now
  double drift_ppm = 0.0;   // by which the device's clock is slow; 0 in the first half minute
  double spread_ms = 0.0;   // of the way's time beyond the shortest: mean of late
  double longest_ms = 0.0;  // of the way beyond the shortest: largest of late
  std::uint64_t jumps = 0;  // times that the device's clock was set or started again
};

class ClockMap {
 public:
  // A packet; both clocks in ns. Allocates at most one bucket a second.
  void add(TimeNs sent_ns, TimeNs arrived_ns);
  // An exchange: host asks at t0, device hears at t1 and answers at t2, host hears at t3. The
  // device's times are t1 and t2.
  void add_exchange(TimeNs t0_ns, TimeNs t1_ns, TimeNs t2_ns, TimeNs t3_ns);
  // The host's time of that; the given time itself while nothing is known.
  TimeNs to_host(TimeNs sent_ns) const;
  ClockEstimate estimate() const;
  // Forgets all: the device was started again.
  void restart();

  static constexpr TimeNs kBucket_ns = 1'000'000'000;
  static constexpr std::size_t kBuckets = 120;
  // Clocks of computers drift by less (RFC 5905, 500 ppm).
  static constexpr double kMostDrift = 500e-6;
  static constexpr TimeNs kDriftAfter_ns = 30'000'000'000;
  // Packets one after another that arrive so long before they can, and agree as well as this, were
  // sent by a clock that was set.
  static constexpr TimeNs kEarly_ns = 100'000'000;
  static constexpr std::size_t kEarlyPackets = 3;
  // Packets that all come so late, for so long, likewise.
  static constexpr TimeNs kLate_ns = 2'000'000'000, kLateFor_ns = 3'000'000'000;

 private:
  struct Point {
    TimeNs sent_ns = 0, way_ns = 0;  // way: arrived - sent
  };
  // The quickest packets of a second by the device's clock, the quickest first.
  struct Bucket {
    std::array<Point, 16> quick;
    std::size_t count = 0;
    bool sparse = false;          // each of its packets is of a device that sends seldom
    std::optional<Point> agreed;  // the quickest that others near it agree with
    bool add(const Point& point);
  };
  enum class Verdict { kGood, kDoubtful, kJumped };
  void keep(TimeNs sent_ns, TimeNs arrived_ns);
  void choose_points(std::size_t changed);
  bool agreed(std::size_t bucket, std::size_t place) const;
  void fit();
  double slope_across(double share, double slope) const;
  void note_way(TimeNs way_ns);
  Verdict judge(TimeNs late_ns, TimeNs sent_ns, TimeNs arrived_ns);

  std::deque<Bucket> buckets_;  // oldest first
  std::vector<Point> lowest_;   // of the buckets, those that others agree with
  // The line: offset at base, and its slope.
  TimeNs base_sent_ns_ = 0, base_offset_ns_ = 0, newest_sent_ns_ = 0;
  double slope_ = 0.0;
  double spread_ns_ = 0.0, longest_ns_ = 0.0;
  struct Packet {
    TimeNs sent_ns = 0, arrived_ns = 0;
  };
  bool after_gap_ = false;  // the newest packet came long after the one before: two make it seldom
  std::vector<Packet> early_;  // the newest packets, if all came before they could
  TimeNs late_since_ns_ = 0;
  bool late_ = false;
  bool two_way_ = false;
  TimeNs best_round_ns_ = 0, shift_ns_ = 0,
         round_at_ns_ = 0;  // of the exchange with the shortest way
  std::uint64_t jumps_ = 0;
};

}  // namespace neritic::net
