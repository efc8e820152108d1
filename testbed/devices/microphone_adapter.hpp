// A microphone at the regulator as a diver's breath: sound packets (RTP) are put in order, short
// gaps are filled with the sound before them, and each ten seconds are analysed (breath_monitor).
// Sound that comes at another rate than the source's is not analysed, nor is other than 16 bits in
// one channel. The thread of the device, which does the analysis too: sound waits in the kernel
// meanwhile.
#pragma once

#include <map>

#include "diver/breath_monitor.hpp"
#include "engine/net/rtp.hpp"
#include "engine/net/sender_choice.hpp"
#include "testbed/devices/adapter.hpp"
#include "testbed/devices/sound_rate.hpp"

namespace neritic::testbed {

class MicrophoneAdapter final : public DeviceAdapter {
 public:
  // Precondition: diver::check_sound_rate(rate_hz).
  explicit MicrophoneAdapter(double rate_hz, const diver::BreathSettings& settings = {});
  TimeNs wakes_at_ns() const override;
  void tick(TimeNs now_ns, Outlet& out) override;
  // A block is ten seconds long.
  TimeNs max_age_ns() const override { return 15'000'000'000; }

  std::string trouble() const override;
  void give_signal_to(SignalQueue* sound) override { sound_ = sound; }

  // How long packets wait for a missing one, and how many at most.
  static constexpr TimeNs kWait_ns = 100'000'000;
  static constexpr std::size_t kMostWaiting = 16;
  // A longer gap is not filled: the analysis begins anew after it.
  static constexpr double kMostFilled_s = 0.2;

 private:
  struct Waiting {
    net::RtpPacket packet;
    TimeNs arrived_ns = 0;
  };
  void receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) override;
  bool of_this_kind(const Result<net::RtpPacket>& packet);
  void begin_anew(std::uint64_t number);
  void give(bool all, TimeNs now_ns, Outlet& out);
  void fill(std::uint64_t packets, std::size_t samples);
  void hear(const net::RtpPacket& packet, bool follows, TimeNs arrived_ns, Outlet& out);
  TimeNs wire_ns(std::int64_t timestamp) const;

  double rate_hz_;
  std::size_t block_samples_;
  diver::BreathAnalyser analyser_;
  net::SenderChoice senders_;  // by RTP's SSRC
  SoundRate rate_;
  std::uint64_t others_ = 0;  // whole packets in a row whose payload type is not used
  std::string other_;         // why not the newest of them
  net::CounterTrack sequence_{16};
  std::map<std::uint64_t, Waiting> waiting_;  // by the number without wraps
  std::uint64_t next_ = 0;                    // number of the packet that comes next
  std::uint16_t newest_wire_ = 0;             // the newest number as it came
  bool any_ = false;
  std::int64_t timestamp_ = 0;  // of the newest packet, without wraps
  bool timed_ = false;
  std::vector<float> block_, last_;
  SignalQueue* sound_ = nullptr;
};

}  // namespace neritic::testbed
