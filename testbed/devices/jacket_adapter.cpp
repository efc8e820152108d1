#include "testbed/devices/jacket_adapter.hpp"

#include <algorithm>

#include "diver/jacket.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array kBits{diver::kInflate, diver::kDeflate, diver::kDump};
constexpr TimeNs kMostAhead_ns = 100 * kMillisecond_ns;
// The sender reads its clock and its counters at different times.
constexpr TimeNs kSenderSlack_ns = 50 * kMillisecond_ns;

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

// No button is pressed for longer than the time since the packet before, by the sender's clock
// where that goes on, and by the host's with the delay that a packet may have.
bool JacketAdapter::plausible(const net::UbcdCounters& now, TimeNs arrived_ns,
                              const Heard& before) const {
  TimeNs most_ns = std::max<TimeNs>(arrived_ns - before.at_ns, 0) + kSilence_ns;
  const std::uint64_t passed_us = now.time_us - before.counters.time_us;
  if (passed_us > 0 && passed_us < static_cast<std::uint64_t>(most_ns / 1000))
    most_ns = std::min(most_ns, static_cast<TimeNs>(passed_us) * 1000 + kSenderSlack_ns);
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    const auto more_ms =
        static_cast<std::uint16_t>(now.pressed_ms[i] - before.counters.pressed_ms[i]);
    if (more_ms * kMillisecond_ns > most_ns) return false;
  }
  return true;
}

void JacketAdapter::take_counters(const net::JacketPacket& packet, TimeNs arrived_ns, Outlet& out) {
  using Verdict = net::CounterTrack::Verdict;
  if (!jackets_.admits(packet.counters->device, arrived_ns)) {
    ++counts_.unused;
    return;
  }
  if (jackets_.use(packet.counters->device, arrived_ns)) sequence_.restart();
  const Verdict verdict = sequence_.take(packet.counters->sequence, arrived_ns, counts_);
  if (verdict != Verdict::kNew && verdict != Verdict::kRestarted) return;
  const auto sent_ns =
      static_cast<TimeNs>((packet.counters->time_us & (~std::uint64_t{0} >> 12)) * 1000);
  bool anew = !heard_ || verdict == Verdict::kRestarted || arrived_ns - heard_->at_ns > kSilence_ns;
  // Counters that leap count only if the next packet goes on from there, and then for nothing.
  if (!anew && !plausible(*packet.counters, arrived_ns, *heard_)) {
    anew = leapt_ && plausible(*packet.counters, arrived_ns, *leapt_);
    if (!anew) {
      leapt_ = {*packet.counters, arrived_ns};
      ++counts_.malformed;
      return;
    }
  }
  leapt_.reset();
  if (verdict == Verdict::kRestarted) clock_.restart();
  clock_.add(sent_ns, arrived_ns);
  go_on(arrived_ns);
  const Heard before = heard_.value_or(Heard{});
  heard_ = {*packet.counters, arrived_ns};
  std::uint64_t pressed = 0;
  for (std::size_t i = 0; i < kBits.size(); ++i) {
    Button& button = buttons_[i];
    const std::uint16_t said_ms = packet.counters->pressed_ms[i];
    if (anew)
      button.said_ns = button.given_ns = 0;
    else
      button.said_ns +=
          static_cast<std::uint16_t>(said_ms - before.counters.pressed_ms[i]) * kMillisecond_ns;
    button.said_ns = std::min(button.said_ns, button.given_ns + kSilence_ns);
    // Jitter errs both ways; what was given too long is owed less the next time.
    button.given_ns = std::min(button.given_ns, button.said_ns + kMostAhead_ns);
    const TimeNs owed_ns = button.said_ns - button.given_ns;
    button.until_ns = !packet.pressed[i] && owed_ns >= kLeastOwed_ns ? arrived_ns + owed_ns : 0;
    if (packet.pressed[i] || button.until_ns > 0) pressed |= kBits[i];
  }
  given_ = pressed;
  out.send(JacketButtons{pressed}, clock_.to_host(sent_ns), arrived_ns);
}

std::string JacketAdapter::trouble() const {
  if (const auto other = jackets_.other())
    return fmt::format("jacket {} sends here too and is not used: one jacket a port", *other);
  return sequence_.trouble();
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
