#include "testbed/devices/device_source.hpp"

#include <algorithm>

#include "diver/breath_bands.hpp"
#include "engine/core/thread_urgency.hpp"
#include "testbed/devices/gaze_adapter.hpp"
#include "testbed/devices/jacket_adapter.hpp"
#include "testbed/devices/microphone_adapter.hpp"
#include "testbed/devices/strap_adapter.hpp"
#include "testbed/devices/suit_adapter.hpp"

namespace neritic::testbed {
namespace {

// So soon a thread that is asked to stop does.
constexpr int kLongestWait_ms = 20;

Result<std::unique_ptr<DeviceAdapter>> adapter_of(const scene::DeviceSource& source) {
  using Adapter = std::unique_ptr<DeviceAdapter>;
  if (source.device == "mxtp")
    return Adapter(std::make_unique<SuitAdapter>(static_cast<std::uint8_t>(source.character),
                                                 source.by.starts_with("tcp")));
  if (source.device == "strap") return Adapter(std::make_unique<StrapAdapter>());
  if (source.device == "jacket") return Adapter(std::make_unique<JacketAdapter>());
  if (source.device == "gaze") return Adapter(std::make_unique<GazeAdapter>());
  NERITIC_TRY_STATUS(diver::check_sound_rate(source.rate_hz));
  return Adapter(std::make_unique<MicrophoneAdapter>(source.rate_hz));
}

// For what was sent, as far as counters tell.
double lost_share(const net::LinkCounts& link) {
  return static_cast<double>(link.lost) /
         static_cast<double>(std::max<std::uint64_t>(1, link.lost + link.used));
}

std::string numbers_of(std::uint32_t ipv4) {
  return fmt::format("{}.{}.{}.{}", ipv4 >> 24, ipv4 >> 16 & 255, ipv4 >> 8 & 255, ipv4 & 255);
}

std::string place_of(const scene::DeviceSource& source) {
  if (source.by == "udp" || source.by.starts_with("tcp")) return to_text(source.address);
  return source.by + " " + source.port;
}

}  // namespace

Result<std::unique_ptr<DeviceSource>> DeviceSource::open(const scene::DeviceSource& source,
                                                         const PhysicsWorld& world,
                                                         SampleInbox& inbox, Pace pace) {
  const auto wearer = std::ranges::find(world.humans(), source.diver, &PhysicsHuman::name);
  NERITIC_CHECK(wearer != world.humans().end(), "source {}: no diver {}", source.name,
                source.diver);
  auto adapter = adapter_of(source);
  if (!adapter.ok())
    return Error{adapter.error().code,
                 fmt::format("source {}: {}", source.name, adapter.error().message)};
  NERITIC_TRY(auto feed, open_feed(source));
  NERITIC_TRY(const SourceId id, inbox.open(source.name, (*adapter)->max_age_ns()));
  const Outlet outlet(inbox, id, world.streams(),
                      static_cast<std::uint32_t>(wearer - world.humans().begin()));
  std::unique_ptr<DeviceSource> out(
      new DeviceSource(source, std::move(feed), std::move(adapter).value(), outlet));
  out->health_.name = source.name;
  out->health_.device = source.device;
  out->health_.where = place_of(source);
  if (pace == Pace::kThread) out->thread_ = std::thread([it = out.get()] { it->run(); });
  return out;
}

std::string DeviceSource::signal_kind() const {
  return settings_.device == "microphone" ? "sound" : settings_.device == "strap" ? "ecg" : "";
}

DeviceSource::~DeviceSource() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void DeviceSource::run() {
  set_urgency(ThreadUrgency::kInput);  // in a flood it gives way to the simulation
  while (!stop_) {
    const TimeNs wake_ns = adapter_->wakes_at_ns();
    const TimeNs wait_ns =
        wake_ns == DeviceAdapter::kNever ? kLongestWait_ms * kMillisecond_ns : wake_ns - now_ns();
    const int wait_ms =
        static_cast<int>(std::clamp<TimeNs>(wait_ns / kMillisecond_ns, 0, TimeNs{kLongestWait_ms}));
    feed_->receive(
        [this](net::Bytes bytes, bool cut) { take(bytes, cut, now_ns() - feed_->waited_ns()); },
        wait_ms);
    feed_->exchange_times(*adapter_);
    adapter_->tick(now_ns(), outlet_);
    tell(now_ns());
  }
}

Status DeviceSource::poll(SampleInbox&, double scene_time_s) {
  if (thread_.joinable()) return {};
  const auto at_ns = static_cast<TimeNs>(scene_time_s * 1e9);
  receive_at(at_ns, 0);
  adapter_->tick(at_ns, outlet_);
  if (at_ns - rated_ns_ >= kSecond_ns) tell(at_ns);
  return {};
}

void DeviceSource::receive_at(TimeNs at_ns, int wait_ms) {
  feed_->at_simulated(at_ns);
  feed_->receive([&](net::Bytes bytes, bool cut) { take(bytes, cut, at_ns); }, wait_ms);
}

// Garbage of others does not keep the device out: a sender is chosen by what can be used.
void DeviceSource::take(net::Bytes bytes, bool cut, TimeNs arrived_ns) {
  const auto from = feed_->from();
  if (from && !senders_.admits(*from, arrived_ns)) {
    ++strangers_;
    return;
  }
  heard_ns_ = arrived_ns;
  const std::uint64_t used = adapter_->counts().used;
  adapter_->take(bytes, cut, arrived_ns, outlet_);
  if (from && adapter_->counts().used > used) (void)senders_.use(*from, arrived_ns);
}

void DeviceSource::tell(TimeNs now_ns) {
  const net::LinkCounts& counts = adapter_->counts();
  if (now_ns - rated_ns_ >= kSecond_ns) {
    rate_hz_ = rated_ns_ == 0 ? 0.0
                              : 1e9 * static_cast<double>(counts.datagrams - rated_) /
                                    static_cast<double>(now_ns - rated_ns_);
    rated_ns_ = now_ns;
    rated_ = counts.datagrams;
  }
  const std::lock_guard lock(mutex_);
  health_.link = counts;
  health_.link.overflowed = feed_->overflowed();
  health_.link.strangers = strangers_;
  health_.clock = adapter_->clock();
  health_.samples = outlet_.sent();
  health_.accepted = outlet_.accepted();
  health_.heard_ns = heard_ns_;
  health_.rate_hz = rate_hz_;
  health_.trouble = feed_->trouble();
  if (health_.trouble.empty()) health_.trouble = adapter_->trouble();
  if (const auto other = senders_.other(); other && health_.trouble.empty())
    health_.trouble = fmt::format("{} sends here too and is not used: one sender a port",
                                  numbers_of(static_cast<std::uint32_t>(*other)));
}

DeviceHealth DeviceSource::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

LinkState link_state(const DeviceHealth& health, TimeNs now_ns) {
  if (health.heard_ns == 0) return LinkState::kWaiting;
  return now_ns - health.heard_ns > kSecond_ns ? LinkState::kSilent : LinkState::kHeard;
}

std::string health_words(const DeviceHealth& health, TimeNs now_ns) {
  const net::LinkCounts& link = health.link;
  std::string words = fmt::format("{} ({}, {}): ", health.name, health.device, health.where);
  if (!health.trouble.empty()) words += health.trouble + ", ";
  const LinkState state = link_state(health, now_ns);
  if (state == LinkState::kWaiting) return words + "nothing heard yet";
  const double silent_s = 1e-9 * static_cast<double>(now_ns - health.heard_ns);
  words += state == LinkState::kSilent ? fmt::format("silent for {:.0f} s", silent_s)
                                       : fmt::format("{:.0f} packets a second", health.rate_hz);
  if (link.lost > 0) words += fmt::format(", {:.1f} % lost", 100.0 * lost_share(link));
  for (const auto& [count, what] : {std::pair(link.older, "out of order"),
                                    {link.repeated, "repeated"},
                                    {link.malformed, "malformed"},
                                    {link.unused, "not used"},
                                    {link.overflowed, "dropped by the full queue"},
                                    {link.strangers, "of other senders"},
                                    {link.restarts, "times started again"}})
    if (count > 0) words += fmt::format(", {} {}", count, what);
  const net::ClockEstimate& clock = health.clock;
  if (!clock.known) return words + ", no clock in its packets";
  words += fmt::format(", clock {:+.6f} s off", clock.offset_s);
  if (clock.drift_ppm != 0.0) words += fmt::format(" and {:+.1f} ppm", clock.drift_ppm);
  return words +
         fmt::format(", jitter {:.1f} ms (longest {:.1f})", clock.spread_ms, clock.longest_ms);
}

std::string link_words(const DeviceHealth& health) {
  const net::LinkCounts& link = health.link;
  std::string words = fmt::format("{} {:.0f}/s", health.name, health.rate_hz);
  if (link.lost > 0) words += fmt::format(", {:.1f} % lost", 100.0 * lost_share(link));
  if (health.clock.drift_ppm != 0.0) words += fmt::format(", {:+.0f} ppm", health.clock.drift_ppm);
  return words;
}

std::string stream_words(const DeviceHealth& health, TimeNs now_ns) {
  const LinkState state = link_state(health, now_ns);
  if (state == LinkState::kWaiting)
    return fmt::format("{}: nothing heard at {}", health.name, health.where);
  if (state == LinkState::kSilent)
    return fmt::format("{}: silent for {:.0f} s", health.name,
                       1e-9 * static_cast<double>(now_ns - health.heard_ns));
  std::string words = link_words(health);
  if (!health.trouble.empty()) return words + ", " + health.trouble;
  if (health.clock.known)
    words += fmt::format(", clock {:+.3f} s, jitter {:.0f} ms", health.clock.offset_s,
                         health.clock.spread_ms);
  return words;
}

}  // namespace neritic::testbed
