#include "testbed/simulation/modems.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/random.hpp"
#include "engine/core/text.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint64_t kRangingStream = 0x72616e67696e67ull;  // of random numbers
constexpr std::uint64_t kRangingBytes = 1, kAnswerBytes = 2;
constexpr std::uint64_t kNoRequest = ~std::uint64_t{0};

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
  }
  for (std::size_t i = 0; i < out.all_.size(); ++i)
    if (out.all_[i].ranging) NERITIC_TRY_STATUS(out.check_ranging(scene.path, i));
  return out;
}

double Modems::request_s(std::size_t modem) const {
  return sonar::modem_duration_s(settings_[modem], kRangingBytes);
}
double Modems::answer_s(std::size_t modem) const {
  return sonar::modem_duration_s(settings_[all_[modem].target], kAnswerBytes);
}
double Modems::wait_s(std::size_t modem) const {
  const scene::Ranging& ranging = *all_[modem].ranging;
  return ranging.wait_s.value_or(ranging.interval_s);
}

Status Modems::check_ranging(const std::string& path, std::size_t index) const {
  const PhysicsModem &modem = all_[index], &target = all_[modem.target];
  const auto refused = [&](std::string_view whose, std::string_view key, double found, double least,
                           const std::string& why) {
    return bad_input("{}: {}: modem.{}: found {:g}; accepted: {} {:g}, {}", path, whose, key, found,
                     key == "turnaround_s" ? "from" : "more than", least, why);
  };
  // An answer leaves when the request is whole: a shorter turnaround would lengthen the range.
  if (target.turnaround_s < request_s(index))
    return refused(target.name, "turnaround_s", target.turnaround_s, request_s(index),
                   modem.name + "'s request");
  // While it sends it hears nothing.
  const double busy_s = request_s(index) + answer_s(index);
  if (!(modem.ranging->interval_s > busy_s))
    return refused(modem.name, "usbl.interval_s", modem.ranging->interval_s, busy_s,
                   "its request and " + target.name + "'s answer");
  const double back_s = target.turnaround_s + answer_s(index);
  if (!(wait_s(index) > back_s))
    return refused(modem.name, modem.ranging->wait_s ? "usbl.wait_s" : "usbl.interval_s",
                   wait_s(index), back_s,
                   fmt::format("{}'s turnaround_s and its answer{}", target.name,
                               modem.ranging->wait_s ? "" : ", or a longer wait_s"));
  const sonar::ModemBand there = sonar::modem_band(settings_[index], settings_[modem.target]);
  if (there.share == 0.0)
    return bad_input(
        "{}: {}: modem.frequency_hz: found {:g}, {:g} wide; accepted: a band that {} hears: "
        "{:g}, {:g} wide",
        path, modem.name, settings_[index].frequency_hz, settings_[index].bandwidth_hz, target.name,
        settings_[modem.target].frequency_hz, settings_[modem.target].bandwidth_hz);
  return {};
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

bool Modems::say(const Call& call, std::size_t modem, sonar::ModemMessage message,
                 double at_s) const {
  // Within the step it has gone a part of its way.
  const double share = (at_s - call.from_s) / (call.to_s - call.from_s);
  Vec3 from = position_ned_m(modem, call.before, call.from_s);
  if (share > 0.0)
    from += std::min(share, 1.0) * (position_ned_m(modem, call.after, call.to_s) - from);
  return sonar::send(call.channel, call.after.modems(), modem, message, at_s, from);
}

void Modems::send_asked(const Call& call, std::size_t index) const {
  const ModemInputs& asked = call.inputs.modems()[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  // With the request, answers and messages that come in a step.
  static_assert(ModemQueue::kInStep + 1 + 2 * ModemTasks::kOwed + sonar::ModemState::kHearing <=
                sonar::ModemState::kKept);
  const std::uint64_t end = std::min(asked.asked, tasks.sent + ModemQueue::kInStep);
  for (; tasks.sent < end; ++tasks.sent) {
    const ModemSend& said = asked.messages[tasks.sent % ModemQueue::kMost];
    sonar::ModemMessage message;
    message.to = said.to == 0 ? sonar::kToAll : said.to - 1;
    // To no modem or to itself: refused.
    const bool nobody = said.to > all_.size() || said.to == index + 1;
    message.bytes = nobody ? 0 : said.bytes;
    for (std::size_t i = 0; i < said.words.size(); ++i)
      message.words[i / 2] |= std::uint64_t{said.words[i]} << (32 * (i % 2));
    say(call, index, message, call.from_s);
  }
}

namespace {

void miss(ModemTasks& tasks, ModemTasks::Request& request, double at_s) {
  request.waits = 0;
  ++tasks.misses;
  tasks.fix.value = {};
  tasks.fix.time_s = at_s;
  ++tasks.fix.count;
}

}  // namespace

// Answers leave at their instant, be it before the step's end.
void Modems::send_answers(const Call& call, std::size_t index) const {
  for (ModemTasks::Answer& owed : call.after.modem_tasks()[index].answers) {
    if (owed.owed == 0 || owed.at_s >= call.to_s) continue;
    owed.owed = 0;
    sonar::ModemMessage answer;
    answer.kind = sonar::ModemKind::kAnswer;
    answer.to = owed.to;
    answer.bytes = kAnswerBytes;
    answer.words[0] = owed.number;
    // While the modem sends it is refused, and counted: its asker misses it.
    say(call, index, answer, std::max(owed.at_s, call.from_s));
  }
}

// The request that is due.
void Modems::range(const Call& call, std::size_t index) const {
  const PhysicsModem& modem = all_[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  if (!modem.ranging) return;
  const double due_s =
      modem.ranging->offset_s + static_cast<double>(tasks.asks) * modem.ranging->interval_s;
  if (call.from_s < due_s) return;
  ++tasks.asks;
  auto request = std::ranges::find(tasks.requests, 0u, &ModemTasks::Request::waits);
  if (request == tasks.requests.end()) {
    request = std::ranges::min_element(tasks.requests, {}, &ModemTasks::Request::asked_s);
    miss(tasks, *request, call.from_s);
  }
  sonar::ModemMessage message;
  message.kind = sonar::ModemKind::kRequest;
  message.to = modem.target;
  message.bytes = kRangingBytes;
  *request = {1, call.after.modems()[index].counts.sent, call.from_s};
  // While the modem sends no request leaves: no answer has its number.
  if (!say(call, index, message, call.from_s)) request->number = kNoRequest;
}

// Range by the travel there and back, direction by the phase of the arriving answer, both with
// their noise; the place is from where the answer's first sound was heard.
void Modems::take_answer(const Call& call, std::size_t index,
                         const sonar::ModemReport& answer) const {
  const PhysicsModem& modem = all_[index];
  ModemTasks& tasks = call.after.modem_tasks()[index];
  const auto request = std::ranges::find_if(tasks.requests, [&](const ModemTasks::Request& asked) {
    return asked.waits != 0 && asked.number == answer.message.words[0];
  });
  if (request == tasks.requests.end()) return;  // too late: a miss already
  const sonar::ModemState::Hearing* hearing = sonar::heard_as(call.after.modems()[index], answer);
  NERITIC_CHECK(hearing != nullptr, "{}: an answer that was not heard", modem.name);
  const Vec3& here = hearing->to_ned_m;
  const Vec3 line = sonar::modem_arrival(water_, hearing->from_ned_m, here);
  const double level = std::hypot(line.x, line.y);
  const auto error = [&](std::uint64_t i) {
    return random_normal({call.channel.seed, kRangingStream + index, tasks.fix.count}, i);
  };
  rov::UsblReading fix;
  fix.heard = 1;
  fix.travel_s = answer.heard_s - request->asked_s - all_[modem.target].turnaround_s;
  const double sound_m_s = modem.ranging->sound_m_s.value_or(
      1.0 / sonar::modem_travel_s(water_, here, here + Vec3(1.0, 0.0, 0.0)));
  fix.range_m =
      std::max(0.5 * fix.travel_s * sound_m_s + modem.ranging->range_noise_m * error(0), 0.0);
  // Both errors are angles of the line of sight: a bearing turns less where it points down.
  const double across = modem.ranging->direction_noise_rad * error(1);
  const double bearing = level > 0.0 ? std::atan2(line.y, line.x) : 0.0;
  fix.bearing_rad = std::remainder(bearing + across / std::max(level, 1e-3), 2.0 * kPi);
  fix.elevation_rad = std::atan2(line.z, level) + modem.ranging->direction_noise_rad * error(2);
  const double flat = fix.range_m * std::cos(fix.elevation_rad);
  fix.position_ned_m =
      here + Vec3(flat * std::cos(fix.bearing_rad), flat * std::sin(fix.bearing_rad),
                  fix.range_m * std::sin(fix.elevation_rad));
  request->waits = 0;
  ++tasks.fixes;
  tasks.fix.value = fix;
  tasks.fix.time_s = answer.at_s;
  ++tasks.fix.count;
}

// The oldest request whose answer did not come in time; one reading a step, so that each is seen.
void Modems::miss_overdue(const Call& call, std::size_t index) const {
  ModemTasks& tasks = call.after.modem_tasks()[index];
  if (!all_[index].ranging || tasks.fix.count != call.before.modem_tasks()[index].fix.count) return;
  ModemTasks::Request* oldest = nullptr;
  for (ModemTasks::Request& request : tasks.requests)
    if (request.waits != 0 && request.asked_s + wait_s(index) <= call.to_s &&
        (oldest == nullptr || request.asked_s < oldest->asked_s))
      oldest = &request;
  if (oldest != nullptr) miss(tasks, *oldest, call.to_s);
}

// Handles what came in: requests are to be answered, answers become ranges.
void Modems::look(const Call& call, std::size_t index) const {
  ModemTasks& tasks = call.after.modem_tasks()[index];
  const sonar::ModemState& state = call.after.modems()[index];
  for (std::uint64_t k = sonar::first_kept(state, tasks.looked); k < state.counts.all(); ++k) {
    const sonar::ModemReport& report = state.reports[k % sonar::ModemState::kKept];
    if (report.event != sonar::ModemEvent::kReceived) continue;
    if (report.message.kind == sonar::ModemKind::kRequest) {
      const auto free = std::ranges::find(tasks.answers, 0u, &ModemTasks::Answer::owed);
      if (free == tasks.answers.end())
        ++tasks.unanswered;
      else
        *free = {1, report.message.from, report.message.sequence,
                 report.heard_s + all_[index].turnaround_s};
    } else if (report.message.kind == sonar::ModemKind::kAnswer && all_[index].ranging &&
               report.message.from == all_[index].target) {
      take_answer(call, index, report);
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
    send_answers(call, i);
    range(call, i);
    send_asked(call, i);
    places[i] = position_ned_m(i, after, to_s);
  }
  sonar::step(call.channel, after.modems(), std::span(places).first(all_.size()), from_s, to_s);
  for (std::size_t i = 0; i < all_.size(); ++i) look(call, i);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    send_answers(call, i);  // those whose turnaround ended in the step in which the request came
    miss_overdue(call, i);
  }
}

}  // namespace neritic::testbed
