// The way of one device's samples into a running scene: numbers them by stream, and keeps their
// capture times in order and not after their arrival, since a clock that is still being learnt
// moves. The thread of the device.
#pragma once

#include <array>

#include "testbed/samples/inbox.hpp"

namespace neritic::testbed {

class Outlet {
 public:
  // Borrows inbox and table. diver: the number of the diver who wears the device.
  Outlet(SampleInbox& inbox, SourceId source, const StreamTable& streams, std::uint32_t diver)
      : inbox_(inbox), source_(source), streams_(streams), diver_(diver) {}

  void send(const Payload& payload, TimeNs captured_ns, TimeNs arrived_ns);
  std::uint64_t sent() const { return sent_; }
  std::uint64_t accepted() const { return accepted_; }

 private:
  SampleInbox& inbox_;
  SourceId source_;
  const StreamTable& streams_;
  std::uint32_t diver_;
  std::uint64_t sent_ = 0, accepted_ = 0;
  std::array<std::uint64_t, kPayloadKinds> sequences_{};
  std::array<TimeNs, kPayloadKinds> captured_ns_{};
};

}  // namespace neritic::testbed
