#include "hud/alarms.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::hud {
namespace {

// The level that begins now, and the one that is kept if it was there.
struct Asked {
  AlarmLevel begins = AlarmLevel::kOff, kept = AlarmLevel::kOff;
};
constexpr Asked kAsBefore{AlarmLevel::kOff, AlarmLevel::kDanger};

AlarmLevel danger_if(bool is) {
  return is ? AlarmLevel::kDanger : AlarmLevel::kOff;
}
AlarmLevel caution_if(bool is) {
  return is ? AlarmLevel::kCaution : AlarmLevel::kOff;
}

// Numbers end it, not the connection alone.
Asked link(const DiveData& d) {
  return {danger_if(d.link_lost), danger_if(d.link_lost || std::isnan(d.depth_m))};
}

Asked gas(const DiveData& d) {
  if (d.out_of_gas) return {AlarmLevel::kDanger, AlarmLevel::kDanger};
  const bool for_ascent = std::isfinite(d.needed_l) && std::isfinite(d.available_l);
  if (std::isnan(d.tank_pa)) return kAsBefore;
  const bool low = d.tank_pa < kReserve_pa || (for_ascent && d.needed_l > d.available_l);
  const bool calm = d.tank_pa >= kReserve_pa + kCalmReserve_pa &&
                    !(for_ascent && kCalmNeeded * d.needed_l > d.available_l);
  return {caution_if(low), caution_if(!calm)};
}

Asked ceiling(const DiveData& d) {
  if (std::isnan(d.depth_m) || std::isnan(d.ceiling_m)) return kAsBefore;
  return {danger_if(d.ceiling_violated), danger_if(d.depth_m < d.ceiling_m)};
}

Asked oxygen(const DiveData& d) {
  if (std::isnan(d.po2_bar)) return kAsBefore;
  return {danger_if(d.po2_bar > d.oxygen_limit_bar),
          danger_if(d.po2_bar > d.oxygen_limit_bar - kCalmOxygen_bar)};
}

// The computer says when a rate has lasted (diver/deco_ascent_rate.hpp).
Asked ascent(const DiveData& d) {
  if (std::isnan(d.ascent_m_min)) return kAsBefore;
  const AlarmLevel kept =
      d.ascent_m_min > kCalmAscent * d.ascent_limits.dangerous_m_min
          ? AlarmLevel::kDanger
          : caution_if(d.ascent_m_min > kCalmAscent * d.ascent_limits.fast_m_min);
  return {static_cast<AlarmLevel>(d.ascent_alarm), kept};
}

Asked no_stop(const DiveData& d) {
  if (std::isnan(d.no_stop_min) || std::isnan(d.ceiling_m)) return kAsBefore;
  const bool without = !(d.ceiling_m > 0.0);
  return {caution_if(without && d.no_stop_min <= kLittleNoStop_min),
          caution_if(without && d.no_stop_min < kEnoughNoStop_min)};
}

}  // namespace

bool AlarmState::any() const {
  return std::ranges::any_of(level, [](AlarmLevel l) { return l != AlarmLevel::kOff; });
}

AlarmState step_alarms(const AlarmState& before, const DiveData& data, double seen_s) {
  const std::array<Asked, kAlarms> asked{link(data),   gas(data),    ceiling(data),
                                         oxygen(data), ascent(data), no_stop(data)};
  AlarmState after = before;
  for (std::size_t i = 0; i < kAlarms; ++i) {
    const AlarmLevel was = before.level[i];
    // A connection is no part of the scene's state, and its time is the listener's.
    const bool restored =
        data.time_s < before.scene_since_s[i] && static_cast<Alarm>(i) != Alarm::kLink;
    const double on_s = restored ? kLeastOn_s : seen_s - before.since_s[i];
    const AlarmLevel now = std::max(asked[i].begins, std::min(was, asked[i].kept));
    if (now > was) after.since_s[i] = seen_s, after.scene_since_s[i] = data.time_s;
    if (now < was && on_s >= 0.0 && on_s < kLeastOn_s) continue;
    after.level[i] = now;
  }
  return after;
}

const char* name_of(Alarm alarm) {
  constexpr const char* kNames[] = {"link", "gas", "ceiling", "oxygen", "ascent", "no_stop"};
  return kNames[static_cast<std::size_t>(alarm)];
}

const char* name_of(AlarmLevel level) {
  constexpr const char* kNames[] = {"off", "caution", "danger"};
  return kNames[static_cast<std::size_t>(level)];
}

}  // namespace neritic::hud
