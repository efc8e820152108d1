// The sources of a World's samples, as it tells of them.
#include <algorithm>

#include "engine/core/clock.hpp"
#include "testbed/world/world_parts.hpp"

namespace neritic::testbed {
namespace {

// The worst of what is known of a source.
enum class SourceHealth { kUnknown, kGood, kWaiting, kLost };

SourceHealth health_of(GroupPhase phase) {
  switch (phase) {
    case GroupPhase::kWaiting:
      return SourceHealth::kWaiting;
    case GroupPhase::kLost:
      return SourceHealth::kLost;
    case GroupPhase::kLive:
      return SourceHealth::kGood;
    case GroupPhase::kChosen:
      break;
  }
  return SourceHealth::kUnknown;
}

SourceHealth health_of(LinkState state) {
  return state == LinkState::kWaiting  ? SourceHealth::kWaiting
         : state == LinkState::kSilent ? SourceHealth::kLost
                                       : SourceHealth::kGood;
}

const char* words_of(SourceHealth health) {
  constexpr const char* kWords[] = {"", "good", "waiting", "lost"};
  return kWords[static_cast<std::size_t>(health)];
}

SourceInfo::Link link_of(const DeviceHealth& health) {
  SourceInfo::Link link{.device = health.device,
                        .where = health.where,
                        .rate_hz = health.rate_hz,
                        .lost = health.link.lost,
                        .trouble = health.trouble};
  if (!health.clock.known) return link;
  link.clock_offset_s = health.clock.offset_s;
  link.clock_drift_ppm = health.clock.drift_ppm;
  link.jitter_ms = health.clock.spread_ms;
  return link;
}

}  // namespace

std::vector<std::pair<std::string_view, std::uint64_t>> named_counts(const SourceCounts& counts) {
  return {{"accepted", counts.accepted},
          {"dropped", counts.dropped},
          {"lost", counts.lost},
          {"late", counts.late},
          {"repeated", counts.repeated},
          {"out_of_order", counts.out_of_order},
          {"not_finite", counts.not_finite},
          {"not_plausible", counts.not_plausible},
          {"not_of_stream", counts.not_of_stream}};
}

std::vector<SourceInfo> World::sources() const {
  const SampleInbox& inbox = parts_->physics->inbox();
  const std::vector<std::string> names = inbox.source_names();
  std::vector<SourceHealth> health(names.size(), SourceHealth::kUnknown);
  const auto listen = [&](const auto& participants) {
    for (const auto& participant : participants)
      for (const GroupState& group : participant.groups)
        if (group.authority == Authority::kLive && group.source < health.size())
          health[group.source] = std::max(health[group.source], health_of(group.phase));
  };
  const PhysicsState& state = parts_->newest().state;
  listen(state.vehicles());
  listen(state.humans());
  listen(state.objects());
  std::vector<DeviceHealth> devices;
  if (parts_->devices) devices = parts_->devices->health();
  std::vector<SourceInfo> out;
  for (SourceId id = kSimulation + 1; id < names.size(); ++id) {
    SourceInfo source{.name = names[id], .counts = inbox.counts(id)};
    if (const auto device = std::ranges::find(devices, names[id], &DeviceHealth::name);
        device != devices.end()) {
      source.link = link_of(*device);
      health[id] = std::max(health[id], health_of(link_state(*device, now_ns())));
    }
    source.health = words_of(health[id]);
    out.push_back(std::move(source));
  }
  return out;
}

}  // namespace neritic::testbed
