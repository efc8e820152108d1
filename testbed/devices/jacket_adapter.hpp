// The buttons of a buoyancy jacket. UBCD packets say how long each button was pressed in all: the
// next packet makes up for presses whose packets were lost, so that loss changes no amount of gas.
// A counter that rises by more than the time that went by is malformed.
// If several jackets send (UBCD's byte 5), the first is used until it is silent for a second.
// The other two forms say only which buttons are pressed now. The thread of the device.
#pragma once

#include "engine/net/jacket_wire.hpp"
#include "engine/net/sender_choice.hpp"
#include "testbed/devices/adapter.hpp"

namespace neritic::testbed {

class JacketAdapter final : public DeviceAdapter {
 public:
  TimeNs wakes_at_ns() const override;
  void tick(TimeNs now_ns, Outlet& out) override;
  std::string trouble() const override;

  // After a silence of this length no lost press is made up for: a press that the diver may no
  // longer want must not fill a jacket. The group's own hold time lets the buttons go. No button is
  // owed more than this at once.
  static constexpr TimeNs kSilence_ns = 500'000'000;
  // A smaller debt of a button is the wait for the next packet.
  static constexpr TimeNs kLeastOwed_ns = 15'000'000;

 private:
  void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) override;
  struct Heard {
    net::UbcdCounters counters;
    TimeNs at_ns = 0;
  };
  void take_counters(const net::JacketPacket& packet, TimeNs arrived_ns, Outlet& out);
  bool plausible(const net::UbcdCounters& now, TimeNs arrived_ns, const Heard& before) const;
  void go_on(TimeNs now_ns);

  struct Button {
    TimeNs said_ns = 0, given_ns = 0;  // pressed so far by the jacket, and in the scene
    TimeNs until_ns = 0;               // owed presses end then
  };
  net::SenderChoice jackets_;  // by UBCD's byte 5
  net::CounterTrack sequence_{16};
  std::array<Button, 3> buttons_;
  std::uint64_t given_ = 0;  // bits that are pressed in the scene
  TimeNs went_on_ns_ = 0;
  std::optional<Heard> heard_;  // the last packet that counted
  std::optional<Heard> leapt_;  // one after it whose counters cannot be
};

}  // namespace neritic::testbed
