#include "testbed/simulators/simulated_device.hpp"

#include <algorithm>
#include <cmath>

#include "diver/jacket.hpp"
#include "engine/core/random.hpp"
#include "engine/net/gaze_wire.hpp"
#include "engine/net/heart_strap.hpp"
#include "engine/net/jacket_wire.hpp"
#include "engine/net/rtp.hpp"
#include "testbed/devices/suit_posture.hpp"
#include "testbed/simulators/breath_sound.hpp"

namespace neritic::testbed {
namespace {

constexpr TimeNs kMs = 1'000'000, kS = 1'000'000'000;

// Tells which of a clock's ticks lie in the time since the last call. Ticks are by the device's
// clock.
class Ticks {
 public:
  explicit Ticks(double rate_hz) : rate_hz_(rate_hz) {}
  // Calls each(device_ns) for every tick up to device_ns; the first call only begins.
  template <class Each>
  void until(TimeNs device_ns, Each each) {
    if (begun_ns_ == 0) begun_ns_ = device_ns;
    for (TimeNs due = at(next_); due <= device_ns; due = at(++next_)) each(due);
  }

 private:
  TimeNs at(std::uint64_t tick) const {
    return begun_ns_ + static_cast<TimeNs>(1e9 / rate_hz_ * static_cast<double>(tick));
  }
  double rate_hz_;
  TimeNs begun_ns_ = 0;
  std::uint64_t next_ = 0;
};

// MVN with MANUS gloves: the body in one datagram, the fingers in a second.
class SimulatedSuit final : public SimulatedDevice {
 public:
  explicit SimulatedSuit(const SimulatedDeviceOptions& options)
      : options_(options), ticks_(options.rate_hz > 0.0 ? options.rate_hz : 240.0) {}
  void run(const PersonActs& acts, TimeNs now_ns, const Send& send) override {
    ticks_.until(options_.clock.at(now_ns), [&](TimeNs device_ns) {
      frame(acts, device_ns, options_.clock.host(device_ns, now_ns), send);
    });
  }
  std::optional<TimeNs> wire_ns(TimeNs now_ns) const override { return options_.clock.at(now_ns); }

 private:
  void frame(const PersonActs& acts, TimeNs device_ns, TimeNs at_ns, const Send& send) {
    // A person who stands and faces x: the lab's floor knows nothing of the dive.
    static const Quat standing = glm::quat_cast(Mat3(Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(1, 0, 0)));
    const net::SuitFrame frame = suit_frame(acts.joints, acts.flexion_rad, standing);
    net::MxtpHeader header{.sample = sample_++,
                           .last = !options_.gloves,
                           .time_ms = static_cast<std::uint32_t>(device_ns / kMs),
                           .body_segments = net::kMxtpBodySegments};
    if (options_.gloves) header.finger_segments = 2 * net::kMxtpHandSegments;
    send(net::encode_mxtp(header, frame.body), at_ns);
    if (!options_.gloves) return;
    std::vector<net::MxtpPose> fingers;
    for (const auto& hand : frame.hands) fingers.insert(fingers.end(), hand.begin(), hand.end());
    header.datagram = 1;
    header.last = true;
    send(net::encode_mxtp(header, fingers), at_ns);
  }
  SimulatedDeviceOptions options_;
  Ticks ticks_;
  std::uint32_t sample_ = 0;
};

// A Polar H10: ECG frames of 73 samples, and a rate with intervals each second. Its samples come at
// a rate of its own, as one that was measured had.
class SimulatedStrap final : public SimulatedDevice {
 public:
  explicit SimulatedStrap(const SimulatedDeviceOptions& options)
      : options_(options), samples_(kRate_hz), seconds_(1.0) {}
  void run(const PersonActs& acts, TimeNs now_ns, const Send& send) override {
    const TimeNs device_ns = options_.clock.at(now_ns) + kEpoch_ns;
    const auto host = [&](TimeNs at_ns) { return options_.clock.host(at_ns - kEpoch_ns, now_ns); };
    samples_.until(device_ns, [&](TimeNs at_ns) { sample(acts, at_ns, host(at_ns), send); });
    seconds_.until(device_ns, [&](TimeNs at_ns) {
      net::HeartRatePacket packet{.bpm = static_cast<std::uint16_t>(std::lround(acts.heart_bpm)),
                                  .contact = true,
                                  .intervals = std::exchange(intervals_, {})};
      if (!options_.recording) send(net::encode_heart_rate(packet), host(at_ns));
    });
  }
  std::optional<TimeNs> wire_ns(TimeNs now_ns) const override {
    return options_.clock.at(now_ns) + kEpoch_ns;
  }

 private:
  // 2026-01-01 since 2000-01-01.
  static constexpr TimeNs kEpoch_ns = TimeNs{9497} * 86'400 * kS;
  static constexpr std::size_t kFrame = 73;
  static constexpr double kRate_hz = 130.16;

  // Bumps of P, Q, R, S and T about the R peak: place and width in s, height in uV (shape after
  // McSharry 2003, IEEE Trans. Biomed. Eng. 50, 289).
  double wave(double since_s, double to_s) const {
    constexpr struct {
      double at_s, wide_s, high_uv;
    } kBumps[] = {{-0.20, 0.025, 150},
                  {-0.03, 0.010, -120},
                  {0.0, 0.011, 1100},
                  {0.03, 0.010, -250},
                  {0.25, 0.045, 300}};
    double sum = 0.0;
    for (const auto& bump : kBumps)
      for (const double t : {since_s, -to_s})
        sum += bump.high_uv * std::exp(-0.5 * std::pow((t - bump.at_s) / bump.wide_s, 2));
    return sum;
  }
  void sample(const PersonActs& acts, TimeNs at_ns, TimeNs host_ns, const Send& send) {
    if (options_.recording) {
      const auto& samples = options_.recording->samples;
      const auto i = static_cast<std::size_t>(static_cast<double>(count_) / kRate_hz *
                                              options_.recording->rate_hz);
      const double uv = samples[i % samples.size()];
      frame_.samples_uv.push_back(std::isfinite(uv) ? static_cast<std::int32_t>(uv) : 0);
    } else {
      const double period_s = 60.0 / acts.heart_bpm;
      since_beat_s_ += 1.0 / kRate_hz;
      if (since_beat_s_ >= beat_s_) {
        intervals_.push_back(static_cast<std::uint16_t>(std::lround(beat_s_ / net::kRrUnit_s)));
        since_beat_s_ -= beat_s_;
        // Breath moves the next beat by some 3 %.
        beat_s_ = period_s *
                  (1.0 + 0.03 * std::sin(2e-9 * kPi * static_cast<double>(at_ns % (5 * kS)) / 5.0));
      }
      const double noise = 20.0 * (random_uniform({options_.seed, 0x656367, 0}, count_) - 0.5);
      frame_.samples_uv.push_back(
          static_cast<std::int32_t>(wave(since_beat_s_, beat_s_ - since_beat_s_) + noise));
    }
    ++count_;
    if (frame_.samples_uv.size() < kFrame) return;
    frame_.time_ns = static_cast<std::uint64_t>(at_ns);
    send(net::encode_ecg(frame_), host_ns);
    frame_.samples_uv.clear();
  }

  SimulatedDeviceOptions options_;
  Ticks samples_, seconds_;
  net::EcgFrame frame_;
  std::vector<std::uint16_t> intervals_;
  double since_beat_s_ = 0.0, beat_s_ = 60.0 / 70.0;
  std::uint64_t count_ = 0;
};

// A jacket's controller: UBCD each 20 ms, and at once on a change.
class SimulatedJacket final : public SimulatedDevice {
 public:
  explicit SimulatedJacket(const SimulatedDeviceOptions& options)
      : options_(options), ticks_(50.0) {}
  void run(const PersonActs& acts, TimeNs now_ns, const Send& send) override {
    const TimeNs device_ns = options_.clock.at(now_ns);
    if (last_ns_ > 0)
      for (std::size_t i = 0; i < 3; ++i)
        if ((pressed_ >> i & 1) != 0) pressed_ns_[i] += device_ns - last_ns_;
    last_ns_ = device_ns;
    bool due = acts.buttons != pressed_;
    for (std::size_t i = 0; i < 3; ++i) presses_ += (acts.buttons & ~pressed_) >> i & 1;
    pressed_ = acts.buttons;
    ticks_.until(device_ns, [&](TimeNs) { due = true; });
    if (due) say(device_ns, now_ns, send);
  }
  std::optional<TimeNs> wire_ns(TimeNs now_ns) const override { return options_.clock.at(now_ns); }

 private:
  void say(TimeNs device_ns, TimeNs now_ns, const Send& send) {
    net::UbcdCounters counters{.sequence = sequence_++,
                               .time_us = static_cast<std::uint64_t>(device_ns / 1000),
                               .presses = static_cast<std::uint8_t>(presses_)};
    net::JacketPacket packet;
    for (std::size_t i = 0; i < 3; ++i) {
      packet.pressed[i] = (pressed_ >> i & 1) != 0;
      counters.pressed_ms[i] = static_cast<std::uint16_t>(pressed_ns_[i] / kMs);
    }
    packet.counters = counters;
    send(net::encode_jacket(packet), now_ns);
  }
  SimulatedDeviceOptions options_;
  Ticks ticks_;
  TimeNs last_ns_ = 0;
  std::uint64_t pressed_ = 0, presses_ = 0;
  std::array<TimeNs, 3> pressed_ns_{};
  std::uint16_t sequence_ = 0;
};
static_assert(diver::kInflate == 1 && diver::kDeflate == 2 && diver::kDump == 4);

// A microphone at the regulator.
class SimulatedMicrophone final : public SimulatedDevice {
 public:
  explicit SimulatedMicrophone(const SimulatedDeviceOptions& options)
      : options_(options),
        rate_hz_(options.rate_hz > 0.0 ? options.rate_hz : 16'000.0),
        ticks_(1.0 / kPacket_s),
        sound_(rate_hz_, options.seed) {}
  void run(const PersonActs& acts, TimeNs now_ns, const Send& send) override {
    ticks_.until(options_.clock.at(now_ns), [&](TimeNs at_ns) {
      packet(acts, at_ns, options_.clock.host(at_ns, now_ns), send);
    });
  }
  std::optional<TimeNs> wire_ns(TimeNs now_ns) const override { return options_.clock.at(now_ns); }

 private:
  static constexpr double kPacket_s = 0.02;

  void packet(const PersonActs& acts, TimeNs at_ns, TimeNs host_ns, const Send& send) {
    const auto count = static_cast<std::size_t>(std::lround(kPacket_s * rate_hz_));
    if (sent_ == 0)
      // The packet ends now: its first sample was heard before.
      timestamp_ =
          static_cast<std::uint32_t>(std::llround(1e-9 * static_cast<double>(at_ns) * rate_hz_) -
                                     static_cast<long long>(count));
    net::RtpPacket packet{.sequence = static_cast<std::uint16_t>(sent_++),
                          .timestamp = timestamp_,
                          .ssrc = 0x6e657269};
    for (std::size_t i = 0; i < count; ++i) packet.samples.push_back(next_sample(acts));
    timestamp_ += static_cast<std::uint32_t>(count);
    send(net::encode_rtp(packet), host_ns);
  }
  float next_sample(const PersonActs& acts) {
    if (options_.recording) {
      const auto& sound = options_.recording->samples;
      const double value = sound[count_++ % sound.size()];
      return std::isfinite(value) ? static_cast<float>(value) : 0.0F;
    }
    return sound_.next(acts.breath_bpm);
  }
  SimulatedDeviceOptions options_;
  double rate_hz_;
  Ticks ticks_;
  std::uint32_t timestamp_ = 0;
  std::uint64_t sent_ = 0, count_ = 0;  // packets; samples of the recording
  BreathSound sound_;
};

// An eye tracker of 120 samples a second (UGZD), with the noise of a good one.
class SimulatedGaze final : public SimulatedDevice {
 public:
  explicit SimulatedGaze(const SimulatedDeviceOptions& options)
      : options_(options), ticks_(120.0) {}
  void run(const PersonActs& acts, TimeNs now_ns, const Send& send) override {
    ticks_.until(options_.clock.at(now_ns), [&](TimeNs at_ns) {
      net::GazePacket packet{.valid = acts.eyes_open,
                             .sequence = static_cast<std::uint16_t>(count_),
                             .time_us = static_cast<std::uint64_t>(at_ns / 1000)};
      for (int i = 0; i < 3; ++i) {
        const auto draw = 3 * count_ + static_cast<std::uint64_t>(i);
        const double noise =
            kNoise_rad * (2.0 * random_uniform({options_.seed, 0x67617a, 0}, draw) - 1.0);
        packet.direction[i] = static_cast<float>(acts.gaze[i] + noise);
      }
      ++count_;
      send(net::encode_gaze(packet), options_.clock.host(at_ns, now_ns));
    });
  }
  std::optional<TimeNs> wire_ns(TimeNs now_ns) const override { return options_.clock.at(now_ns); }

 private:
  // Sample to sample, evenly spread: some 0.05 degrees rms (Holmqvist 2011: 0.01 to 0.05 of
  // trackers on a stand, up to 0.1 worn).
  static constexpr double kNoise_rad = 1.5e-3;
  SimulatedDeviceOptions options_;
  Ticks ticks_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<SimulatedDevice> simulated_device(std::string_view kind,
                                                  const SimulatedDeviceOptions& options) {
  if (kind == "mxtp") return std::make_unique<SimulatedSuit>(options);
  if (kind == "strap") return std::make_unique<SimulatedStrap>(options);
  if (kind == "jacket") return std::make_unique<SimulatedJacket>(options);
  if (kind == "gaze") return std::make_unique<SimulatedGaze>(options);
  NERITIC_CHECK(kind == "microphone", "{}", kind);
  return std::make_unique<SimulatedMicrophone>(options);
}

}  // namespace neritic::testbed
