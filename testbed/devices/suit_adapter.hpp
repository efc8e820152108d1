// A motion suit with gloves (Xsens MVN's MXTP, type 02) as a diver's body and hands. The other
// types that MVN can send beside it are decoded and counted as unused.
// The thread of the device.
#pragma once

#include "testbed/devices/adapter.hpp"
#include "testbed/devices/suit_posture.hpp"

namespace neritic::testbed {

class SuitAdapter final : public DeviceAdapter {
 public:
  // stream: the bytes come over TCP, in pieces of any length.
  SuitAdapter(std::uint8_t character, bool stream) : frames_(character), stream_(stream) {}

  std::string trouble() const override;

 private:
  void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) override;
  void take_datagram(net::Bytes bytes, TimeNs arrived_ns, Outlet& out);

  net::SuitFrames frames_;
  bool stream_;
  int type_ = 2;                 // of the newest datagram
  std::uint64_t others_ = 0;     // datagrams in a row of types that are not used
  std::vector<std::byte> left_;  // of the stream: less than a datagram
};

}  // namespace neritic::testbed
