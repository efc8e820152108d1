#include "testbed/devices/gaze_adapter.hpp"

namespace neritic::testbed {

void GazeAdapter::receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
  datagram(bytes, cut, [&] {
    const auto packet = net::decode_gaze(bytes);
    if (!packet.ok()) {
      ++counts_.malformed;
      return;
    }
    using Verdict = net::CounterTrack::Verdict;
    const Verdict verdict = sequence_.take(packet->sequence, arrived_ns, counts_);
    if (verdict != Verdict::kNew && verdict != Verdict::kRestarted) return;
    if (verdict == Verdict::kRestarted) {
      clock_.restart();
      gaze_ = diver::GazeMonitor(diver::headset_gaze(diver::GazeMethod::kVelocity));
    }
    const auto sent_ns = static_cast<TimeNs>((packet->time_us & (~std::uint64_t{0} >> 12)) * 1000);
    clock_.add(sent_ns, arrived_ns);
    diver::GazeEvents events;  // the state counts them
    gaze_.push({1e-9 * static_cast<double>(sent_ns), Vec3(packet->direction), packet->valid},
               events);
    out.send(Gaze{gaze_.state()}, clock_.to_host(sent_ns), arrived_ns);
  });
}

}  // namespace neritic::testbed
