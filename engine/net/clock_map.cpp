#include "engine/net/clock_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

namespace neritic::net {
namespace {

constexpr double kForget = 1.0 / 256.0;  // of the spread, a packet
// Parts of the time, at its beginning and its end, between whose quickest packets a slope is taken:
// for 40 links with 20 ms of even jitter and two packets a second the worst error after two minutes
// falls from 1.4 to 0.9 ms.
constexpr double kShares[] = {0.2, 0.3, 0.4, 0.5};
// A device that sends less often, as a heart strap, is remembered for ten minutes, so that there
// are as many quick packets among those of its last buckets.
constexpr TimeNs kSparse_ns = 250'000'000, kSparseBucket_ns = 5 * ClockMap::kBucket_ns;
// Two packets agree if their ways differ by less than this, which grows with their distance in
// time. A packet counts if this share of those near it agrees: of many a few agree by chance.
constexpr double kAgree_ns = 250'000.0, kAgreeDrift = 20e-6, kAgreeing = 0.03;
constexpr std::size_t kNearBuckets = 4;

// A device may say any time, so sums and differences of times wrap around instead of overflowing. A
// result that fits is exact.
TimeNs plus(TimeNs a, TimeNs b) {
  return static_cast<TimeNs>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
TimeNs difference(TimeNs a, TimeNs b) {
  return static_cast<TimeNs>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
double apart(TimeNs a, TimeNs b) {
  return static_cast<double>(difference(a, b));
}

}  // namespace

void ClockMap::restart() {
  const std::uint64_t jumps = jumps_;
  *this = {};
  jumps_ = jumps;
}

// How long the way took beyond the shortest; the longest is forgotten slowly.
void ClockMap::note_way(TimeNs way_ns) {
  const double way = std::max(0.0, static_cast<double>(way_ns));
  spread_ns_ += kForget * (way - spread_ns_);
  longest_ns_ = std::max(way, longest_ns_ * (1.0 - kForget / 16.0));
}

// Whether the device's clock was set: several packets in turn come before they can and agree, or
// all come late for long. A packet that is early or late alone has a wrong time.
ClockMap::Verdict ClockMap::judge(TimeNs late_ns, TimeNs sent_ns, TimeNs arrived_ns) {
  if (late_ns < -kEarly_ns) {
    if (!early_.empty()) {
      const Packet& before = early_.back();
      const double longer_ns =
          apart(difference(arrived_ns, sent_ns), difference(before.arrived_ns, before.sent_ns));
      if (std::abs(longer_ns) > static_cast<double>(kEarly_ns)) early_.clear();
    }
    early_.push_back({sent_ns, arrived_ns});
    return early_.size() < kEarlyPackets ? Verdict::kDoubtful : Verdict::kJumped;
  }
  early_.clear();
  if (late_ns <= kLate_ns) {
    late_ = false;
    return Verdict::kGood;
  }
  if (!std::exchange(late_, true)) late_since_ns_ = arrived_ns;
  return difference(arrived_ns, late_since_ns_) < kLateFor_ns ? Verdict::kDoubtful
                                                              : Verdict::kJumped;
}

void ClockMap::add(TimeNs sent_ns, TimeNs arrived_ns) {
  if (!buckets_.empty()) {
    const Verdict verdict = judge(difference(arrived_ns, to_host(sent_ns)), sent_ns, arrived_ns);
    if (verdict == Verdict::kDoubtful) return;
    if (verdict == Verdict::kJumped) {
      const std::vector<Packet> early = std::move(early_);
      ++jumps_;
      restart();
      for (const Packet& packet : early)
        if (packet.sent_ns != sent_ns || packet.arrived_ns != arrived_ns)
          keep(packet.sent_ns, packet.arrived_ns);
    }
  }
  keep(sent_ns, arrived_ns);
}

bool ClockMap::Bucket::add(const Point& point) {
  if (count == quick.size() && point.way_ns >= quick.back().way_ns) return false;
  std::size_t at = std::min(count, quick.size() - 1);
  for (; at > 0 && quick[at - 1].way_ns > point.way_ns; --at) quick[at] = quick[at - 1];
  quick[at] = point;
  count = std::min(count + 1, quick.size());
  return true;
}

void ClockMap::keep(TimeNs sent_ns, TimeNs arrived_ns) {
  const Point point{sent_ns, difference(arrived_ns, sent_ns)};
  const bool gap = !buckets_.empty() && difference(sent_ns, newest_sent_ns_) > kSparse_ns;
  const bool sparse = std::exchange(after_gap_, gap) && gap;
  const TimeNs bucket_ns = sparse ? kSparseBucket_ns : kBucket_ns;
  newest_sent_ns_ = buckets_.empty() ? sent_ns : std::max(newest_sent_ns_, sent_ns);
  const auto second = [&](TimeNs t) { return t / bucket_ns; };
  auto at = std::ranges::find_if(buckets_, [&](const Bucket& bucket) {
    return second(bucket.quick.front().sent_ns) >= second(sent_ns);
  });
  if (at == buckets_.end() || second(at->quick.front().sent_ns) != second(sent_ns))
    at = buckets_.insert(at, Bucket{.sparse = sparse});
  at->sparse = at->sparse && sparse;
  if (at->add(point)) {
    auto place = static_cast<std::size_t>(at - buckets_.begin());
    for (; buckets_.size() > kBuckets; place -= std::min<std::size_t>(place, 1))
      buckets_.pop_front();
    choose_points(place);
    fit();
  }
  note_way(difference(arrived_ns, to_host(sent_ns)));
}

// Whether enough of the quickest packets near this one took as long as it did. A device that sends
// seldom has too few packets for others to be as quick: each counts.
bool ClockMap::agreed(std::size_t bucket, std::size_t place) const {
  if (buckets_[bucket].sparse) return true;
  const Point& point = buckets_[bucket].quick[place];
  const std::size_t first = bucket - std::min(bucket, kNearBuckets);
  const std::size_t end = std::min(bucket + kNearBuckets + 1, buckets_.size());
  std::size_t all = 0, agree = 0;
  for (std::size_t b = first; b < end; ++b) all += buckets_[b].count;
  const double enough = std::max(1.0, kAgreeing * static_cast<double>(all - 1));
  for (std::size_t b = first; b < end; ++b)
    for (std::size_t i = 0; i < buckets_[b].count; ++i) {
      if (b == bucket && i == place) continue;
      const Point& other = buckets_[b].quick[i];
      const double apart_ns = apart(other.sent_ns, point.sent_ns);
      const double longer_ns = apart(other.way_ns, point.way_ns) - slope_ * apart_ns;
      agree += std::abs(longer_ns) <= kAgree_ns + kAgreeDrift * std::abs(apart_ns) ? 1 : 0;
      if (static_cast<double>(agree) >= enough) return true;
    }
  return false;
}

// The quickest packet of each bucket that others agree with; while none is, the quickest of all.
void ClockMap::choose_points(std::size_t changed) {
  const std::size_t end = std::min(changed + kNearBuckets + 1, buckets_.size());
  for (std::size_t b = changed - std::min(changed, kNearBuckets); b < end; ++b) {
    Bucket& bucket = buckets_[b];
    bucket.agreed.reset();
    for (std::size_t i = 0; i < bucket.count && !bucket.agreed; ++i)
      if (agreed(b, i)) bucket.agreed = bucket.quick[i];
  }
  lowest_.clear();
  for (const Bucket& bucket : buckets_)
    if (bucket.agreed) lowest_.push_back(*bucket.agreed);
  if (!lowest_.empty()) return;
  const auto way = [](const Bucket& bucket) { return bucket.quick.front().way_ns; };
  lowest_.push_back(std::ranges::min_element(buckets_, {}, way)->quick.front());
}

// The edge of the lower hull above the mean of all times says which packets were quick; the slope
// is the mean of those between quick packets far apart, since a short edge errs by much. Level
// while the times span little.
void ClockMap::fit() {
  const auto lowest = std::ranges::min_element(lowest_, {}, &Point::way_ns);
  base_sent_ns_ = lowest->sent_ns;
  base_offset_ns_ = lowest->way_ns;
  slope_ = 0.0;
  if (difference(lowest_.back().sent_ns, lowest_.front().sent_ns) < kDriftAfter_ns) return;
  const TimeNs from_ns = lowest_.front().sent_ns, level_ns = base_offset_ns_;
  struct Corner {
    double t, way;
  };
  std::vector<Corner> hull;
  double mean = 0.0;
  for (const Point& point : lowest_) {
    const Corner c{apart(point.sent_ns, from_ns), apart(point.way_ns, level_ns)};
    mean += c.t / static_cast<double>(lowest_.size());
    const auto above = [&](const Corner& a, const Corner& b) {
      return (b.way - a.way) * (c.t - a.t) >= (c.way - a.way) * (b.t - a.t);
    };
    while (hull.size() > 1 && above(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(c);
  }
  std::size_t i = 1;
  while (i + 1 < hull.size() && hull[i].t < mean) ++i;
  const Corner &a = hull[i - 1], &b = hull[i];
  const double edge = (b.way - a.way) / (b.t - a.t);
  double sum = 0.0;
  for (const double share : kShares) sum += slope_across(share, edge);
  slope_ = std::clamp(sum / static_cast<double>(std::size(kShares)), -kMostDrift, kMostDrift);
  const auto under = [&](const Point& point) {
    return apart(point.way_ns, level_ns) - slope_ * apart(point.sent_ns, from_ns);
  };
  const auto touched = std::ranges::min_element(lowest_, {}, under);
  base_sent_ns_ = touched->sent_ns;
  base_offset_ns_ = touched->way_ns;
}

// The slope from the quickest packet of the first share of the time to that of the last share;
// which they are depends on the slope itself, that of the edge to begin with.
double ClockMap::slope_across(double share, double slope) const {
  const TimeNs from_ns = lowest_.front().sent_ns, to_ns = lowest_.back().sent_ns;
  const auto part_ns = static_cast<TimeNs>(share * apart(to_ns, from_ns));
  for (int i = 0; i < 4; ++i) {
    const Point *first = &lowest_.front(), *last = &lowest_.back();
    const auto quicker = [&](const Point& one, const Point& other) {
      return apart(one.way_ns, other.way_ns) < slope * apart(one.sent_ns, other.sent_ns);
    };
    for (const Point& point : lowest_) {
      if (point.sent_ns <= plus(from_ns, part_ns) && quicker(point, *first)) first = &point;
      if (point.sent_ns >= difference(to_ns, part_ns) && quicker(point, *last)) last = &point;
    }
    if (last->sent_ns <= first->sent_ns) return slope;
    const double next = apart(last->way_ns, first->way_ns) / apart(last->sent_ns, first->sent_ns);
    if (next == slope) break;
    slope = next;
  }
  return slope;
}

void ClockMap::add_exchange(TimeNs t0_ns, TimeNs t1_ns, TimeNs t2_ns, TimeNs t3_ns) {
  add(t2_ns, t3_ns);
  const TimeNs round_ns = difference(difference(t3_ns, t0_ns), difference(t2_ns, t1_ns));
  if (round_ns < 0) return;
  // A good exchange counts for a minute.
  if (two_way_ && round_ns > best_round_ns_ && difference(t3_ns, round_at_ns_) < 60 * kBucket_ns)
    return;
  // Host minus device; by the line, the way back would take no time.
  const TimeNs offset_ns = std::midpoint(difference(t0_ns, t1_ns), difference(t3_ns, t2_ns));
  const TimeNs by_line_ns = difference(difference(to_host(t2_ns), shift_ns_), t2_ns);
  shift_ns_ = difference(offset_ns, by_line_ns);
  two_way_ = true;
  best_round_ns_ = round_ns;
  round_at_ns_ = t3_ns;
}

TimeNs ClockMap::to_host(TimeNs sent_ns) const {
  if (lowest_.empty()) return sent_ns;
  const auto drift_ns = static_cast<TimeNs>(slope_ * apart(sent_ns, base_sent_ns_));
  return plus(plus(sent_ns, base_offset_ns_), plus(shift_ns_, drift_ns));
}

ClockEstimate ClockMap::estimate() const {
  ClockEstimate out{.jumps = jumps_};
  if (lowest_.empty()) return out;
  out.known = true;
  out.offset_s = 1e-9 * apart(to_host(newest_sent_ns_), newest_sent_ns_);
  out.drift_ppm = 1e6 * slope_;
  out.spread_ms = 1e-6 * spread_ns_;
  out.longest_ms = 1e-6 * longest_ns_;
  return out;
}

}  // namespace neritic::net
