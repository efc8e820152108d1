// A microphone at this machine's sound card, by ALSA's library, which PipeWire and PulseAudio serve
// too. Its samples become sound packets of 20 ms, stamped by the card's own clock. A card that is
// pulled out is looked for again.
#include <algorithm>
#include <cerrno>
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
constexpr TimeNs kCardTryEvery_ns = 1'000'000'000;

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

constexpr std::uint32_t kRestartGap =
    2000;  // packets: well beyond net::CounterTrack's kMostMissing

class AlsaFeed final : public Feed {
 public:
  static Result<std::unique_ptr<Feed>> open(const scene::DeviceSource& source) {
    NERITIC_TRY(SharedLibrary library, SharedLibrary::load("libasound.so.2", "libasound2"));
    auto feed = std::unique_ptr<AlsaFeed>(new AlsaFeed(std::move(library), source));
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
    if (const int e = feed->open_card(); e < 0)
      return failure(ErrorCode::kIo, "sound card {}: {}", source.port, alsa.words(e));
    return std::unique_ptr<Feed>(std::move(feed));
  }
  ~AlsaFeed() override { close_card(); }

  void receive(const net::Received& received, int wait_ms) override {
    if (!pcm_) look_again();
    const long got =
        pcm_ ? alsa_.read(pcm_, buffer_.data() + filled_, buffer_.size() - filled_) : 0;
    if (got < 0 && got != -EAGAIN) {
      // The queue ran over, the card was suspended, or it was pulled out.
      if (alsa_.recover(pcm_, static_cast<int>(got), 1) >= 0) {
        (void)alsa_.start(pcm_);
        ++overruns_;
      } else {
        trouble_ = fmt::format("the card: {}", alsa_.words(static_cast<int>(got)));
        away_ns_ = now_ns();
        close_card();
      }
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
  AlsaFeed(SharedLibrary library, const scene::DeviceSource& source)
      : library_(std::move(library)),
        name_(source.port),
        rate_hz_(static_cast<unsigned>(std::lround(source.rate_hz))),
        buffer_(static_cast<std::size_t>(std::lround(kSoundPacket_s * source.rate_hz))) {}

  // ALSA's error, or 0.
  int open_card() {
    int error = alsa_.open(&pcm_, name_.c_str(), kCapture, kNonblock);
    if (error < 0) {
      pcm_ = nullptr;
      return error;
    }
    error = alsa_.set_params(pcm_, kS16Le, kInterleaved, 1, rate_hz_, 1, kLatency_us);
    if (error >= 0) error = alsa_.start(pcm_);
    if (error < 0) close_card();
    return error;
  }
  void close_card() {
    if (pcm_) alsa_.close(pcm_);
    pcm_ = nullptr;
    next_try_ns_ = now_ns() + kCardTryEvery_ns;
  }
  // Up to kMostMissing packets (20 s) that nobody heard count as lost, more as a restart; their
  // time goes by.
  void look_again() {
    if (now_ns() < next_try_ns_) return;
    next_try_ns_ = now_ns() + kCardTryEvery_ns;
    if (open_card() < 0) return;
    const double away_s = 1e-9 * static_cast<double>(now_ns() - away_ns_);
    const auto missed = static_cast<std::uint32_t>(std::llround(away_s / kSoundPacket_s));
    // Numbers have 16 bits: a longer absence must not look like a short one.
    packet_.sequence = static_cast<std::uint16_t>(packet_.sequence + std::min(missed, kRestartGap));
    packet_.timestamp += missed * static_cast<std::uint32_t>(buffer_.size());
    filled_ = 0;
    trouble_.clear();
  }

  SharedLibrary library_;
  Alsa alsa_;
  std::string name_;
  unsigned rate_hz_;
  void* pcm_ = nullptr;
  TimeNs next_try_ns_ = 0, away_ns_ = 0;
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
