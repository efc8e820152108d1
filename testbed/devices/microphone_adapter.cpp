#include "testbed/devices/microphone_adapter.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {

namespace {

constexpr std::uint64_t kOthersTold = 50;  // packets in a row: a second, as most programs send

}  // namespace

MicrophoneAdapter::MicrophoneAdapter(double rate_hz, const diver::BreathSettings& settings)
    : rate_hz_(rate_hz),
      block_samples_(static_cast<std::size_t>(std::lround(settings.block_s * rate_hz))),
      analyser_(rate_hz, settings),
      rate_(rate_hz) {}

TimeNs MicrophoneAdapter::wire_ns(std::int64_t timestamp) const {
  return static_cast<TimeNs>(1e9 / rate_hz_ * static_cast<double>(timestamp));
}

void MicrophoneAdapter::begin_anew(std::uint64_t number) {
  waiting_.clear();
  next_ = number;
  if (!block_.empty() && any_) analyser_.lose(1, static_cast<double>(block_.size()) / rate_hz_);
  block_.clear();
  rate_.restart();
  timed_ = false;
  any_ = true;
}

// Counts a packet that is none, or of another kind.
bool MicrophoneAdapter::of_this_kind(const Result<net::RtpPacket>& packet) {
  if (!packet.ok() && packet.error().code != ErrorCode::kUnsupported) {
    ++counts_.malformed;
    return false;
  }
  other_ = !packet.ok() ? packet.error().message
           : packet->payload_type == net::kRtpL16 && rate_hz_ != net::kRtpL16_hz
               ? fmt::format(
                     "payload type 11 has {:g} samples a second, not {:g}, the source's "
                     "rate_hz",
                     net::kRtpL16_hz, rate_hz_)
               : "";
  others_ = other_.empty() ? 0 : others_ + 1;
  counts_.unused += !other_.empty();
  return other_.empty();
}

std::string MicrophoneAdapter::trouble() const {
  if (others_ >= kOthersTold) return other_;
  if (senders_.other()) return "a second microphone sends here too and is not used: one a port";
  return rate_.trouble().empty() ? sequence_.trouble() : rate_.trouble();
}

void MicrophoneAdapter::receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
  using Verdict = net::CounterTrack::Verdict;
  datagram(bytes, cut, [&] {
    auto packet = net::decode_rtp(bytes);
    if (!of_this_kind(packet)) return;
    if (!senders_.admits(packet->ssrc, arrived_ns)) {
      ++counts_.unused;
      return;
    }
    if (senders_.use(packet->ssrc, arrived_ns)) sequence_.restart();
    const Verdict verdict = sequence_.take(packet->sequence, arrived_ns, counts_);
    if (verdict == Verdict::kRepeated || verdict == Verdict::kDoubtful) return;
    const std::uint64_t newest = sequence_.newest();
    // Behind the newest by less than half a turn.
    const auto back =
        static_cast<std::uint16_t>(static_cast<std::uint16_t>(newest_wire_) - packet->sequence);
    if (verdict != Verdict::kOlder) newest_wire_ = packet->sequence;
    const std::uint64_t number = verdict == Verdict::kOlder ? newest - back : newest;
    if (verdict == Verdict::kRestarted) clock_.restart();
    if (!any_ || verdict == Verdict::kRestarted) begin_anew(number);
    counts_.unused += verdict != Verdict::kOlder && !rate_.trouble().empty();
    if (verdict == Verdict::kOlder && (back > newest || number < next_)) return;
    waiting_.insert_or_assign(number, Waiting{std::move(*packet), arrived_ns});
  });
  give(false, arrived_ns, out);
}

TimeNs MicrophoneAdapter::wakes_at_ns() const {
  return waiting_.empty() ? kNever : waiting_.begin()->second.arrived_ns + kWait_ns;
}

void MicrophoneAdapter::tick(TimeNs now_ns, Outlet& out) {
  if (now_ns >= wakes_at_ns()) give(true, now_ns, out);
}

// Gives packets in order; where one is missing for too long, those after the gap.
void MicrophoneAdapter::give(bool all, TimeNs now_ns, Outlet& out) {
  while (!waiting_.empty()) {
    const auto first = waiting_.begin();
    const bool waits = first->first != next_ && !all && waiting_.size() < kMostWaiting &&
                       now_ns < first->second.arrived_ns + kWait_ns;
    if (waits) return;
    const bool follows = first->first == next_;
    if (!follows) fill(first->first - next_, first->second.packet.samples.size());
    next_ = first->first + 1;
    hear(first->second.packet, follows, first->second.arrived_ns, out);
    waiting_.erase(first);
    all = false;
  }
}

void MicrophoneAdapter::fill(std::uint64_t packets, std::size_t samples) {
  const double gap_s = static_cast<double>(packets) * static_cast<double>(samples) / rate_hz_;
  if (gap_s > kMostFilled_s || last_.empty()) {
    analyser_.lose(0, gap_s + static_cast<double>(block_.size()) / rate_hz_);
    block_.clear();
    return;
  }
  for (std::uint64_t i = 0; i < packets; ++i)
    block_.insert(block_.end(), last_.begin(), last_.end());
}

void MicrophoneAdapter::hear(const net::RtpPacket& packet, bool follows, TimeNs arrived_ns,
                             Outlet& out) {
  // The timestamp of 32 bits wraps after a day or so.
  const auto step =
      static_cast<std::int32_t>(packet.timestamp - static_cast<std::uint32_t>(timestamp_));
  timestamp_ = timed_ ? timestamp_ + step : static_cast<std::int64_t>(packet.timestamp);
  timed_ = true;
  rate_.take(timestamp_, packet.samples.size(), follows, arrived_ns);
  const auto count = static_cast<std::int64_t>(packet.samples.size());
  // A packet leaves when its last sample was heard.
  clock_.add(wire_ns(timestamp_ + count), arrived_ns);
  if (sound_ && rate_.trouble().empty())
    sound_->push(clock_.to_host(wire_ns(timestamp_)), rate_hz_, packet.samples);
  last_ = packet.samples;
  block_.insert(block_.end(), packet.samples.begin(), packet.samples.end());
  if (block_.size() < block_samples_) return;
  if (!rate_.agrees()) {
    analyser_.lose(1, static_cast<double>(block_.size()) / rate_hz_);
    block_.clear();
    return;
  }
  Breath breath;
  breath.monitor = analyser_.take(block_);
  block_.clear();
  out.send(breath, clock_.to_host(wire_ns(timestamp_ + count)), arrived_ns);
}

}  // namespace neritic::testbed
