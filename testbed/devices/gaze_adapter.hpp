// An eye tracker's directions (UGZD) as a diver's gaze, with its fixations and saccades by I-VT.
// The thread of the device.
#pragma once

#include "diver/gaze_events.hpp"
#include "engine/net/gaze_wire.hpp"
#include "testbed/devices/adapter.hpp"

namespace neritic::testbed {

class GazeAdapter final : public DeviceAdapter {
 public:
  std::string trouble() const override { return sequence_.trouble(); }

 private:
  void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) override;

  net::CounterTrack sequence_{16};
  diver::GazeMonitor gaze_{diver::headset_gaze(diver::GazeMethod::kVelocity)};
};

}  // namespace neritic::testbed
