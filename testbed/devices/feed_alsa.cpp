// A microphone at this machine's sound card, by ALSA's library, which PipeWire and PulseAudio serve
// too. Its samples become sound packets of 20 ms, stamped by the card's own clock.
#include <chrono>
#include <cmath>
#include <thread>

#include "engine/net/rtp.hpp"
#include "testbed/devices/feed.hpp"
#include "testbed/devices/shared_library.hpp"

namespace neritic::testbed {
namespace {

// For ALSA's interface (alsa/pcm.h), which has not changed since 2000.
constexpr int kCapture = 1, kNonblock = 1, kS16Le = 2, kInterleaved = 3;
constexpr unsigned kLatency_us = 100'000;
constexpr double kSoundPacket_s = 0.02;

struct Alsa {
  int (*open)(void** pcm, const char* name, int stream, int mode) = nullptr;
  int (*set_params)(void* pcm, int format, int access, unsigned channels, unsigned rate,
                    int resample, unsigned latency_us) = nullptr;
  long (*read)(void* pcm, void* buffer, unsigned long frames) = nullptr;
  int (*recover)(void* pcm, int error, int silent) = nullptr;
  int (*start)(void* pcm) = nullptr;
  int (*close)(void* pcm) = nullptr;
  const char* (*words)(int error) = nullptr;
};

class AlsaFeed final : public Feed {
 public:
  static Result<std::unique_ptr<Feed>> open(const scene::DeviceSource& source) {
    NERITIC_TRY(SharedLibrary library, SharedLibrary::load("libasound.so.2", "libasound2"));
    auto feed = std::unique_ptr<AlsaFeed>(new AlsaFeed(std::move(library), source.rate_hz));
    Alsa& alsa = feed->alsa_;
    SharedLibrary& from = feed->library_;
    from.find("snd_pcm_open", alsa.open);
    from.find("snd_pcm_set_params", alsa.set_params);
    from.find("snd_pcm_readi", alsa.read);
    from.find("snd_pcm_recover", alsa.recover);
    from.find("snd_pcm_start", alsa.start);
    from.find("snd_pcm_close", alsa.close);
    from.find("snd_strerror", alsa.words);
    NERITIC_TRY_STATUS(from.complete());
    const auto failed = [&](int error) {
      return failure(ErrorCode::kIo, "sound card {}: {}", source.port, alsa.words(error));
    };
    if (const int e = alsa.open(&feed->pcm_, source.port.c_str(), kCapture, kNonblock); e < 0)
      return failed(e);
    if (const int e =
            alsa.set_params(feed->pcm_, kS16Le, kInterleaved, 1,
                            static_cast<unsigned>(std::lround(source.rate_hz)), 1, kLatency_us);
        e < 0)
      return failed(e);
    if (const int e = alsa.start(feed->pcm_); e < 0) return failed(e);
    return std::unique_ptr<Feed>(std::move(feed));
  }
  ~AlsaFeed() override {
    if (pcm_) alsa_.close(pcm_);
  }

  void receive(const net::Received& received, int wait_ms) override {
    const long got = alsa_.read(pcm_, buffer_.data() + filled_, buffer_.size() - filled_);
    if (got < 0 && got != -EAGAIN) {
      // The queue ran over, or the card was suspended.
      trouble_ = alsa_.recover(pcm_, static_cast<int>(got), 1) < 0
                     ? alsa_.words(static_cast<int>(got))
                     : "";
      if (trouble_.empty()) (void)alsa_.start(pcm_);
      ++overruns_;
    }
    if (got > 0) filled_ += static_cast<std::size_t>(got);
    if (filled_ < buffer_.size()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(std::min(wait_ms, 5)));
      return;
    }
    packet_.samples.clear();
    for (const std::int16_t sample : buffer_)
      packet_.samples.push_back(static_cast<float>(sample) / 32768.0F);
    received(net::encode_rtp(packet_), false);
    ++packet_.sequence;
    packet_.timestamp += static_cast<std::uint32_t>(buffer_.size());
    filled_ = 0;
  }
  std::uint64_t overflowed() const override { return overruns_; }
  std::string trouble() const override { return trouble_; }

 private:
  AlsaFeed(SharedLibrary library, double rate_hz)
      : library_(std::move(library)),
        buffer_(static_cast<std::size_t>(std::lround(kSoundPacket_s * rate_hz))) {}

  SharedLibrary library_;
  Alsa alsa_;
  void* pcm_ = nullptr;
  std::vector<std::int16_t> buffer_;
  std::size_t filled_ = 0;
  net::RtpPacket packet_;
  std::uint64_t overruns_ = 0;
  std::string trouble_;
};

}  // namespace

Result<std::unique_ptr<Feed>> open_alsa(const scene::DeviceSource& source) {
  return AlsaFeed::open(source);
}

}  // namespace neritic::testbed
