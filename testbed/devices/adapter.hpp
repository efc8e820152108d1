// A device's bytes as a diver's samples: what every device has in common. An adapter knows no
// socket and asks no clock: its caller says when bytes arrived, so that a run in simulated time
// gives the same samples as one by the host's clock. The thread of the device.
#pragma once

#include <limits>
#include <string>

#include "engine/net/clock_map.hpp"
#include "engine/net/counter_track.hpp"
#include "engine/net/wire_bytes.hpp"
#include "testbed/devices/outlet.hpp"
#include "testbed/samples/signal_queue.hpp"

namespace neritic::testbed {

inline constexpr TimeNs kMillisecond_ns = 1'000'000, kSecond_ns = 1'000'000'000;

class DeviceAdapter {
 public:
  static constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();

  virtual ~DeviceAdapter() = default;
  // Bytes that came then: a datagram, or the next ones of a stream. cut: the datagram was longer
  // than any of the device's, or the stream ended. Every datagram is counted once as used,
  // malformed, unused, repeated or older.
  void take(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
    receive(bytes, cut, arrived_ns, out);
  }
  // The time at which tick() has something to do if no bytes come before.
  virtual TimeNs wakes_at_ns() const { return kNever; }
  virtual void tick(TimeNs, Outlet&) {}

  const net::LinkCounts& counts() const { return counts_; }
  // How old the newest sample may be when it is sent: the inbox refuses older ones.
  virtual TimeNs max_age_ns() const { return SampleInbox::kMaxAge_ns; }
  // After so long without a packet of the sender that is used another sender may be used.
  virtual TimeNs silence_ns() const { return kSecond_ns; }
  // Why nothing of what comes is used, in words; empty: it is used.
  virtual std::string trouble() const { return {}; }
  net::ClockEstimate clock() const { return clock_.estimate(); }
  const net::ClockMap& clock_map() const { return clock_; }
  // Where the signal goes that the device sends, besides its samples; borrowed.
  virtual void give_signal_to(SignalQueue*) {}
  // Only where the protocol asks the device for its time (LSL).
  void exchange(TimeNs t0_ns, TimeNs t1_ns, TimeNs t2_ns, TimeNs t3_ns) {
    clock_.add_exchange(t0_ns, t1_ns, t2_ns, t3_ns);
  }

 protected:
  virtual void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) = 0;

  // Counts a datagram, and as used what `decode` counted as nothing else.
  template <class Decode>
  void datagram(net::Bytes bytes, bool cut, Decode decode) {
    ++counts_.datagrams;
    counts_.bytes += bytes.size();
    const std::uint64_t before = told();
    if (cut)
      ++counts_.malformed;
    else
      decode();
    if (told() == before) ++counts_.used;
  }

  net::LinkCounts counts_;
  net::ClockMap clock_;

 private:
  std::uint64_t told() const {
    return counts_.malformed + counts_.unused + counts_.repeated + counts_.older;
  }
};

}  // namespace neritic::testbed
