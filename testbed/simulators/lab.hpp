// A lab without people: simulators of the devices that a scene names, worn by a person who swims by
// himself, over real sockets of this machine and links with delay, jitter, loss and faults. As a
// source of a lock-step run it sends and receives in simulated time; beside a run by the host's
// clock (of this process or another) it only sends. The thread of the loop.
#pragma once

#include "engine/net/rough_link.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/simulators/simulated_device.hpp"

namespace neritic::testbed {

struct LabOptions {
  net::LinkFaults faults;                // of each link; seeds differ
  std::vector<std::string> names;        // of the scene's sources; empty: all
  std::optional<std::uint32_t> to_ipv4;  // instead of each source's own address
  // Signals in place of the person's; outlive the lab.
  const diver::LimbRecording* limbs = nullptr;
  const diver::ButtonRecording* buttons = nullptr;
  const diver::Recording* ecg = nullptr;
  const diver::Recording* sound = nullptr;
  double suit_hz = 240.0;
  bool gloves = true;
};

// A device's clock as it is, and the error of the adapter's estimate of it.
struct ClockError {
  std::string name;
  bool has_clock = false;
  double true_offset_s = 0.0, true_drift_ppm = 0.0;
  double now_ms = 0.0;    // of a time mapped now
  double worst_ms = 0.0;  // since kKnownAfter_s
};

class SimulatedLab final : public SampleSource {
 public:
  // The state that the person sees of the diver; called in poll().
  using Seen = std::function<const HumanPhysics&(std::size_t diver)>;
  // devices: in simulated time, opened polled, which outlive it; nullptr: by the host's clock.
  // kBadInput for a name that is none, or a source whose bytes come in no way that can be
  // simulated.
  static Result<std::unique_ptr<SimulatedLab>> create(const scene::Scene& scene,
                                                      const PhysicsWorld& world, Devices* devices,
                                                      Seen seen, const LabOptions& options);

  Status poll(SampleInbox& inbox, double scene_time_s) override;
  std::vector<ClockError> clock_errors() const;
  const PersonActs& acts(std::size_t diver) const { return wearers_[diver].person.acts(); }
  std::uint64_t sent() const;  // packets, those that the links lost included
  std::uint64_t lost() const;
  std::uint64_t not_taken() const { return not_taken_; }  // by the system: a stream that broke
  // One line a device: "suit (mxtp) to udp://127.0.0.1:9763", and what its way leaves out.
  std::vector<std::string> ways() const;

  // A clock is known well from then on: ClockMap looks back two minutes.
  static constexpr double kKnownAfter_s = 120.0;

 private:
  struct Wearer {
    std::size_t diver = 0;
    SimulatedPerson person;
  };
  struct Worn {
    std::string name, way;
    std::size_t wearer = 0;
    DeviceClock clock;
    std::unique_ptr<SimulatedDevice> device;
    net::RoughLink link;
    std::function<bool(net::Bytes)> to_wire;
    DeviceSource* receiver = nullptr;  // nullptr: by the host's clock
    double worst_ms = 0.0;
  };
  explicit SimulatedLab(Seen seen) : seen_(std::move(seen)) {}
  Status add(const scene::DeviceSource& source, const PhysicsWorld& world, Devices* devices,
             const LabOptions& options);
  void deliver(Worn& worn, TimeNs now_ns);
  double clock_error_ms(const Worn& worn, TimeNs now_ns) const;

  Seen seen_;
  std::vector<Wearer> wearers_;
  std::vector<Worn> worn_;
  bool simulated_time_ = false;
  std::optional<double> last_s_;
  TimeNs now_ns_ = 0;
  std::uint64_t not_taken_ = 0;
};

}  // namespace neritic::testbed
