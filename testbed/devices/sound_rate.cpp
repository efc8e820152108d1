#include "testbed/devices/sound_rate.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace neritic::testbed {
namespace {

// A longer step is a pause of the sender (RFC 3551, silence suppression) or a wrong timestamp.
constexpr double kMostSteps = 8.0;
constexpr double kLeastCount = 0.1;
// As much sound closes a window before its time: a sender that is fast by three and more.
constexpr double kMostSound_s = 10.0;
// Rates of sound cards (Hz); a measured one is taken for the nearest within kNamed.
constexpr std::array kCommon_hz{8'000.0,  11'025.0, 12'000.0, 16'000.0, 22'050.0, 24'000.0,
                                32'000.0, 44'100.0, 48'000.0, 88'200.0, 96'000.0, 192'000.0};
constexpr double kNamed = 0.035;

// In a form that does not change from window to window.
double rounded(double rate_hz) {
  for (const double common_hz : kCommon_hz)
    if (std::abs(rate_hz - common_hz) <= kNamed * common_hz) return common_hz;
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(rate_hz, 1.0))) - 1.0);
  return unit * std::round(rate_hz / unit);
}

}  // namespace

void SoundRate::begin(std::int64_t timestamp, TimeNs arrived_ns) {
  begun_ = timestamp;
  begun_ns_ = arrived_ns;
  steps_ = samples_ = 0.0;
}

void SoundRate::take(std::int64_t timestamp, std::size_t samples, bool follows, TimeNs arrived_ns) {
  if (!any_) begin(timestamp, arrived_ns);
  const auto step = static_cast<double>(timestamp - last_);
  const auto count = static_cast<double>(last_samples_);
  if (any_ && follows && step >= 0.0 && step <= kMostSteps * count) {
    steps_ += step;
    samples_ += count;
  }
  any_ = true;
  last_ = timestamp;
  last_samples_ = samples;
  if (arrived_ns - begun_ns_ < kWindow_ns && samples_ < kMostSound_s * rate_hz_) return;
  close(timestamp, arrived_ns);
  begin(timestamp, arrived_ns);
}

void SoundRate::close(std::int64_t timestamp, TimeNs arrived_ns) {
  const double elapsed_s = std::max(1e-9 * static_cast<double>(arrived_ns - begun_ns_), 1e-6);
  const double found_hz = static_cast<double>(timestamp - begun_) / elapsed_s;
  const Verdict verdict = std::abs(steps_ - samples_) > kMostCountOff * samples_ ? Verdict::kCount
                          : found_hz > rate_hz_ * (1.0 + kMostRateOff)           ? Verdict::kFast
                          : found_hz < rate_hz_ * (1.0 - kMostRateOff)           ? Verdict::kSlow
                                                                                 : Verdict::kAgrees;
  if (verdict == Verdict::kAgrees) {
    agreed_ = true;
    trouble_.clear();
  } else if (verdict == before_) {
    trouble_ = verdict == Verdict::kCount && steps_ < kLeastCount * samples_
                   ? "its timestamps count no samples"
               : verdict == Verdict::kCount
                   ? fmt::format(
                         "its packets have {:.1f} times the samples that their timestamps count; "
                         "used: 16 bits in one channel",
                         samples_ / steps_)
                   : fmt::format("it sends {:g} samples a second, not {:g}, the source's rate_hz",
                                 rounded(found_hz), rate_hz_);
  }
  before_ = verdict;
}

}  // namespace neritic::testbed
