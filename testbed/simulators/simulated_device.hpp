// Simulators of a lab's devices: each turns what a person does into the bytes that the real device
// sends, stamped by a clock of its own. Same acts, same seed, same bytes. One thread.
#pragma once

#include <functional>
#include <memory>

#include "diver/physio_recording.hpp"
#include "engine/core/clock.hpp"
#include "engine/scene/source_settings.hpp"
#include "testbed/simulators/person.hpp"

namespace neritic::testbed {

// A device's clock: set at another time than the host's, and fast by a little.
struct DeviceClock {
  TimeNs offset_ns = 0;
  double drift_ppm = 0.0;
  TimeNs at(TimeNs host_ns) const {
    return host_ns + offset_ns +
           static_cast<TimeNs>(1e-6 * drift_ppm * static_cast<double>(host_ns));
  }
  // To a part of 1e-9 of the time between.
  TimeNs host(TimeNs device_ns, TimeNs near_host_ns) const {
    const TimeNs past_ns = at(near_host_ns) - device_ns;
    return near_host_ns -
           static_cast<TimeNs>(static_cast<double>(past_ns) / (1.0 + 1e-6 * drift_ppm));
  }
};

class SimulatedDevice {
 public:
  // at_ns: when they leave, on the host's clock.
  using Send = std::function<void(std::vector<std::byte> bytes, TimeNs at_ns)>;
  virtual ~SimulatedDevice() = default;
  // All that it sends until now; called at least every 20 ms.
  virtual void run(const PersonActs& acts, TimeNs now_ns, const Send& send) = 0;
  // The time that a packet which leaves now would say; none: the protocol has no time.
  virtual std::optional<TimeNs> wire_ns(TimeNs now_ns) const = 0;
};

struct SimulatedDeviceOptions {
  DeviceClock clock;
  double rate_hz = 0.0;  // suit: frames a second; microphone: samples; 0: as usual
  bool gloves = true;    // of a suit
  std::uint64_t seed = 1;
  // The signal itself, in place of the person's: an ECG in uV, or sound. Outlives the device.
  const diver::Recording* recording = nullptr;
};
// By the kinds of scene::kDeviceKinds: "mxtp", "strap", "jacket", "microphone", "gaze".
std::unique_ptr<SimulatedDevice> simulated_device(std::string_view kind,
                                                  const SimulatedDeviceOptions& options);

}  // namespace neritic::testbed
