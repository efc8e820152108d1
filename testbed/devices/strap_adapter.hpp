// A heart strap as a diver's heart: its ECG (Polar's measurement data), whose rate is learnt from
// the frames' own times, or, without one, the intervals that it counts itself (0x2A37), or the rate
// alone: that of packets which had no interval for five seconds. A rate that is neither 0 nor 20 to
// 300 is malformed. The thread of the device.
#pragma once

#include <optional>

#include "diver/heart_monitor.hpp"
#include "testbed/devices/adapter.hpp"

namespace neritic::testbed {

class StrapAdapter final : public DeviceAdapter {
 public:
  // It speaks once a second, of what was before.
  TimeNs max_age_ns() const override { return 3'000'000'000; }
  TimeNs silence_ns() const override { return 5 * kSecond_ns; }
  void give_signal_to(SignalQueue* ecg) override { signal_ = ecg; }

 private:
  void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) override;
  void take_rate(net::Bytes bytes, TimeNs arrived_ns, Outlet& out);
  void take_ecg(net::Bytes bytes, TimeNs arrived_ns, Outlet& out);
  void learn_rate(std::size_t samples, double length_s);
  double rate_hz() const;
  double lasts_s(std::size_t samples);

  diver::HeartMonitor intervals_;
  std::optional<diver::HeartMonitor> ecg_;
  bool by_intervals_ = false;                       // they tell the rate, not the field of it
  TimeNs begun_ns_ = 0, rate_ns_ = 0, ecg_ns_ = 0;  // arrivals: first, last of each
  TimeNs interval_ns_ = 0;                          // up to which intervals or gaps are known
  std::vector<std::byte> last_rate_;
  std::optional<std::uint64_t> last_ecg_ns_;  // by the strap's clock
  SignalQueue* signal_ = nullptr;
  // Samples of late and how long they lasted by the strap's clock, from which its rate is learnt,
  // and by how much the monitor's time lags behind that clock.
  double seen_samples_ = 0.0, seen_s_ = 0.0, behind_s_ = 0.0;
};

}  // namespace neritic::testbed
