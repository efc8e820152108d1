// Whether sound packets come at the rate that they were declared to have. A packet's timestamp
// counts samples (RFC 3551), so that two things can be compared over windows of some seconds: the
// samples of packets one after another with the steps of their timestamps (other numbers of
// channels or of bits disagree), and the steps with the time that went by at the arrival (other
// rates disagree). One window that disagrees may be a stalled link or a wrong timestamp; two in a
// row that do so in the same way are not. Plain value; the thread of the device.
#pragma once

#include <cstdint>
#include <string>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

class SoundRate {
 public:
  explicit SoundRate(double rate_hz) : rate_hz_(rate_hz) {}

  // The next packet in the order of numbers. timestamp: of its first sample, without wraps;
  // follows: no packet is missing before it.
  void take(std::int64_t timestamp, std::size_t samples, bool follows, TimeNs arrived_ns);
  // The sender began anew.
  void restart() { *this = SoundRate(rate_hz_); }
  // Some window agreed, and the last two did not disagree.
  bool agrees() const { return agreed_ && trouble_.empty(); }
  // What disagrees, in words; empty: nothing.
  const std::string& trouble() const { return trouble_; }

  static constexpr TimeNs kWindow_ns = 3'000'000'000;
  // Common rates are at least 8 % apart. A link that is 0.18 s late at one end of a window changes
  // the rate by 6 %.
  static constexpr double kMostRateOff = 0.06;
  // Two channels are 2, 24 bits 1.5, 8 bits 0.5 of the samples that the timestamps tell.
  static constexpr double kMostCountOff = 0.2;

 private:
  enum class Verdict { kAgrees, kCount, kFast, kSlow };
  void close(std::int64_t timestamp, TimeNs arrived_ns);
  void begin(std::int64_t timestamp, TimeNs arrived_ns);

  double rate_hz_;
  bool any_ = false, agreed_ = false;
  std::int64_t begun_ = 0, last_ = 0;  // timestamps: of the window's first packet, of the last
  std::size_t last_samples_ = 0;
  TimeNs begun_ns_ = 0;
  double steps_ = 0.0, samples_ = 0.0;  // of packets in the window that another one follows
  Verdict before_ = Verdict::kAgrees;   // of the window before
  std::string trouble_;
};

}  // namespace neritic::testbed
