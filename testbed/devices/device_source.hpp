// One device of a scene while the scene runs: its feed, its adapter and its thread. The thread
// pushes into the inbox and shares nothing else; bytes that it has not read yet wait in the
// kernel's bounded queue. In a run in simulated time there is no thread: the loop polls, and all
// bytes that are there arrived at the time of the poll.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "engine/net/sender_choice.hpp"
#include "testbed/devices/adapter.hpp"
#include "testbed/devices/feed.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// The state of a device and its link, for an operator.
struct DeviceHealth {
  std::string name, device, where;  // "suit", "mxtp", "udp://127.0.0.1:9763"
  net::LinkCounts link;
  net::ClockEstimate clock;
  std::uint64_t samples = 0, accepted = 0;  // sent to the inbox; those that it took
  TimeNs heard_ns = 0;                      // arrival of the newest datagram; 0: none came
  double rate_hz = 0.0;                     // datagrams of late
  std::string trouble;                      // of the connection, or why nothing is used
};
// The first news for an operator: no datagram came yet, some came within a second, or none did.
enum class LinkState { kWaiting, kHeard, kSilent };
LinkState link_state(const DeviceHealth& health, TimeNs now_ns);

// "suit (mxtp, udp://127.0.0.1:9763): 480 packets a second, 2.0 % lost, clock -12.345678 s, drift
// 12 ppm, jitter 10 ms (longest 20)". now_ns: on the clock of heard_ns.
std::string health_words(const DeviceHealth& health, TimeNs now_ns);

// The same in short: "suit 480/s, 2.0 % lost, clock +12 ppm"; and one line of a panel.
std::string link_words(const DeviceHealth& health);
std::string stream_words(const DeviceHealth& health, TimeNs now_ns);

class DeviceSource final : public SampleSource {
 public:
  enum class Pace { kThread, kPolled };
  // Opens it, and begins to receive. An Error names the source. Borrows world and inbox.
  static Result<std::unique_ptr<DeviceSource>> open(const scene::DeviceSource& source,
                                                    const PhysicsWorld& world, SampleInbox& inbox,
                                                    Pace pace);
  ~DeviceSource() override;

  // Polled: takes all that came by that time. With a thread there is nothing to do.
  Status poll(SampleInbox& inbox, double scene_time_s) override;
  // Polled alone: takes what comes within wait_ms as if it came then.
  void receive_at(TimeNs at_ns, int wait_ms);
  // Any thread.
  DeviceHealth health() const;
  const std::string& name() const { return settings_.name; }
  // The signal of a microphone ("sound") or a strap ("ecg"); other devices have none (""). Any
  // thread.
  SignalQueue& signal() { return signal_; }
  std::string signal_kind() const;
  // Polled alone.
  const net::ClockMap& clock_map() const { return adapter_->clock_map(); }

 private:
  DeviceSource(const scene::DeviceSource& source, std::unique_ptr<Feed> feed,
               std::unique_ptr<DeviceAdapter> adapter, const Outlet& outlet)
      : settings_(source),
        feed_(std::move(feed)),
        adapter_(std::move(adapter)),
        senders_(adapter_->silence_ns()),
        outlet_(outlet) {
    adapter_->give_signal_to(&signal_);
  }
  void run();
  void take(net::Bytes bytes, bool cut, TimeNs arrived_ns);
  void tell(TimeNs now_ns);

  scene::DeviceSource settings_;
  SignalQueue signal_;
  std::unique_ptr<Feed> feed_;
  std::unique_ptr<DeviceAdapter> adapter_;
  net::SenderChoice senders_;  // by address
  std::uint64_t strangers_ = 0;
  Outlet outlet_;
  TimeNs rated_ns_ = 0;  // when the rate was measured
  std::uint64_t rated_ = 0;
  double rate_hz_ = 0.0;
  TimeNs heard_ns_ = 0;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;  // guards health_
  DeviceHealth health_;
  std::thread thread_;
};

}  // namespace neritic::testbed
