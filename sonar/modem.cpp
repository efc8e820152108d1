#include "sonar/modem.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/random.hpp"

namespace neritic::sonar {
namespace {

constexpr std::uint64_t kModemStream = 0x6d6f64656dull;  // of random numbers

double range_of(const Vec3& from_ned_m, const Vec3& to_ned_m) {
  return glm::length(to_ned_m - from_ned_m);
}

double speed_at(const ModemWater& water, double depth_m) {
  if (water.profile) return water.profile->speed_m_s(depth_m);
  Water there = water.water;
  there.depth_m = std::clamp(depth_m, 0.0, 12000.0);
  return sound_speed_mackenzie_m_s(there);
}

// The time at which a ray of that launch has gone so far horizontally, and its depth there.
struct Reached {
  double time_s = 0.0, depth_m = 0.0;
};
Reached reach(const SoundSpeedProfile& profile, double depth_m, double elevation_rad,
              double level_m, double guess_s) {
  double time_s = guess_s;
  RayPoint at;
  for (int i = 0; i < 8; ++i) {
    at = profile.bent(depth_m, elevation_rad, time_s);
    const double rate_m_s = profile.speed_m_s(at.depth_m) * std::cos(at.elevation_rad);
    const double step_s = (level_m - at.horizontal_m) / std::max(rate_m_s, 1.0);
    time_s = std::max(time_s + step_s, 0.0);
    if (std::abs(step_s) < 1e-12) break;
  }
  return {time_s, at.depth_m};
}

struct Ray {
  double time_s = 0.0, elevation_rad = 0.0;  // as it leaves, up positive
};
// The ray from one place to the other, by secant steps over its elevation from the straight line's;
// the straight line where none is found (a shadow).
Ray bent_ray(const SoundSpeedProfile& profile, const Vec3& from_ned_m, const Vec3& to_ned_m,
             double straight_s) {
  const Vec3 line = to_ned_m - from_ned_m;
  const double level_m = std::hypot(line.x, line.y);
  const double straight_rad = std::atan2(-line.z, level_m);
  // Straight up or down nothing bends.
  if (level_m < 1e-3 * std::abs(line.z) || level_m < 1e-6) return {straight_s, straight_rad};
  const auto miss = [&](double elevation_rad, double& time_s) {
    const Reached at = reach(profile, from_ned_m.z, elevation_rad, level_m, straight_s);
    time_s = at.time_s;
    return at.depth_m - to_ned_m.z;
  };
  double time_s = straight_s;
  double a = straight_rad, miss_a = miss(a, time_s);
  double b = straight_rad + (miss_a > 0.0 ? 1e-3 : -1e-3), miss_b = miss(b, time_s);
  for (int i = 0; i < 24 && std::abs(miss_b) > 1e-6; ++i) {
    if (miss_b == miss_a) return {straight_s, straight_rad};
    const double next = std::clamp(b - miss_b * (b - a) / (miss_b - miss_a), -1.55, 1.55);
    a = b, miss_a = miss_b;
    b = next, miss_b = miss(b, time_s);
  }
  if (!(std::abs(miss_b) < 0.1 && std::isfinite(time_s))) return {straight_s, straight_rad};
  return {time_s, b};
}

double straight_time_s(const SoundSpeedProfile& profile, const Vec3& from_ned_m,
                       const Vec3& to_ned_m, double range_m) {
  const double elevation_rad =
      std::asin(std::clamp((from_ned_m.z - to_ned_m.z) / range_m, -1.0, 1.0));
  return profile.straight_time_s(from_ned_m.z, elevation_rad, range_m);
}

}  // namespace

double modem_travel_s(const ModemWater& water, const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const double range_m = range_of(from_ned_m, to_ned_m);
  if (!(range_m > 0.0)) return range_m;  // 0, or NaN
  if (water.path == ModemPath::kConstant || !water.profile)
    return range_m / speed_at(water, 0.5 * (from_ned_m.z + to_ned_m.z));
  const double straight_s = straight_time_s(*water.profile, from_ned_m, to_ned_m, range_m);
  if (water.path == ModemPath::kStraight) return straight_s;
  return bent_ray(*water.profile, from_ned_m, to_ned_m, straight_s).time_s;
}

Vec3 modem_arrival(const ModemWater& water, const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const Vec3 line = from_ned_m - to_ned_m;
  const double range_m = glm::length(line);
  if (!(range_m > 0.0)) return {0.0, 0.0, 1.0};
  const double level_m = std::hypot(line.x, line.y);
  if (water.path != ModemPath::kBent || !water.profile || level_m == 0.0) return line / range_m;
  // A ray goes the same way there and back.
  const double elevation_rad =
      bent_ray(*water.profile, to_ned_m, from_ned_m,
               straight_time_s(*water.profile, to_ned_m, from_ned_m, range_m))
          .elevation_rad;
  const double level = std::cos(elevation_rad) / level_m;
  return {level * line.x, level * line.y, -std::sin(elevation_rad)};
}

double modem_loss_db(const ModemWater& water, double frequency_hz, const Vec3& from_ned_m,
                     const Vec3& to_ned_m) {
  const double range_m = std::max(range_of(from_ned_m, to_ned_m), kNearestRange_m);
  Water between = water.water;
  between.depth_m = std::clamp(0.5 * (from_ned_m.z + to_ned_m.z), 0.0, 12000.0);
  const double absorption =
      absorption_db_m(AbsorptionModel::kFrancoisGarrison, between, frequency_hz);
  return 10.0 * water.spreading * std::log10(range_m) + absorption * range_m;
}

ModemBand modem_band(const ModemSettings& sender, const ModemSettings& receiver) {
  const auto low = [](const ModemSettings& m) { return m.frequency_hz - 0.5 * m.bandwidth_hz; };
  const auto high = [](const ModemSettings& m) { return m.frequency_hz + 0.5 * m.bandwidth_hz; };
  const double from_hz = std::max(low(sender), low(receiver));
  const double to_hz = std::min(high(sender), high(receiver));
  if (!(to_hz > from_hz)) return {};
  return {std::min((to_hz - from_hz) / sender.bandwidth_hz, 1.0), 0.5 * (from_hz + to_hz)};
}

std::optional<double> modem_level_db(const ModemWater& water, const ModemSettings& sender,
                                     const ModemSettings& receiver, const Vec3& from_ned_m,
                                     const Vec3& to_ned_m) {
  const ModemBand band = modem_band(sender, receiver);
  if (band.share == 0.0) return std::nullopt;
  return sender.source_level_db + db_from_power(band.share) -
         modem_loss_db(water, band.frequency_hz, from_ned_m, to_ned_m);
}

double modem_noise_db(const ModemWater& water, const ModemSettings& receiver) {
  const double ambient_db = ambient_noise_db(receiver.frequency_hz, water.wind_m_s, water.shipping);
  const double levels[] = {ambient_db, receiver.self_noise_db};
  const double spectrum_db = receiver.self_noise_db > 0.0 ? incoherent_sum_db(levels) : ambient_db;
  return band_level_db(spectrum_db, receiver.bandwidth_hz);
}

double modem_duration_s(const ModemSettings& sender, std::size_t bytes) {
  return sender.preamble_s + 8.0 * static_cast<double>(bytes) / sender.bit_rate_hz;
}

double modem_bit_error(const ModemSettings& sender, const ModemSettings& receiver, double snr_db) {
  const double g =
      power_from_db(snr_db + sender.coding_gain_db) * receiver.bandwidth_hz / sender.bit_rate_hz;
  return sender.fading || receiver.fading ? 1.0 / (2.0 + g) : 0.5 * std::exp(-0.5 * g);
}

double modem_success(const ModemSettings& sender, const ModemSettings& receiver, double snr_db,
                     std::size_t bytes) {
  return std::pow(1.0 - modem_bit_error(sender, receiver, snr_db),
                  8.0 * static_cast<double>(bytes));
}

namespace {

void report_event(ModemState& state, std::uint64_t ModemCounts::*count, const ModemReport& said) {
  state.reports[state.counts.all() % ModemState::kKept] = said;
  ++(state.counts.*count);
}

}  // namespace

bool send(const ModemChannel& channel, std::span<ModemState> states, std::size_t from,
          ModemMessage message, double now_s, const Vec3& from_ned_m) {
  ModemState& sender = states[from];
  const auto free = std::ranges::find(sender.flights, 0u, &ModemState::Flight::flying);
  const bool sending = std::ranges::any_of(sender.flights, [&](const ModemState::Flight& flight) {
    return flight.flying != 0 && flight.ends_s > now_s;
  });
  message.from = from;
  if (sending || free == sender.flights.end() || message.bytes == 0 ||
      message.bytes > 8 * kModemWords) {
    message.sequence = sender.counts.sent;
    report_event(sender, &ModemCounts::refused,
                 {ModemEvent::kRefused, message, now_s, now_s, now_s, 0.0});
    return false;
  }
  message.sequence = sender.counts.sent;
  report_event(sender, &ModemCounts::sent, {ModemEvent::kSent, message, now_s, now_s, now_s, 0.0});
  *free = {message,    now_s, now_s + modem_duration_s(channel.modems[from], message.bytes),
           from_ned_m, 1,     std::uint64_t{1} << from};
  // The rest of a message that was arriving is lost.
  for (ModemState::Hearing& hearing : sender.hearings)
    if (hearing.arriving != 0) hearing.sending = 1;
  return true;
}

namespace {

bool sends_within(const ModemState& state, double from_s, double to_s) {
  return std::ranges::any_of(state.flights, [&](const ModemState::Flight& flight) {
    return flight.flying != 0 && flight.sent_s < to_s && flight.ends_s > from_s;
  });
}

ModemMessage without_words(ModemMessage message) {
  message.words = {};
  return message;
}

// The message's first sound reaches the modem.
void begin_hearing(const ModemChannel& channel, std::size_t from, const ModemState::Flight& flight,
                   double begins_s, std::size_t to, const Vec3& to_ned_m, ModemState& state) {
  const bool for_it = flight.message.to == kToAll || flight.message.to == to;
  const auto lost = [&](std::uint64_t ModemCounts::*count, ModemEvent event) {
    if (for_it)
      report_event(state, count,
                   {event, without_words(flight.message), begins_s, flight.sent_s, begins_s, 0.0});
  };
  const bool in_water = flight.from_ned_m.z >= 0.0 && to_ned_m.z >= 0.0;
  const std::optional<double> level_db =
      in_water ? modem_level_db(channel.water, channel.modems[from], channel.modems[to],
                                flight.from_ned_m, to_ned_m)
               : std::nullopt;
  // A sound that is not heard at all does not disturb others either.
  if (!level_db) return lost(&ModemCounts::too_weak, ModemEvent::kTooWeak);
  const auto free = std::ranges::find(state.hearings, 0u, &ModemState::Hearing::arriving);
  // More at once than any receiver keeps apart.
  if (free == state.hearings.end()) return lost(&ModemCounts::collided, ModemEvent::kCollided);
  const double ends_s = begins_s + flight.ends_s - flight.sent_s;
  ModemState::Hearing now{.message = flight.message,
                          .sent_s = flight.sent_s,
                          .begins_s = begins_s,
                          .ends_s = ends_s,
                          .power = power_from_db(*level_db),
                          .arriving = 1,
                          .from_ned_m = flight.from_ned_m,
                          .to_ned_m = to_ned_m};
  now.sending = sends_within(state, begins_s, ends_s) ? 1 : 0;
  // All that overlap disturb each other, with the most power at once.
  const auto overlaps = [&](const ModemState::Hearing& other) {
    return other.arriving != 0 && other.begins_s < ends_s && other.ends_s > begins_s;
  };
  double others = 0.0;
  for (const ModemState::Hearing& other : state.hearings)
    if (overlaps(other)) others += other.power;
  now.others_power = others;
  for (ModemState::Hearing& other : state.hearings)
    if (overlaps(other))
      other.others_power = std::max(other.others_power, others - other.power + now.power);
  *free = now;
}

// The message's last bit has come.
void end_hearing(const ModemChannel& channel, std::size_t to, ModemState::Hearing& hearing,
                 ModemState& state) {
  hearing.arriving = 0;
  const ModemMessage& message = hearing.message;
  if (message.to != kToAll && message.to != to) return;  // others' messages only disturb
  const ModemSettings &sender = channel.modems[message.from], &receiver = channel.modems[to];
  const double noise = power_from_db(modem_noise_db(channel.water, receiver));
  const double alone_db = db_from_power(hearing.power / noise);
  const double snr_db = db_from_power(hearing.power / (noise + hearing.others_power));
  const auto lost = [&](std::uint64_t ModemCounts::*count, ModemEvent event) {
    report_event(
        state, count,
        {event, without_words(message), hearing.ends_s, hearing.sent_s, hearing.begins_s, 0.0});
  };
  if (hearing.sending != 0) return lost(&ModemCounts::was_sending, ModemEvent::kWasSending);
  if (!(alone_db >= receiver.detection_db))
    return lost(&ModemCounts::too_weak, ModemEvent::kTooWeak);
  const std::size_t bytes = static_cast<std::size_t>(message.bytes);
  const double draw =
      random_uniform({channel.seed, kModemStream + message.from, message.sequence}, to);
  const bool got =
      snr_db >= receiver.detection_db && draw < modem_success(sender, receiver, snr_db, bytes);
  if (!got) {
    // Without the others it would have come.
    const bool by_others = draw < modem_success(sender, receiver, alone_db, bytes);
    return by_others ? lost(&ModemCounts::collided, ModemEvent::kCollided)
                     : lost(&ModemCounts::noisy, ModemEvent::kNoisy);
  }
  report_event(
      state, &ModemCounts::received,
      {ModemEvent::kReceived, message, hearing.ends_s, hearing.sent_s, hearing.begins_s, snr_db});
}

}  // namespace

void step(const ModemChannel& channel, std::span<ModemState> states,
          std::span<const Vec3> positions_ned_m, double from_s, double to_s) {
  const std::size_t count = channel.modems.size();
  NERITIC_CHECK(count <= kMostModems && states.size() == count && positions_ned_m.size() == count,
                "{} modems, {} states, {} positions", count, states.size(), positions_ned_m.size());
  for (std::size_t from = 0; from < count; ++from)
    for (ModemState::Flight& flight : states[from].flights) {
      if (flight.flying == 0) continue;
      for (std::size_t to = 0; to < count; ++to) {
        if ((flight.begun >> to & 1) != 0) continue;
        const double begins_s =
            flight.sent_s + modem_travel_s(channel.water, flight.from_ned_m, positions_ned_m[to]);
        if (begins_s > to_s) continue;
        flight.begun |= std::uint64_t{1} << to;
        // A receiver that came nearer hears it now, not before; one beside a modem that answered
        // within the last step may have heard it in that step.
        const bool answered = flight.sent_s > from_s - (to_s - from_s);
        const double earliest_s = answered ? std::min(flight.sent_s, from_s) : from_s;
        begin_hearing(channel, from, flight, std::max(begins_s, std::min(earliest_s, to_s)), to,
                      positions_ned_m[to], states[to]);
      }
      const std::uint64_t all = count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
      if (flight.begun == all && flight.ends_s <= to_s) flight.flying = 0;
    }
  for (std::size_t to = 0; to < count; ++to)
    for (ModemState::Hearing& hearing : states[to].hearings)
      if (hearing.arriving != 0 && hearing.ends_s <= to_s)
        end_hearing(channel, to, hearing, states[to]);
}

const ModemState::Hearing* heard_as(const ModemState& state, const ModemReport& report) {
  const auto hearing = std::ranges::find_if(state.hearings, [&](const ModemState::Hearing& one) {
    return one.arriving == 0 && one.ends_s == report.at_s && one.begins_s == report.heard_s &&
           one.message.from == report.message.from &&
           one.message.sequence == report.message.sequence;
  });
  return hearing == state.hearings.end() ? nullptr : &*hearing;
}

std::uint64_t first_kept(const ModemState& state, std::uint64_t seen) {
  const std::uint64_t all = state.counts.all();
  const std::uint64_t oldest = all > ModemState::kKept ? all - ModemState::kKept : 0;
  return std::clamp(seen, oldest, all);
}

}  // namespace neritic::sonar
