// A recording of a microphone (.wav) as if it were one: sound packets at its own pace, from the
// start again after its end.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "diver/physio_wav.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/net/rtp.hpp"
#include "testbed/devices/feed.hpp"

namespace neritic::testbed {
namespace {

constexpr double kPacket_s = 0.02;
constexpr int kMostAtOnce = 4096;  // in simulated time, whose steps may be long

class WavFeed final : public Feed {
 public:
  explicit WavFeed(diver::Recording sound) : sound_(std::move(sound)) {}
  void at_simulated(TimeNs at_ns) override { simulated_ns_ = at_ns; }
  void receive(const net::Received& received, int wait_ms) override {
    if (!begun_ns_) begun_ns_ = time_ns();
    const auto samples = static_cast<std::size_t>(std::lround(kPacket_s * sound_.rate_hz));
    for (int i = 0; i < (simulated_ns_ ? kMostAtOnce : 2); ++i) {
      const TimeNs due_ns =
          *begun_ns_ +
          static_cast<TimeNs>(1e9 * static_cast<double>(packet_.timestamp_so_far) / sound_.rate_hz);
      const TimeNs left_ns = due_ns - time_ns();
      if (left_ns > 0 && simulated_ns_) return;
      if (left_ns > 0) {
        std::this_thread::sleep_for(
            std::chrono::nanoseconds(std::min(left_ns, static_cast<TimeNs>(wait_ms) * 1'000'000)));
        return;
      }
      net::RtpPacket& packet = packet_.packet;
      packet.timestamp = static_cast<std::uint32_t>(packet_.timestamp_so_far);
      packet.samples.clear();
      for (std::size_t k = 0; k < samples; ++k, ++at_)
        packet.samples.push_back(static_cast<float>(sound_.samples[at_ % sound_.samples.size()]));
      received(net::encode_rtp(packet), false);
      ++packet.sequence;
      packet_.timestamp_so_far += samples;
    }
  }

 private:
  struct Next {
    net::RtpPacket packet;
    std::uint64_t timestamp_so_far = 0;
  };
  TimeNs time_ns() const { return simulated_ns_.value_or(now_ns()); }
  diver::Recording sound_;
  std::optional<TimeNs> begun_ns_, simulated_ns_;
  std::size_t at_ = 0;
  Next packet_;
};

}  // namespace

Result<std::unique_ptr<Feed>> open_wav(const scene::DeviceSource& source) {
  NERITIC_TRY(const auto bytes, read_file(source.port));
  NERITIC_TRY(diver::Recording sound, diver::parse_wav(bytes, source.port, 0));
  if (sound.samples.empty()) return refusal(source.port, "a file without sound", "one with");
  if (std::abs(sound.rate_hz - source.rate_hz) > 0.5)
    return refusal(source.port, fmt::format("{:g} samples a second", sound.rate_hz),
                   fmt::format("{:g}, the source's rate_hz", source.rate_hz));
  return std::unique_ptr<Feed>(std::make_unique<WavFeed>(std::move(sound)));
}

}  // namespace neritic::testbed
