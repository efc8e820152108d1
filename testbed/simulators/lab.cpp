#include "testbed/simulators/lab.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::testbed {
namespace {

// A packet on the loopback is there at once; a busy machine gets so long.
constexpr int kArrives_ms = 100;
constexpr double kMostOffset_s = 20'000.0, kMostDrift_ppm = 50.0;

// Set at another time, fast or slow by up to 50 ppm, as a good quartz is.
DeviceClock clock_of(std::uint64_t seed, std::uint64_t device) {
  const RandomKey key{seed, 0x636c6f636b, device};
  return {static_cast<TimeNs>(1e9 * (1.0 + kMostOffset_s * random_uniform(key, 0))),
          kMostDrift_ppm * (2.0 * random_uniform(key, 1) - 1.0)};
}

Address address_of(const scene::DeviceSource& source, const LabOptions& options) {
  Address to = source.address;
  to.ipv4 = options.to_ipv4.value_or(to.ipv4 == 0 ? Address().ipv4 : to.ipv4);
  return to;
}

// A stream to a device's port. One that broke is connected again, at most each kConnectEvery_ns,
// since an attempt may wait for a second; the packets until then are lost.
class Stream {
 public:
  static Result<Stream> open(const Address& to) {
    Stream out(to);
    NERITIC_TRY(out.sender_, net::TcpSender::connect(to));
    return out;
  }
  bool send(net::Bytes bytes) {
    if (!sender_ && now_ns() >= next_ns_) {
      next_ns_ = now_ns() + kConnectEvery_ns;
      if (auto again = net::TcpSender::connect(to_); again.ok()) sender_ = std::move(again).value();
    }
    if (sender_ && !sender_->send(bytes)) sender_.reset();
    return sender_.has_value();
  }

 private:
  static constexpr TimeNs kConnectEvery_ns = 3 * kSecond_ns;
  explicit Stream(const Address& to) : to_(to) {}
  Address to_;
  std::optional<net::TcpSender> sender_;
  TimeNs next_ns_ = 0;
};

Result<std::function<bool(net::Bytes)>> sender_to(const scene::DeviceSource& source,
                                                  const Address& to) {
  using ToWire = std::function<bool(net::Bytes)>;
  if (source.by == "udp") {
    NERITIC_TRY(net::UdpSender sender, net::UdpSender::create(to));
    const auto kept = std::make_shared<net::UdpSender>(std::move(sender));
    return ToWire([kept](net::Bytes bytes) { return kept->send(bytes); });
  }
  if (source.by == "tcp") {
    NERITIC_TRY(Stream stream, Stream::open(to));
    const auto kept = std::make_shared<Stream>(std::move(stream));
    return ToWire([kept](net::Bytes bytes) { return kept->send(bytes); });
  }
  return refusal(fmt::format("source {}", source.name),
                 fmt::format("{} to be simulated", source.by), "udp or tcp");
}

}  // namespace

Result<std::unique_ptr<SimulatedLab>> SimulatedLab::create(const scene::Scene& scene,
                                                           const PhysicsWorld& world,
                                                           Devices* devices, Seen seen,
                                                           const LabOptions& options) {
  std::unique_ptr<SimulatedLab> lab(new SimulatedLab(std::move(seen)));
  lab->simulated_time_ = devices != nullptr;
  const auto names_it = [](const std::string& name, const scene::DeviceSource& source) {
    return name == source.name || name == source.device ||
           (name == "suit" && source.device == "mxtp");
  };
  std::string unknown;
  for (const std::string& name : options.names)
    if (std::ranges::none_of(scene.sources, [&](const auto& one) { return names_it(name, one); }))
      unknown += (unknown.empty() ? "" : ", ") + name;
  for (const scene::DeviceSource& source : scene.sources)
    if (options.names.empty() || std::ranges::any_of(options.names, [&](const std::string& name) {
          return names_it(name, source);
        }))
      NERITIC_TRY_STATUS(lab->add(source, world, devices, options));
  if (!lab->worn_.empty() && unknown.empty()) return lab;
  std::string names;
  for (const scene::DeviceSource& source : scene.sources)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", source.name);
  return refusal(
      scene.path,
      options.names.empty() ? std::string("no [sources] to simulate") : "no source " + unknown,
      names.empty() ? "a scene with [sources], such as assets/scenes/lab.toml" : names);
}

Status SimulatedLab::add(const scene::DeviceSource& source, const PhysicsWorld& world,
                         Devices* devices, const LabOptions& options) {
  const auto human = std::ranges::find(world.humans(), source.diver, &PhysicsHuman::name);
  const auto diver = static_cast<std::size_t>(human - world.humans().begin());
  auto wearer = std::ranges::find(wearers_, diver, &Wearer::diver);
  if (wearer == wearers_.end()) {
    wearers_.push_back({diver, SimulatedPerson(*human)});
    wearer = wearers_.end() - 1;
    wearer->person.follow(options.limbs, options.buttons);
  }
  const std::size_t number = worn_.size();
  net::LinkFaults faults = options.faults;
  faults.seed = mix64(faults.seed + number);
  SimulatedDeviceOptions device{.clock = clock_of(faults.seed, number), .seed = faults.seed};
  if (source.device == "mxtp") device.rate_hz = options.suit_hz, device.gloves = options.gloves;
  if (source.device == "microphone")
    device.rate_hz = source.rate_hz, device.recording = options.sound;
  if (source.device == "strap") device.recording = options.ecg;
  const Address to = address_of(source, options);
  std::string way = fmt::format("{} ({}) to {}", source.name, source.device, to_text(to));
  if (source.by == "tcp" &&
      (faults.loss > 0.0 || faults.repeat > 0.0 || faults.cut > 0.0 || faults.jitter_s > 0.0))
    way += ", without loss, repeats, cuts and jitter, which a stream has not";
  if (source.by == "tcp") faults.loss = faults.repeat = faults.cut = 0.0, faults.jitter_s = 0.0;
  NERITIC_TRY(auto to_wire, sender_to(source, to));
  DeviceSource* receiver = nullptr;
  if (devices)
    for (const auto& one : devices->all())
      if (one->name() == source.name) receiver = one.get();
  worn_.push_back({source.name, std::move(way), static_cast<std::size_t>(wearer - wearers_.begin()),
                   device.clock, simulated_device(source.device, device), net::RoughLink(faults),
                   std::move(to_wire), receiver});
  return {};
}

Status SimulatedLab::poll(SampleInbox& inbox, double scene_time_s) {
  const double dt_s = last_s_ ? scene_time_s - *last_s_ : 0.0;
  last_s_ = scene_time_s;
  now_ns_ = simulated_time_ ? static_cast<TimeNs>(std::llround(scene_time_s * 1e9)) : now_ns();
  if (dt_s > 0.0)
    for (Wearer& wearer : wearers_) wearer.person.act(seen_(wearer.diver), scene_time_s, dt_s);
  for (Worn& worn : worn_) {
    worn.device->run(wearers_[worn.wearer].person.acts(), now_ns_,
                     [&](std::vector<std::byte> bytes, TimeNs at_ns) {
                       worn.link.send(at_ns, std::move(bytes));
                     });
    deliver(worn, now_ns_);
    if (worn.receiver) NERITIC_TRY_STATUS(worn.receiver->poll(inbox, scene_time_s));
    if (worn.receiver && scene_time_s > kKnownAfter_s)
      worn.worst_ms = std::max(worn.worst_ms, std::abs(clock_error_ms(worn, now_ns_)));
  }
  return {};
}

std::vector<std::string> SimulatedLab::ways() const {
  std::vector<std::string> out;
  for (const Worn& worn : worn_) out.push_back(worn.way);
  return out;
}

void SimulatedLab::deliver(Worn& worn, TimeNs now_ns) {
  while (!worn.link.empty() && worn.link.next().due_ns <= now_ns) {
    const net::RoughLink::Packet packet = worn.link.take_next();
    const bool sent = worn.to_wire(packet.bytes);
    if (!sent) ++not_taken_;
    if (worn.receiver && sent) worn.receiver->receive_at(packet.due_ns, kArrives_ms);
  }
}

double SimulatedLab::clock_error_ms(const Worn& worn, TimeNs now_ns) const {
  const auto wire_ns = worn.device->wire_ns(now_ns);
  if (!wire_ns || !worn.receiver || !worn.receiver->clock_map().estimate().known) return 0.0;
  return to_ms(worn.receiver->clock_map().to_host(*wire_ns) - now_ns);
}

std::vector<ClockError> SimulatedLab::clock_errors() const {
  std::vector<ClockError> out;
  for (const Worn& worn : worn_) {
    const bool known = worn.receiver && worn.receiver->clock_map().estimate().known;
    const double offset_s =
        1e-9 * static_cast<double>(now_ns_ - worn.device->wire_ns(now_ns_).value_or(now_ns_));
    out.push_back({worn.name, known, offset_s, -worn.clock.drift_ppm, clock_error_ms(worn, now_ns_),
                   worn.worst_ms});
  }
  return out;
}

std::uint64_t SimulatedLab::sent() const {
  std::uint64_t sum = 0;
  for (const Worn& worn : worn_) sum += worn.link.sent();
  return sum;
}
std::uint64_t SimulatedLab::lost() const {
  std::uint64_t sum = 0;
  for (const Worn& worn : worn_) sum += worn.link.lost();
  return sum;
}

}  // namespace neritic::testbed
