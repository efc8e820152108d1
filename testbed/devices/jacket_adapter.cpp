#include "testbed/devices/jacket_adapter.hpp"

#include <algorithm>

#include "diver/jacket.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array kBits{diver::kInflate, diver::kDeflate, diver::kDump};
constexpr TimeNs kMostAhead_ns = 100 * kMillisecond_ns;

}  // namespace

void JacketAdapter::receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
  datagram(bytes, cut, [&] {
    const auto packet = net::decode_jacket(bytes);
    if (!packet.ok()) {
      ++counts_.malformed;
      return;
    }
    if (packet->counters) return take_counters(*packet, arrived_ns, out);
    std::uint64_t pressed = 0;
    for (std::size_t i = 0; i < kBits.size(); ++i) pressed |= packet->pressed[i] ? kBits[i] : 0;
    out.send(JacketButtons{pressed}, arrived_ns, arrived_ns);
  });
}

// Counts what was pressed in the scene until now.
void JacketAdapter::go_on(TimeNs now_ns) {
  for (std::size_t i = 0; i < kBits.size(); ++i)
    if ((given_ & kBits[i]) != 0) buttons_[i].given_ns += std::max<TimeNs>(now_ns - went_on_ns_, 0);
  went_on_ns_ = now_ns;
}

void JacketAdapter::take_counters(const net::JacketPacket& packet, TimeNs arrived_ns, Outlet& out) {
  using Verdict = net::CounterTrack::Verdict;
  const Verdict verdict = sequence_.take(packet.counters->sequence, arrived_ns, counts_);
  if (verdict != Verdict::kNew && verdict != Verdict::kRestarted) return;
  const auto sent_ns =
      static_cast<TimeNs>((packet.counters->time_us & (~std::uint64_t{0} >> 12)) * 1000);
  clock_.add(sent_ns, arrived_ns);
  go_on(arrived_ns);
  const bool anew = !any_ || verdict == Verdict::kRestarted || arrived_ns - heard_ns_ > kSilence_ns;
  any_ = true;
  heard_ns_ = arrived_ns;
  std::uint64_t pressed = 0;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    Button& button = buttons_[i];
    const std::uint16_t said_ms = packet.counters->pressed_ms[i];
    if (anew)
      button.said_ns = button.given_ns = 0;
    else
      button.said_ns += static_cast<std::uint16_t>(said_ms - button.said_ms) * kMillisecond_ns;
    button.said_ms = said_ms;
    // Jitter errs both ways; what was given too long is owed less the next time.
    button.given_ns = std::min(button.given_ns, button.said_ns + kMostAhead_ns);
    const TimeNs owed_ns = button.said_ns - button.given_ns;
    button.until_ns = !packet.pressed[i] && owed_ns >= kLeastOwed_ns ? arrived_ns + owed_ns : 0;
    if (packet.pressed[i] || button.until_ns > 0) pressed |= kBits[i];
  }
  given_ = pressed;
  out.send(JacketButtons{pressed}, clock_.to_host(sent_ns), arrived_ns);
}

TimeNs JacketAdapter::wakes_at_ns() const {
  TimeNs next = kNever;
  for (const Button& button : buttons_)
    if (button.until_ns > 0) next = std::min(next, button.until_ns);
  return next;
}

void JacketAdapter::tick(TimeNs now_ns, Outlet& out) {
  if (now_ns < wakes_at_ns()) return;
  go_on(now_ns);
  std::uint64_t pressed = given_;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    Button& button = buttons_[i];
    if (button.until_ns == 0 || now_ns < button.until_ns) continue;
    button.until_ns = 0;
    pressed &= ~kBits[i];
  }
  if (pressed == given_) return;
  given_ = pressed;
  out.send(JacketButtons{pressed}, now_ns, now_ns);
}

}  // namespace neritic::testbed
