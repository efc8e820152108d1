#include "testbed/simulation/modems.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/random.hpp"
#include "engine/core/text.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint64_t kRangingStream = 0x72616e67696e67ull;  // of random numbers
constexpr std::uint64_t kRangingBytes = 1, kAnswerBytes = 2;

sonar::ModemSettings settings_of(const scene::Modem& modem) {
  return {.source_level_db = modem.source_level_db,
          .frequency_hz = modem.frequency_hz,
          .bandwidth_hz = modem.bandwidth_hz,
          .bit_rate_hz = modem.bit_rate_hz,
          .preamble_s = modem.preamble_s,
          .coding_gain_db = modem.coding_gain_db,
          .detection_db = modem.detection_db,
          .self_noise_db = modem.self_noise_db,
          .fading = modem.fading};
}

Result<sonar::ModemWater> water_of(const scene::Acoustics& said) {
  sonar::ModemWater water;
  water.water.temperature_c = said.temperature_c;
  water.water.salinity_psu = said.salinity_psu;
  water.water.ph = said.ph;
  if (!said.profile.empty()) {
    NERITIC_TRY(water.profile, sonar::SoundSpeedProfile::of_table(said.profile));
  }
  water.path = said.path == scene::Acoustics::Path::kConstant ? sonar::ModemPath::kConstant
               : said.path == scene::Acoustics::Path::kBent   ? sonar::ModemPath::kBent
                                                              : sonar::ModemPath::kStraight;
  water.spreading = said.spreading;
  water.wind_m_s = said.wind_m_s;
  water.shipping = said.shipping;
  return water;
}

// Numbers of modems in samples count from 1; 0 is all.
std::uint64_t said_number(std::uint64_t modem) {
  return modem == sonar::kToAll ? 0 : modem + 1;
}

}  // namespace

ModemReading modem_reading(const sonar::ModemReport& report) {
  // Samples do not know sonar/: both lists have the same order.
  static_assert(static_cast<int>(ModemEvent::kWasSending) ==
                static_cast<int>(sonar::ModemEvent::kWasSending));
  static_assert(static_cast<int>(ModemKind::kAnswer) ==
                static_cast<int>(sonar::ModemKind::kAnswer));
  const sonar::ModemMessage& message = report.message;
  ModemReading reading{.event = static_cast<ModemEvent>(report.event),
                       .kind = static_cast<ModemKind>(message.kind),
                       .from = message.from + 1,
                       .to = said_number(message.to),
                       .number = message.sequence,
                       .bytes = message.bytes,
                       .sent_s = report.sent_s,
                       .heard_s = report.heard_s,
                       .snr_db = report.snr_db};
  for (std::size_t i = 0; i < reading.words.size(); ++i)
    reading.words[i] = static_cast<std::uint32_t>(message.words[i / 2] >> (32 * (i % 2)));
  return reading;
}

Result<Modems> Modems::create(const scene::Scene& scene, const Movers& movers) {
  Modems out;
  for (const scene::Modem& said : scene.modems) {
    const auto i = static_cast<std::size_t>(said.object);
    const scene::Object& object = scene.objects[i];
    const int vehicle = movers.vehicle_of_object[i], human = movers.human_of_object[i];
    const int owner = vehicle >= 0 ? vehicle : human >= 0 ? human : movers.tracked_of_object[i];
    PhysicsModem modem{.name = object.name,
                       .sort = vehicle >= 0 ? OwnerSort::kVehicle
                               : human >= 0 ? OwnerSort::kDiver
                                            : OwnerSort::kObject,
                       .owner = static_cast<std::uint32_t>(owner),
                       .position_m = rov::ned_from_world(said.position_m),
                       .object = Place(scene, {.object = static_cast<int>(said.object)}, movers),
                       .turnaround_s = said.turnaround_s,
                       .ranging = said.usbl};
    out.all_.push_back(std::move(modem));
    out.settings_.push_back(settings_of(said));
  }
  if (out.all_.empty()) return out;
  if (out.all_.size() > sonar::kMostModems)
    return bad_input("{}: {} modems; accepted: up to {}", scene.path, out.all_.size(),
                     sonar::kMostModems);
  NERITIC_TRY(out.water_, water_of(scene.acoustics.value_or(scene::Acoustics{})));
  for (std::size_t i = 0; i < out.all_.size(); ++i) {
    PhysicsModem& modem = out.all_[i];
    if (!modem.ranging) continue;
    const auto target = std::ranges::find_if(out.all_, [&](const PhysicsModem& other) {
      return other.name == modem.ranging->target && &other != &modem;
    });
    if (target == out.all_.end()) {
      std::string names;
      for (const PhysicsModem& other : out.all_)
        if (&other != &modem) names += (names.empty() ? "" : ", ") + other.name;
      return bad_input("{}: {}: modem.usbl.target: found '{}'; accepted: {}", scene.path,
                       modem.name, printable(modem.ranging->target),
                       names.empty() ? "another object with a modem: there is none" : names);
    }
    modem.target = static_cast<std::size_t>(target - out.all_.begin());
    // An answer leaves when the request is whole: a shorter turnaround would lengthen the range.
    const double request_s = sonar::modem_duration_s(out.settings_[i], kRangingBytes);
    if (target->turnaround_s < request_s)
      return bad_input(
          "{}: {}: modem.turnaround_s: found {:g}; accepted: {:g} or more, {}'s request",
          scene.path, target->name, target->turnaround_s, request_s, modem.name);
  }
  return out;
}

std::optional<std::size_t> Modems::find(OwnerSort sort, std::uint32_t owner) const {
  const auto at = std::ranges::find_if(
      all_, [&](const PhysicsModem& modem) { return modem.sort == sort && modem.owner == owner; });
  if (at == all_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - all_.begin());
}

ModemSort Modems::sort_of(OwnerSort sort, std::uint32_t owner) const {
  const auto modem = find(sort, owner);
  if (!modem) return ModemSort::kNone;
  return all_[*modem].ranging ? ModemSort::kRanges : ModemSort::kTalks;
}

Vec3 Modems::position_ned_m(std::size_t index, const PhysicsState& state, double time_s) const {
  const PhysicsModem& modem = all_[index];
  if (modem.sort == OwnerSort::kVehicle) {
    const rov::State& body = state.vehicles()[modem.owner].body;
    return body.position_ned_m + body.attitude * modem.position_m;
  }
  if (modem.sort == OwnerSort::kDiver) {
    const diver::RootState& root = state.humans()[modem.owner].human.root;
    return root.position_ned_m + root.attitude * modem.position_m;
  }
  const Pose pose = modem.object.at(state, time_s);
  return rov::ned_from_world(pose.position_m) +
         rov::ned_from_world(pose.rotation) * modem.position_m;
}

struct Modems::Call {
  sonar::ModemChannel channel;
  const PhysicsState& before;
  const PhysicsInputs& inputs;
  double from_s = 0.0, to_s = 0.0;
  PhysicsState& after;
};

void Modems::say(const Call& call, std::size_t modem, sonar::ModemMessage message,
                 double at_s) const {
  sonar::send(call.channel, call.after.modems(), modem, message, at_s,
              position_ned_m(modem, call.before, call.from_s));
}

void Modems::send_asked(const Call& call, std::size_t index) const {
  const ModemInputs& asked = call.inputs.modems()[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  // With the requests, answers and messages that come in a step.
  static_assert(ModemQueue::kInStep + 2 + sonar::ModemState::kHearing <= sonar::ModemState::kKept);
  const std::uint64_t end = std::min(asked.asked, tasks.sent + ModemQueue::kInStep);
  for (; tasks.sent < end; ++tasks.sent) {
    const ModemSend& said = asked.messages[tasks.sent % ModemQueue::kMost];
    sonar::ModemMessage message;
    message.to = said.to == 0 ? sonar::kToAll : said.to - 1;
    message.bytes = said.to <= all_.size() ? said.bytes : 0;  // to no modem: refused
    for (std::size_t i = 0; i < said.words.size(); ++i)
      message.words[i / 2] |= std::uint64_t{said.words[i]} << (32 * (i % 2));
    say(call, index, message, call.from_s);
  }
}

// The request that is due; the one before it, if it has no answer yet, will have none.
void Modems::range(const Call& call, std::size_t index) const {
  const PhysicsModem& modem = all_[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  if (!modem.ranging || call.from_s < static_cast<double>(tasks.asks) * modem.ranging->interval_s)
    return;
  ++tasks.asks;
  if (tasks.waits != 0) {
    tasks.fix.value = {};
    tasks.fix.time_s = call.from_s;
    ++tasks.fix.count;
  }
  sonar::ModemMessage message;
  message.kind = sonar::ModemKind::kRequest;
  message.to = modem.target;
  message.bytes = kRangingBytes;
  tasks.waits = 1;  // refused while it sends: no answer comes either
  tasks.asked_s = call.from_s;
  tasks.asked_number = call.after.modems()[index].counts.sent;
  say(call, index, message, call.from_s);
}

// Range by the travel there and back, direction by phase, both with their noise.
void Modems::fix(const Call& call, std::size_t index, const sonar::ModemReport& answer) const {
  const PhysicsModem& modem = all_[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  const Vec3 here = position_ned_m(index, call.after, call.to_s);
  const Vec3 line = position_ned_m(modem.target, call.after, call.to_s) - here;
  const double distance = glm::length(line), level = std::hypot(line.x, line.y);
  const auto error = [&](std::uint64_t i) {
    return random_normal({call.channel.seed, kRangingStream + index, tasks.fix.count}, i);
  };
  rov::UsblReading fix;
  fix.heard = 1;
  fix.travel_s = answer.heard_s - tasks.asked_s - all_[modem.target].turnaround_s;
  const double sound_m_s = modem.ranging->sound_m_s.value_or(
      1.0 / sonar::modem_travel_s(water_, here, here + Vec3(1.0, 0.0, 0.0)));
  fix.range_m =
      std::max(0.5 * fix.travel_s * sound_m_s + modem.ranging->range_noise_m * error(0), 0.0);
  // Both errors are angles of the line of sight: a bearing turns less where it points down.
  const double across = modem.ranging->direction_noise_rad * error(1);
  const double bearing = level > 0.0 ? std::atan2(line.y, line.x) : 0.0;
  fix.bearing_rad = std::remainder(
      bearing + across * distance / std::max(level, 1e-3 * distance + 1e-12), 2.0 * kPi);
  fix.elevation_rad = std::atan2(line.z, level) + modem.ranging->direction_noise_rad * error(2);
  const double flat = fix.range_m * std::cos(fix.elevation_rad);
  fix.position_ned_m =
      here + Vec3(flat * std::cos(fix.bearing_rad), flat * std::sin(fix.bearing_rad),
                  fix.range_m * std::sin(fix.elevation_rad));
  tasks.fix.value = fix;
  tasks.fix.time_s = answer.at_s;
  ++tasks.fix.count;
  tasks.waits = 0;
}

// Handles what came in: requests are answered, answers become ranges.
void Modems::look(const Call& call, std::size_t index) const {
  ModemTasks& tasks = call.after.modem_tasks()[index];
  const sonar::ModemState& state = call.after.modems()[index];
  for (std::uint64_t k = sonar::first_kept(state, tasks.looked); k < state.counts.all(); ++k) {
    const sonar::ModemReport& report = state.reports[k % sonar::ModemState::kKept];
    if (report.event != sonar::ModemEvent::kReceived) continue;
    if (report.message.kind == sonar::ModemKind::kRequest) {
      tasks.answers = 1;
      tasks.answer_to = report.message.from;
      tasks.answer_number = report.message.sequence;
      tasks.answer_at_s = report.heard_s + all_[index].turnaround_s;
    } else if (report.message.kind == sonar::ModemKind::kAnswer && tasks.waits != 0 &&
               all_[index].ranging && report.message.from == all_[index].target &&
               report.message.words[0] == tasks.asked_number) {
      fix(call, index, report);
    }
  }
  tasks.looked = state.counts.all();
}

void Modems::step(const PhysicsState& before, const PhysicsInputs& inputs,
                  const sim::StepTime& time, std::uint64_t seed, PhysicsState& after) const {
  const double from_s = time.time_s();
  const double to_s = static_cast<double>(time.step + 1) * time.step_s;
  const Call call{{water_, settings_, seed}, before, inputs, from_s, to_s, after};
  std::array<Vec3, sonar::kMostModems> places;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    ModemTasks& tasks = after.modem_tasks()[i];
    if (tasks.answers != 0 && tasks.answer_at_s < to_s) {
      tasks.answers = 0;
      sonar::ModemMessage answer;
      answer.kind = sonar::ModemKind::kAnswer;
      answer.to = tasks.answer_to;
      answer.bytes = kAnswerBytes;
      answer.words[0] = tasks.answer_number;
      say(call, i, answer, std::max(tasks.answer_at_s, from_s));
    }
    range(call, i);
    send_asked(call, i);
    places[i] = position_ned_m(i, after, to_s);
  }
  sonar::step(call.channel, after.modems(), std::span(places).first(all_.size()), from_s, to_s);
  for (std::size_t i = 0; i < all_.size(); ++i) look(call, i);
}

}  // namespace neritic::testbed
