// A stream of Lab Streaming Layer, by its library. Samples become the packets of the device that
// they come from, stamped by the sender's clock; LSL's own exchanges tell how far that clock is
// off.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "engine/core/refusal.hpp"
#include "engine/net/gaze_wire.hpp"
#include "engine/net/heart_strap.hpp"
#include "engine/net/jacket_wire.hpp"
#include "engine/net/rtp.hpp"
#include "testbed/devices/adapter.hpp"
#include "testbed/devices/feed.hpp"
#include "testbed/devices/shared_library.hpp"

namespace neritic::testbed {
namespace {

// Answers of streams beyond this network segment take half a second and more (resolver.h).
constexpr double kLook_s = 1.0;
constexpr TimeNs kLookEvery_ns = 2 * kSecond_ns;
constexpr int kLostStream = -2;  // the library's error
// The rate of a Polar strap; samples of other rates would give other intervals between beats.
constexpr double kEcgRate_hz = 130.0, kMostOff = 0.01;
constexpr double kResolve_s = 3.0, kOpen_s = 3.0, kExchange_s = 0.2;
// The first estimate takes eight exchanges of 64 ms each (liblsl's tuning.TimeProbeCount and
// TimeProbeInterval), longer than kExchange_s: asked again soon, since samples wait meanwhile.
constexpr TimeNs kAskEvery_ns = 5 * kSecond_ns, kAskAgain_ns = kSecond_ns;
constexpr std::size_t kMostPulled = 4096;
constexpr std::size_t kEcgChunk = 73;

// For LSL's C interface (lsl_c.h), version 1.13 and later.
struct Lsl {
  int (*resolve)(void** infos, std::uint32_t most, const char* property, const char* value,
                 int minimum, double timeout_s) = nullptr;
  void* (*create_inlet)(void* info, int buffer_s, int chunk, int recover) = nullptr;
  void (*open_stream)(void* inlet, double timeout_s, int* error) = nullptr;
  unsigned long (*pull)(void* inlet, float* data, double* stamps, unsigned long data_size,
                        unsigned long stamps_size, double timeout_s, int* error) = nullptr;
  double (*correction)(void* inlet, double* remote_s, double* uncertainty_s, double timeout_s,
                       int* error) = nullptr;
  double (*clock)() = nullptr;
  int (*channels)(void* info) = nullptr;
  double (*rate)(void* info) = nullptr;
  void (*destroy_inlet)(void* inlet) = nullptr;
  void (*destroy_info)(void* info) = nullptr;
};

TimeNs ns_of(double seconds) {
  return std::llround(1e9 * std::clamp(seconds, -1e9, 1e9));
}

class LslFeed final : public Feed {
 public:
  static Result<std::unique_ptr<Feed>> open(const scene::DeviceSource& source) {
    NERITIC_TRY(SharedLibrary library, SharedLibrary::load("liblsl.so liblsl.so.2 liblsl64.so",
                                                           "Lab Streaming Layer's liblsl"));
    auto feed = std::unique_ptr<LslFeed>(new LslFeed(std::move(library), source));
    NERITIC_TRY_STATUS(feed->find_functions());
    NERITIC_TRY_STATUS(feed->find_stream(kResolve_s));
    return std::unique_ptr<Feed>(std::move(feed));
  }
  ~LslFeed() override { close(); }

  void receive(const net::Received& received, int wait_ms) override {
    if (!inlet_ && !find_again(wait_ms)) return;
    // The library waits until all of a buffer is there: first for one sample, then for none.
    int error = 0;
    unsigned long values =
        lsl_.pull(inlet_, data_.data(), stamps_.data(), channels_, 1, 1e-3 * wait_ms, &error);
    if (error == 0 && values == channels_)
      values += lsl_.pull(inlet_, data_.data() + channels_, stamps_.data() + 1,
                          data_.size() - channels_, stamps_.size() - 1, 0.0, &error);
    trouble_ = error == 0             ? ""
               : error == kLostStream ? "its stream is lost and looked for"
                                      : fmt::format("LSL's error {}", error);
    if (error == kLostStream) close();
    const std::size_t samples = values / channels_;
    if (samples == 0) return;
    if (source_.device == "jacket")
      for (std::size_t i = 0; i < samples; ++i) give_buttons(i, received);
    else if (source_.device == "gaze")
      for (std::size_t i = 0; i < samples; ++i) give_gaze(i, received);
    else if (source_.device == "strap")
      give_ecg(samples, received);
    else
      give_sound(samples, received);
  }
  std::string trouble() const override { return trouble_; }

  // The offset that LSL found by its exchanges (the best of eight), with its own uncertainty.
  void exchange_times(DeviceAdapter& adapter) override {
    if (!inlet_ || now_ns() < ask_ns_) return;
    int error = 0;
    double remote_s = 0.0, uncertainty_s = 0.0;
    const double correction_s =
        lsl_.correction(inlet_, &remote_s, &uncertainty_s, kExchange_s, &error);
    ask_ns_ = now_ns() + (error == 0 ? kAskEvery_ns : kAskAgain_ns);
    if (error != 0) return;
    const TimeNs host_ns = now_ns();
    const TimeNs device_ns = ns_of(lsl_.clock() - correction_s);
    const TimeNs half_ns = std::max<TimeNs>(ns_of(uncertainty_s), 0);
    adapter.exchange(host_ns - half_ns, device_ns, device_ns, host_ns + half_ns);
  }

 private:
  LslFeed(SharedLibrary library, const scene::DeviceSource& source)
      : library_(std::move(library)), source_(source) {}

  Status find_functions() {
    library_.find("lsl_resolve_byprop", lsl_.resolve);
    library_.find("lsl_create_inlet", lsl_.create_inlet);
    library_.find("lsl_open_stream", lsl_.open_stream);
    library_.find("lsl_pull_chunk_f", lsl_.pull);
    library_.find("lsl_time_correction_ex", lsl_.correction);
    library_.find("lsl_local_clock", lsl_.clock);
    library_.find("lsl_get_channel_count", lsl_.channels);
    library_.find("lsl_get_nominal_srate", lsl_.rate);
    library_.find("lsl_destroy_inlet", lsl_.destroy_inlet);
    library_.find("lsl_destroy_streaminfo", lsl_.destroy_info);
    return library_.complete();
  }

  void close() {
    if (inlet_) lsl_.destroy_inlet(inlet_);
    if (info_) lsl_.destroy_info(info_);
    inlet_ = info_ = nullptr;
  }

  // For a stream that was lost for good: its sender may come back as another one of that name.
  bool find_again(int wait_ms) {
    if (now_ns() - looked_ns_ >= kLookEvery_ns && find_stream(kLook_s).ok()) {
      trouble_.clear();
      return true;
    }
    if (now_ns() - looked_ns_ >= kLookEvery_ns) {
      looked_ns_ = now_ns();
      close();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    return false;
  }

  Status find_stream(double within_s) {
    if (lsl_.resolve(&info_, 1, "name", source_.port.c_str(), 1, within_s) < 1) {
      info_ = nullptr;
      return failure(ErrorCode::kIo, "LSL: no stream {} within {:g} s", source_.port, within_s);
    }
    const std::size_t wanted = source_.device == "jacket" || source_.device == "gaze" ? 3 : 1;
    const int channels = lsl_.channels(info_);
    if (channels != static_cast<int>(wanted))
      return refusal(fmt::format("LSL: {}", source_.port), fmt::format("{} channels", channels),
                     fmt::format("{} of a {}", wanted, source_.device));
    NERITIC_TRY_STATUS(check_rate(lsl_.rate(info_)));
    channels_ = wanted;
    data_.resize(kMostPulled * channels_);
    stamps_.resize(kMostPulled);
    inlet_ = lsl_.create_inlet(info_, 360, 0, 1);
    int error = 0;
    if (inlet_) lsl_.open_stream(inlet_, kOpen_s, &error);
    if (!inlet_ || error != 0)
      return failure(ErrorCode::kIo, "LSL: the stream {} does not open", source_.port);
    return {};
  }

  // 0: it says none.
  Status check_rate(double rate_hz) const {
    const double wanted_hz = source_.device == "strap"        ? kEcgRate_hz
                             : source_.device == "microphone" ? source_.rate_hz
                                                              : rate_hz;
    if (rate_hz == 0.0 || std::abs(rate_hz - wanted_hz) <= kMostOff * wanted_hz) return {};
    return refusal(fmt::format("LSL: {}", source_.port),
                   fmt::format("{:g} samples a second", rate_hz), fmt::format("{:g}", wanted_hz));
  }

  void give_buttons(std::size_t i, const net::Received& received) {
    const TimeNs at_ns = ns_of(stamps_[i]);
    net::JacketPacket packet;
    for (std::size_t k = 0; k < 3; ++k) {
      if (was_[k] && last_ns_ > 0) pressed_ns_[k] += std::max<TimeNs>(at_ns - last_ns_, 0);
      const bool now = data_[3 * i + k] > 0.5F;
      presses_ += now && !was_[k];
      packet.pressed[k] = was_[k] = now;
    }
    last_ns_ = at_ns;
    packet.counters = net::UbcdCounters{.sequence = sequence_++,
                                        .time_us = static_cast<std::uint64_t>(at_ns / 1000),
                                        .presses = presses_};
    for (std::size_t k = 0; k < 3; ++k)
      packet.counters->pressed_ms[k] = static_cast<std::uint16_t>(pressed_ns_[k] / kMillisecond_ns);
    received(net::encode_jacket(packet), false);
  }

  // A direction that is not finite, or none, is that of eyes that were not seen.
  void give_gaze(std::size_t i, const net::Received& received) {
    const Vec3f direction(data_[3 * i], data_[3 * i + 1], data_[3 * i + 2]);
    const float length = glm::length(direction);
    const bool valid = std::isfinite(length) && length > 0.0F;
    received(net::encode_gaze({.valid = valid,
                               .sequence = sequence_++,
                               .time_us = static_cast<std::uint64_t>(
                                   std::max<TimeNs>(ns_of(stamps_[i]), 0) / 1000),
                               .direction = valid ? direction / length : Vec3f(0.0F)}),
             false);
  }

  void give_ecg(std::size_t samples, const net::Received& received) {
    for (std::size_t i = 0; i < samples; ++i) {
      ecg_.samples_uv.push_back(static_cast<std::int32_t>(
          std::isfinite(data_[i]) ? std::clamp(data_[i], -8e6F, 8e6F) : 0.0F));
      if (ecg_.samples_uv.size() < kEcgChunk) continue;
      ecg_.time_ns = static_cast<std::uint64_t>(std::max<TimeNs>(ns_of(stamps_[i]), 0));
      received(net::encode_ecg(ecg_), false);
      ecg_.samples_uv.clear();
    }
  }

  void give_sound(std::size_t samples, const net::Received& received) {
    constexpr std::size_t kSoundChunk = 512;
    for (std::size_t from = 0; from < samples; from += kSoundChunk) {
      const std::size_t count = std::min(kSoundChunk, samples - from);
      net::RtpPacket packet{.sequence = sequence_++};
      packet.timestamp = static_cast<std::uint32_t>(std::llround(stamps_[from] * source_.rate_hz));
      packet.samples.assign(data_.begin() + static_cast<std::ptrdiff_t>(from),
                            data_.begin() + static_cast<std::ptrdiff_t>(from + count));
      received(net::encode_rtp(packet), false);
    }
  }

  SharedLibrary library_;
  Lsl lsl_;
  scene::DeviceSource source_;
  void *info_ = nullptr, *inlet_ = nullptr;
  std::size_t channels_ = 1;
  std::vector<float> data_;
  std::vector<double> stamps_;
  TimeNs ask_ns_ = 0, last_ns_ = 0, looked_ns_ = 0;
  std::array<bool, 3> was_{};
  std::array<TimeNs, 3> pressed_ns_{};
  std::uint8_t presses_ = 0;
  std::uint16_t sequence_ = 0;
  net::EcgFrame ecg_;
  std::string trouble_;
};

}  // namespace

Result<std::unique_ptr<Feed>> open_lsl(const scene::DeviceSource& source) {
  return LslFeed::open(source);
}

}  // namespace neritic::testbed
