#include "testbed/devices/strap_adapter.hpp"

#include <algorithm>
#include <cmath>

#include "engine/net/heart_strap.hpp"

namespace neritic::testbed {
namespace {

// Straps send a rate each second: the same bytes sooner are the same packet.
constexpr TimeNs kSoon = kSecond_ns / 4;
// While an ECG comes, the strap's own rate is not needed.
constexpr TimeNs kEcgCounts = 3 * kSecond_ns;
// Straps send up to nine at once.
constexpr std::size_t kMostIntervals = 32;
constexpr double kLongestGap_s = 3600.0, kRatePeriod_s = 1.0;
// A strap's clock that falls so far back was set anew, and so was one that leaps.
constexpr double kSetBack_s = 10.0, kLeap_s = 10.0;
// A slow heart leaves packets without an interval; after so long without one the rate counts.
constexpr TimeNs kIntervalCounts = 5 * kSecond_ns;
// The rates of a heart that a strap can find; 0: it is not worn.
constexpr int kLeastRate_bpm = 20, kMostRate_bpm = 300;

}  // namespace

void StrapAdapter::receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
  datagram(bytes, cut, [&] {
    if (net::looks_like_ecg(bytes))
      take_ecg(bytes, arrived_ns, out);
    else
      take_rate(bytes, arrived_ns, out);
  });
}

void StrapAdapter::take_rate(net::Bytes bytes, TimeNs arrived_ns, Outlet& out) {
  const auto packet = net::decode_heart_rate(bytes);
  if (!packet.ok() || packet->intervals.size() > kMostIntervals ||
      (packet->bpm > 0 && (packet->bpm < kLeastRate_bpm || packet->bpm > kMostRate_bpm))) {
    ++counts_.malformed;
    return;
  }
  if (rate_ns_ > 0 && arrived_ns - rate_ns_ < kSoon && std::ranges::equal(bytes, last_rate_)) {
    ++counts_.repeated;
    return;
  }
  if (ecg_ns_ > 0 && arrived_ns - ecg_ns_ < kEcgCounts) {
    ++counts_.unused;
    return;
  }
  if (begun_ns_ == 0) begun_ns_ = arrived_ns;
  const double since_s =
      rate_ns_ > 0 ? 1e-9 * static_cast<double>(arrived_ns - rate_ns_) : kRatePeriod_s;
  rate_ns_ = arrived_ns;
  last_rate_.assign(bytes.begin(), bytes.end());
  double counted_s = 0.0;
  for (const std::uint16_t interval : packet->intervals) counted_s += net::kRrUnit_s * interval;
  const bool worn = packet->bpm > 0 && packet->contact.value_or(true);
  // Packets are missing: nobody knows the beats between.
  if (since_s > 2.0 * kRatePeriod_s) {
    counts_.lost += static_cast<std::uint64_t>(std::lround(std::min(since_s, 1e6))) - 1;
    if (by_intervals_ && worn && since_s > counted_s) {
      intervals_.skip(std::min(since_s - counted_s, kLongestGap_s));
      interval_ns_ = arrived_ns;
    }
  }
  if (!packet->intervals.empty()) {
    // Nobody knows the beats while the rate counted.
    const double unknown_s = 1e-9 * static_cast<double>(arrived_ns - interval_ns_) - counted_s;
    if (!by_intervals_ && interval_ns_ > 0 && worn && unknown_s > 0.0)
      intervals_.skip(std::min(unknown_s, kLongestGap_s));
    interval_ns_ = arrived_ns;
    by_intervals_ = true;
  } else if (worn && arrived_ns - interval_ns_ > kIntervalCounts) {
    by_intervals_ = false;
  }
  if (!worn) {
    intervals_.skip(std::clamp(since_s, 1e-3, kLongestGap_s));
    if (interval_ns_ > 0) interval_ns_ = arrived_ns;
  } else {
    for (const std::uint16_t interval : packet->intervals)
      intervals_.push_interval(net::kRrUnit_s * interval);
  }
  Heart heart{intervals_.state()};
  if (!by_intervals_) {
    heart.state.time_s = 1e-9 * static_cast<double>(arrived_ns - begun_ns_) + kRatePeriod_s;
    heart.state.rate_bpm = worn ? packet->bpm : 0.0;
    heart.state.last_beat_s = worn ? heart.state.time_s : 0.0;
    heart.state.quality = worn ? diver::SignalQuality::kGood : diver::SignalQuality::kNone;
  }
  // There is no time in the packet.
  out.send(heart, arrived_ns, arrived_ns);
}

// Samples that are missing are none, so that no beat is found across the gap.
void StrapAdapter::fill_gap(double gap_s) {
  if (gap_s > 0.5 / net::kEcg_hz) ecg_->skip(std::min(gap_s, kLongestGap_s));
}

void StrapAdapter::take_ecg(net::Bytes bytes, TimeNs arrived_ns, Outlet& out) {
  const auto frame = net::decode_ecg(bytes);
  if (!frame.ok()) {
    ++(frame.error().code == ErrorCode::kUnsupported ? counts_.unused : counts_.malformed);
    return;
  }
  const double length_s = static_cast<double>(frame->samples_uv.size()) / net::kEcg_hz;
  if (last_ecg_ns_) {
    const double step_s =
        1e-9 * static_cast<double>(static_cast<std::int64_t>(frame->time_ns - *last_ecg_ns_));
    if (step_s == 0.0) {
      ++counts_.repeated;
      return;
    }
    if (step_s < 0.0 && step_s > -kSetBack_s) {
      ++counts_.older;
      return;
    }
    if (step_s < 0.0 || step_s > kLeap_s) {
      ++counts_.restarts;
      ecg_.reset();
    } else if (step_s > 1.5 * length_s) {
      counts_.lost += static_cast<std::uint64_t>(std::lround(step_s / length_s - 1.0));
      fill_gap(step_s - length_s);
    }
  }
  if (!ecg_) ecg_.emplace(net::kEcg_hz);
  last_ecg_ns_ = frame->time_ns;
  ecg_ns_ = arrived_ns;
  const std::vector<double> samples(frame->samples_uv.begin(), frame->samples_uv.end());
  ecg_->push(samples);
  const auto sent_ns = static_cast<TimeNs>(frame->time_ns & INT64_MAX);
  clock_.add(sent_ns, arrived_ns);
  // The stamp is the last sample's.
  if (signal_ && !samples.empty())
    signal_->push(clock_.to_host(sent_ns) -
                      std::llround(1e9 * static_cast<double>(samples.size() - 1) / net::kEcg_hz),
                  net::kEcg_hz, {samples.begin(), samples.end()});
  out.send(Heart{ecg_->state()}, clock_.to_host(sent_ns), arrived_ns);
}

}  // namespace neritic::testbed
