// `neritic simulate flood`: a scene that runs by the host's clock while packets come at a rate that
// no device has, good ones and bad ones. Tells whether a step was dropped, whether every packet was
// counted once, and whether the diver's breath was heard meanwhile.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/net/gaze_wire.hpp"
#include "engine/net/heart_strap.hpp"
#include "engine/net/jacket_wire.hpp"
#include "engine/net/rtp.hpp"
#include "testbed/devices/suit_posture.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/simulators/breath_sound.hpp"
#include "tools/neritic/simulate.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kFloodSeconds = 60.0;
constexpr std::size_t kMostBurst = 100;  // packets at once
constexpr double kBurst_s = 1e-3;
constexpr TimeNs kLook_ns = 20'000'000;
constexpr double kBreaths_bpm = 15.0;  // of the flood's microphone

// The packets of a microphone. As a real one's, they hold all sound since the packet before, at the
// source's rate, so that many packets a second are short ones.
class SoundPackets {
 public:
  explicit SoundPackets(double rate_hz) : rate_hz_(rate_hz), sound_(rate_hz, 1) {}
  // The packet that leaves so long after the first. If no sample was heard since the packet before,
  // that one again. Sound that no datagram holds is skipped.
  std::vector<std::byte> next(TimeNs since_begin_ns) {
    const auto heard = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(1e-9 * static_cast<double>(since_begin_ns) * rate_hz_));
    if (heard <= told_) return last_;
    told_ = std::max(told_, heard - std::min<std::uint64_t>(heard, kMostSamples));
    net::RtpPacket packet{.sequence = sequence_++, .timestamp = static_cast<std::uint32_t>(told_)};
    for (; told_ < heard; ++told_) packet.samples.push_back(sound_.next(kBreaths_bpm));
    return last_ = net::encode_rtp(packet);
  }

 private:
  static constexpr std::uint64_t kMostSamples = 2000;  // 4012 bytes, below net::kMostDatagram
  double rate_hz_;
  BreathSound sound_;
  std::uint16_t sequence_ = 0;
  std::uint64_t told_ = 0;  // samples in packets so far
  std::vector<std::byte> last_;
};

// Good packets of a device, each with the next number.
class PacketMaker {
 public:
  explicit PacketMaker(const scene::DeviceSource& source)
      : device_(source.device), sound_(source.rate_hz) {
    const net::SuitFrame frame = suit_frame(diver::straight_joints(), {}, Quat(1.0, 0.0, 0.0, 0.0));
    suit_ = net::encode_mxtp({.body_segments = net::kMxtpBodySegments},
                             {frame.body.data(), frame.body.size()});
  }
  bool makes(std::string_view device) const { return device_ == device; }
  // The packet that leaves so long after the flood began.
  std::vector<std::byte> next(TimeNs since_begin_ns) {
    if (device_ == "microphone") return sound_.next(since_begin_ns);
    const std::uint64_t n = number_++;
    if (device_ == "mxtp") {
      // The same posture under the next number: the flood is to load the receiver, not itself.
      net::put_mxtp_number(suit_, static_cast<std::uint32_t>(n),
                           static_cast<std::uint32_t>(n / 100));
      return suit_;
    }
    if (device_ == "strap")
      return net::encode_ecg({n * 10'000'000, std::vector<std::int32_t>(73, 100)});
    if (device_ == "gaze")
      return net::encode_gaze({.sequence = static_cast<std::uint16_t>(n), .time_us = n * 1'000});
    net::JacketPacket packet;
    packet.counters =
        net::UbcdCounters{.sequence = static_cast<std::uint16_t>(n), .time_us = n * 10'000};
    return net::encode_jacket(packet);
  }

 private:
  std::string device_;
  SoundPackets sound_;
  std::vector<std::byte> suit_;
  std::uint64_t number_ = 0;
};

struct Target {
  PacketMaker maker;
  net::RoughLink link;
  net::UdpSender sender;
};

// Sends until it is told to stop; gives the number of packets that the system took.
std::uint64_t flood(std::vector<Target>& targets, double rate_hz, const std::atomic<bool>& stop) {
  std::uint64_t sent = 0, made = 0;
  const TimeNs begun_ns = now_ns();
  TimeNs heard_ns = 0;  // since then, until the newest burst
  const auto burst = static_cast<std::size_t>(
      std::clamp(kBurst_s * rate_hz, 1.0, static_cast<double>(kMostBurst)));
  std::vector<std::vector<std::byte>> ready;
  while (!stop) {
    const TimeNs due_ns = begun_ns + static_cast<TimeNs>(1e9 * static_cast<double>(made) / rate_hz);
    if (const TimeNs wait_ns = due_ns - now_ns(); wait_ns > 0) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(wait_ns, kLook_ns)));
      continue;  // it may be told to stop meanwhile
    }
    // Sound is heard by the host's clock, also if the machine is too slow for the flood. The
    // packets of a burst share the time since the burst before.
    const TimeNs until_ns = now_ns() - begun_ns;
    for (std::size_t i = 0; i < burst; ++i, ++made) {
      // Nine of ten go to the first device, the others in turn.
      Target& target = targets[made % 10 == 0 ? (made / 10) % targets.size() : 0];
      const TimeNs part_ns =
          (until_ns - heard_ns) * static_cast<TimeNs>(i + 1) / static_cast<TimeNs>(burst);
      target.link.send(due_ns, target.maker.next(heard_ns + part_ns));
    }
    heard_ns = until_ns;
    for (Target& target : targets) {
      ready.clear();
      while (!target.link.empty() && target.link.next().due_ns <= due_ns)
        ready.push_back(target.link.take_next().bytes);
      sent += target.sender.send(ready);
    }
  }
  return sent;
}

// The breath that the dive's steps used; written by the stepping thread.
struct HeardBreath {
  std::uint64_t estimates = 0, with_rate = 0;
  double rate_bpm = 0.0;  // the newest; 0: none
  void use(const Sample& sample) {
    if (sample.kind() != PayloadKind::kBreath) return;
    rate_bpm = std::get<Breath>(sample.payload).monitor.estimate.rate_bpm;
    ++estimates;
    with_rate += rate_bpm > 0.0;
  }
};

bool adds_up(const net::LinkCounts& c) {
  return c.datagrams == c.used + c.malformed + c.unused + c.repeated + c.older;
}

}  // namespace

Status simulate_flood(const SimulateFlags& flags, const scene::Scene& scene,
                      const Interrupt& interrupt) {
  SimulatedSignals none;
  NERITIC_TRY(const LabOptions options, lab_options(flags, none));
  if (!(flags.rate_hz >= 1.0 && flags.rate_hz <= 1e6))
    return refusal("--rate", fmt::format("{:g}", flags.rate_hz), "1 to 1000000 packets a second");
  NERITIC_TRY(auto made, PhysicsWorld::create(scene));
  sim::HostClock host;
  sim::RunClock run(host);
  const auto physics =
      LivePhysics::create(std::move(made), {.pace = LivePhysics::Pace::kClock, .clock = &run});
  NERITIC_TRY(const auto devices, Devices::open(scene, physics->world(), physics->inbox(),
                                                DeviceSource::Pace::kThread));
  std::vector<Target> targets;
  for (const scene::DeviceSource& source : scene.sources) {
    if (source.by != "udp") continue;
    Address to = source.address;
    to.ipv4 = Address().ipv4;
    NERITIC_TRY(net::UdpSender sender, net::UdpSender::create(to));
    net::LinkFaults faults = options.faults;
    faults.seed += targets.size();
    targets.push_back({PacketMaker(source), net::RoughLink(faults), std::move(sender)});
  }
  // Most go to the suit, whose packets are the longest.
  std::ranges::stable_partition(targets,
                                [](const Target& target) { return target.maker.makes("mxtp"); });
  if (targets.empty()) return refusal(flags.scene, "no source by udp", "one or more to flood");
  const double seconds = flags.seconds.value_or(kFloodSeconds);
  HeardBreath breath;
  physics->observe({}, [&](const Sample& sample) { breath.use(sample); });
  physics->start();
  std::atomic<bool> stop{false};
  std::uint64_t sent = 0;
  std::thread sender([&] { sent = flood(targets, flags.rate_hz, stop); });
  const TimeNs begun_ns = now_ns();
  while (!interrupt.requested() && 1e-9 * static_cast<double>(now_ns() - begun_ns) < seconds)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  stop = true;
  sender.join();
  const double took_s = 1e-9 * static_cast<double>(now_ns() - begun_ns);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // for what waits in the kernel
  physics->stop();
  std::uint64_t received = 0, overflowed = 0;
  bool whole = true;
  nlohmann::json links = nlohmann::json::object();
  for (const DeviceHealth& health : devices->health()) {
    const net::LinkCounts& c = health.link;
    received += c.datagrams;
    overflowed += c.overflowed;
    whole = whole && adds_up(c);
    links[health.name] = {{"datagrams", c.datagrams}, {"used", c.used},
                          {"malformed", c.malformed}, {"unused", c.unused},
                          {"repeated", c.repeated},   {"older", c.older},
                          {"lost", c.lost},           {"overflowed", c.overflowed},
                          {"samples", health.samples}};
    if (!flags.json && !flags.quiet) fmt::print("{}\n", health_words(health, now_ns()));
  }
  const auto counts = physics->counts();
  whole = whole && received + overflowed <= sent;
  if (flags.json) {
    nlohmann::json json{{"seconds", took_s},
                        {"rate_hz", sent / took_s},
                        {"sent", sent},
                        {"received", received},
                        {"overflowed", overflowed},
                        {"steps", counts.steps},
                        {"steps_caught_up", counts.caught_up},
                        {"steps_dropped", counts.dropped},
                        {"counts_add_up", whole},
                        {"breath",
                         {{"estimates", breath.estimates},
                          {"with_rate", breath.with_rate},
                          {"rate_bpm", breath.rate_bpm}}},
                        {"links", links}};
    fmt::print("{}\n", json_text(json));
  } else if (!flags.quiet) {
    fmt::print(
        "{} packets in {:.1f} s ({:.0f} a second): {} received, {} dropped by full queues; {} "
        "steps, "
        "{} of them caught up, {} dropped\n",
        sent, took_s, static_cast<double>(sent) / took_s, received, overflowed, counts.steps,
        counts.caught_up, counts.dropped);
    if (breath.estimates > 0)
      fmt::print("{} estimates of breath, {} of them with a rate, the newest {:.1f} a minute\n",
                 breath.estimates, breath.with_rate, breath.rate_bpm);
  }
  if (!whole) return failure(ErrorCode::kInternal, "the counts of packets do not add up");
  if (counts.dropped > 0)
    return failure(ErrorCode::kUnsupported, "{} steps were dropped", counts.dropped);
  return {};
}

}  // namespace neritic::tools
