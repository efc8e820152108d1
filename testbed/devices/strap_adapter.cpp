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
// Half a period late is one too few: packets of Bluetooth jitter by less.
constexpr double kMissing = 1.5;
// A strap's clock that falls so far back was set anew, and so was one that leaps.
constexpr double kSetBack_s = 10.0, kLeap_s = 10.0;
// The rate counts as nominal until so much was seen, and is that of the last kRateOver_s. Frames
// whose length is off the nominal one by more than kOdd are not whole.
constexpr double kLearn_s = 5.0, kRateOver_s = 120.0, kOdd = 0.05;
// Frames' times jitter where a computer stamps them (LSL): by this share of what the monitor's time
// is behind a frame is longer, at most by kMostPull of its length.
constexpr double kPull = 0.1, kMostPull = 0.002;
// A slow heart leaves packets without an interval; after so long without one the rate counts.
constexpr TimeNs kIntervalCounts = 5 * kSecond_ns;
// The rates of a heart that a strap can find; 0: it is not worn.
constexpr int kLeastRate_bpm = 20, kMostRate_bpm = 300;

static_assert(1.0 / (1.0 - kOdd) + kMostPull < 1.0 + diver::HeartMonitor::kMostStretch);

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
  if (since_s > kMissing * kRatePeriod_s) {
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

void StrapAdapter::learn_rate(std::size_t samples, double length_s) {
  seen_samples_ += static_cast<double>(samples);
  seen_s_ += length_s;
  if (seen_s_ < kRateOver_s) return;
  seen_samples_ *= 0.5, seen_s_ *= 0.5;
}

double StrapAdapter::rate_hz() const {
  return seen_s_ < kLearn_s ? net::kEcg_hz : seen_samples_ / seen_s_;
}

// By the learnt rate, and nearer to the strap's clock.
double StrapAdapter::lasts_s(std::size_t samples) {
  const double length_s = static_cast<double>(samples) / rate_hz();
  const double pull_s = std::clamp(kPull * behind_s_, -kMostPull * length_s, kMostPull * length_s);
  behind_s_ -= pull_s;
  return length_s + pull_s;
}

void StrapAdapter::take_ecg(net::Bytes bytes, TimeNs arrived_ns, Outlet& out) {
  const auto frame = net::decode_ecg(bytes);
  if (!frame.ok()) {
    ++(frame.error().code == ErrorCode::kUnsupported ? counts_.unused : counts_.malformed);
    return;
  }
  const std::size_t count = frame->samples_uv.size();
  const double length_s = static_cast<double>(count) / rate_hz();
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
    } else if (step_s > kMissing * length_s) {
      counts_.lost += static_cast<std::uint64_t>(std::lround(step_s / length_s - 1.0));
      // Samples that are missing are none, so that no beat is found across the gap.
      ecg_->skip(std::min(step_s - length_s, kLongestGap_s));
    } else if (const double nominal_s = static_cast<double>(count) / net::kEcg_hz;
               std::abs(step_s - nominal_s) <= kOdd * nominal_s) {
      if (seen_s_ >= kLearn_s) behind_s_ += step_s - length_s;
      learn_rate(count, step_s);
    }
  }
  if (!ecg_) {
    ecg_.emplace(net::kEcg_hz);
    behind_s_ = 0.0;
  }
  last_ecg_ns_ = frame->time_ns;
  ecg_ns_ = arrived_ns;
  const std::vector<double> samples(frame->samples_uv.begin(), frame->samples_uv.end());
  ecg_->push(samples, lasts_s(count));
  const auto sent_ns = static_cast<TimeNs>(frame->time_ns & INT64_MAX);
  clock_.add(sent_ns, arrived_ns);
  // The stamp is the last sample's.
  if (signal_ && !samples.empty())
    signal_->push(clock_.to_host(sent_ns) -
                      std::llround(1e9 * static_cast<double>(samples.size() - 1) / rate_hz()),
                  rate_hz(), {samples.begin(), samples.end()});
  out.send(Heart{ecg_->state()}, clock_.to_host(sent_ns), arrived_ns);
}

}  // namespace neritic::testbed
