// Commands of a World: a sample of a client, and the authority that lets it act.
#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "testbed/world/ros_samples.hpp"
#include "testbed/world/world_parts.hpp"

namespace neritic::testbed {
namespace {

Status check_finite(const std::string& where, std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      return refusal(where, fmt::format("{} at place {}", values[i], i), "finite numbers");
  return {};
}

Status check_count(const std::string& where, std::size_t found, std::size_t least,
                   std::size_t most) {
  if (found >= least && found <= most) return {};
  return refusal(where, fmt::format("{} numbers", found),
                 least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most));
}

// Beyond these no vehicle is and no thruster pushes: a wrong unit, or a number that was never set.
constexpr double kMost_m_s = 100.0;

Status check_most(const std::string& where, std::span<const double> values, double most,
                  const char* unit) {
  for (const double value : values)
    if (std::abs(value) > most)
      return refusal(where, fmt::format("{} {}", value, unit),
                     fmt::format("{} to {} {}", -most, most, unit));
  return {};
}

// The choices of a gripper or a regulator.
Status check_choices(const std::string& where, std::span<const double> values) {
  for (const double value : values)
    if (value != 0.0 && value != 1.0 && value != 2.0)
      return refusal(where, fmt::format("{}", value), "0, 1 or 2");
  return {};
}

Result<WantedPayload> vehicle_command(const PhysicsVehicle& vehicle, const std::string& where,
                                      const std::string& kind, std::span<const double> given) {
  std::vector<double> values(given.begin(), given.end());
  const std::size_t thrusters = vehicle.vehicle.thruster_count;
  if (kind == "goto") {
    NERITIC_TRY_STATUS(check_count(where, values.size() == 7 ? 4 : values.size(), 4, 4));
    NERITIC_TRY_STATUS(check_most(where, std::span(values).first(3), kFarthest_m, "m"));
    NERITIC_TRY_STATUS(check_most(where, std::span(values).subspan(4), kMost_m_s, "m/s"));
    const double yaw = values[3];
    values.erase(values.begin() + 3);
    values.resize(6, 0.0);
    values.push_back(yaw);
    return WantedPayload{PayloadKind::kSetpoint, values};
  }
  if (kind == "velocity") {
    NERITIC_TRY_STATUS(check_count(where, values.size(), 4, 4));
    NERITIC_TRY_STATUS(check_most(where, std::span(values).first(3), kMost_m_s, "m/s"));
    NERITIC_TRY_STATUS(check_most(where, std::span(values).last(1), kMost_m_s, "rad/s"));
    return WantedPayload{PayloadKind::kVelocity, values};
  }
  if (kind == "wrench") {
    NERITIC_TRY_STATUS(check_count(where, values.size(), 6, 6));
    NERITIC_TRY_STATUS(check_most(where, values, kStrongest, "N or N m"));
    return WantedPayload{PayloadKind::kWrench, values};
  }
  NERITIC_TRY_STATUS(check_count(where, values.size(), thrusters, thrusters));
  if (kind == "pwm") {
    if (!vehicle.file.curve)
      return refusal(where, vehicle.name + ", whose file names no thrust table",
                     "a vehicle with one, or 'thrusters' in N");
    for (double& value : values)
      value = vehicle.file.curve->thrust_n(value, vehicle.file.voltage_v);
  }
  if (kind == "thrusters") NERITIC_TRY_STATUS(check_most(where, values, kStrongest, "N"));
  values.resize(rov::kMaxThrusters, 0.0);
  return WantedPayload{kind == "faults" ? PayloadKind::kFault : PayloadKind::kThrusters, values};
}

constexpr std::array kVehicleCommands{"goto", "velocity", "wrench", "thrusters", "pwm", "faults"};
constexpr std::array kDiverCommands{
    std::pair("buttons", PayloadKind::kButtons),  std::pair("joints", PayloadKind::kBodyJoints),
    std::pair("hands", PayloadKind::kHandJoints), std::pair("hand_poses", PayloadKind::kHandPoses),
    std::pair("head", PayloadKind::kHeadPose),    std::pair("gaze", PayloadKind::kGaze),
    std::pair("breath", PayloadKind::kBreath),    std::pair("heart", PayloadKind::kHeart),
    std::pair("gas", PayloadKind::kGas)};

Result<WantedPayload> diver_command(const std::string& where, const std::string& kind,
                                    std::span<const double> given) {
  std::vector<double> values(given.begin(), given.end());
  const auto found =
      std::ranges::find_if(kDiverCommands, [&](const auto& c) { return kind == c.first; });
  if (found == kDiverCommands.end()) {
    std::vector<std::string> names;
    for (const auto& command : kDiverCommands) names.emplace_back(command.first);
    return unknown_name(where, kind, names);
  }
  const std::size_t count = ros::value_count(found->second);
  // Joints without the power beside them, as the swimmer's.
  const bool joints = found->second == PayloadKind::kBodyJoints;
  NERITIC_TRY_STATUS(check_count(where, values.size(), joints ? count - 1 : count, count));
  values.resize(count, 0.0);
  return WantedPayload{found->second, values};
}

// A tank that the diver has.
Status check_tank(const PhysicsHuman& human, const std::string& where, double value) {
  const auto tanks = static_cast<double>(human.body.tank_count);
  if (value >= 0.0 && value < tanks && value == std::floor(value)) return {};
  return refusal(where, fmt::format("{}", value),
                 tanks > 0.0 ? fmt::format("a tank's number, 0 to {}", tanks - 1.0)
                             : std::string("a diver with tanks"));
}

Result<WantedPayload> object_command(const PhysicsObject& object, const std::string& where,
                                     const std::string& kind, std::span<const double> given) {
  if (kind == "joints" && object.limbs) return diver_command(where, kind, given);
  if (kind == "joints")
    return refusal(where, "an object without limbs", "one whose model has the 16 nodes of a diver");
  if (kind != "pose")
    return object.limbs ? unknown_name(where, kind, {"pose", "joints"})
                        : unknown_name(where, kind, {"pose"});
  std::vector<double> values(given.begin(), given.end());
  if (values.size() != 7) NERITIC_TRY_STATUS(check_count(where, values.size(), 7, 13));
  if (values.size() != 7 && values.size() != 13)
    return refusal(where, fmt::format("{} numbers", values.size()), "7 or 13");
  const double measured = values.size() == 13 ? 1.0 : 0.0;
  values.resize(13, 0.0);
  values.push_back(measured);
  return WantedPayload{PayloadKind::kObjectPose, values};
}

// A message of bytes.
Result<ModemSend> message_of(const std::string& where, std::uint64_t by, std::uint64_t modems,
                             std::span<const double> values) {
  if (values.empty()) return refusal(where, "no number of a modem", "one, and its bytes after it");
  if (values.size() < 2 || values.size() > kModemBytes + 1)
    return refusal(where, fmt::format("{} bytes", values.size() - 1),
                   fmt::format("1 to {}", kModemBytes));
  const auto whole = [](double value, double most) {
    return value >= 0.0 && value <= most && value == std::floor(value);
  };
  if (!whole(values[0], static_cast<double>(modems)))
    return refusal(where, fmt::format("to {}", values[0]),
                   fmt::format("the number of a modem, 1 to {}, or 0 for all", modems));
  if (values[0] == static_cast<double>(by))
    return refusal(where, fmt::format("to {}, the sender itself", by),
                   "another modem's number, or 0 for all");
  ModemSend message{.to = static_cast<std::uint64_t>(values[0]), .bytes = values.size() - 1};
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    if (!whole(values[i + 1], 255.0))
      return refusal(where, fmt::format("{} at place {}", values[i + 1], i + 1), "bytes, 0 to 255");
    message.words[i / 4] |= static_cast<std::uint32_t>(values[i + 1]) << (8 * (i % 4));
  }
  return message;
}

Authority chosen_authority(const PhysicsInputs& chosen, OwnerSort sort, std::size_t owner,
                           std::size_t group, SourceId& source, double& hold_s) {
  const GroupControl& control =
      sort == OwnerSort::kVehicle ? chosen.vehicles()[owner].control[group]
      : sort == OwnerSort::kDiver ? chosen.humans()[owner].control[group]
                                  : chosen.objects()[owner].control[group];
  source = static_cast<SourceId>(control.source);
  hold_s = control.hold_s;
  return control.authority;
}

}  // namespace

Result<SourceId> World::Parts::source(const std::string& name) {
  if (const auto known = sources.find(name); known != sources.end()) return known->second;
  NERITIC_TRY(const SourceId id, physics->inbox().open(name));
  sources.emplace(name, id);
  return id;
}

Status World::Parts::push(SourceId source, StreamId stream, const Payload& payload,
                          TimeNs captured_ns) {
  const std::string& name = world().streams()[stream].name;
  const TimeNs now = newest().host_ns;
  captured_ns -= newest().scene_from_host_ns();
  constexpr TimeNs kRounding_ns = 1'000'000;
  if (captured_ns > now + kRounding_ns)
    return refusal(name,
                   fmt::format("a stamp {:.3g} s ahead of the newest step",
                               1e-9 * static_cast<double>(captured_ns - now)),
                   "finite, plausible samples in their order, up to 0.5 s old");
  ModemQueue queue;
  const bool sends = std::holds_alternative<ModemSend>(payload);
  if (sends) queue = messages[stream];
  if (sends && !queue.add(newest().step))
    return refusal(name, "one more message",
                   fmt::format("up to {} that wait to be sent; {} go on with each step",
                               ModemQueue::kMost, ModemQueue::kInStep));
  const SampleVerdict verdict = physics->inbox().push(
      {{stream, source, sequences[{source, stream}]++, captured_ns, now}, payload});
  if (verdict == SampleVerdict::kAccepted) {
    if (sends) messages[stream] = queue;
    return {};
  }
  return refusal(name, fmt::format("a sample that is {}", name_of(verdict)),
                 "finite, plausible samples in their order, up to 0.5 s old");
}

Status World::Parts::hand_over(StreamId events, std::uint64_t group, Authority authority,
                               SourceId source, double hold_s) {
  const auto key = std::pair(events, group);
  const auto held = holders.find(key);
  const bool live = authority == Authority::kLive;
  if (live && held != holders.end() && held->second.source == source &&
      held->second.hold_s == hold_s)
    return {};
  // Events come under the source's own name, so that a recording says who took over.
  NERITIC_TRY_STATUS(push(source, events,
                          Event{.group = group,
                                .authority = static_cast<std::uint64_t>(authority),
                                .source = source,
                                .hold_s = hold_s},
                          now_ns()));
  if (live)
    holders[key] = {source, hold_s};
  else
    holders.erase(key);
  return {};
}

TimeNs World::Parts::now_ns() const {
  return std::llround(newest().time_s * 1e9);
}

AgentOwner World::Parts::owner_of(std::size_t agent) const {
  const std::size_t vehicles = world().vehicles().size(), humans = world().humans().size();
  if (agent < vehicles) return {OwnerSort::kVehicle, static_cast<std::uint32_t>(agent)};
  agent -= vehicles;
  if (agent < humans) return {OwnerSort::kDiver, static_cast<std::uint32_t>(agent)};
  return {OwnerSort::kObject, static_cast<std::uint32_t>(agent - humans)};
}

// Into a stream of the owner that enters from any source, without authority.
Status World::Parts::push_alone(const AgentOwner& owner, const Payload& payload,
                                const std::string& from) {
  NERITIC_TRY(const SourceId id, source(from));
  const StreamId stream =
      world().streams().id(owner.sort, owner.number, static_cast<PayloadKind>(payload.index()));
  return push(id, stream, payload, now_ns());
}

Status World::Parts::send(std::size_t agent, const GivenCommand& command) {
  const std::uint64_t modem = agents[agent].modem;
  if (modem == 0)
    return refusal(command.where, "an agent without a modem",
                   "one whose object has the table modem");
  const auto modems = world().modems().all();
  NERITIC_TRY(const ModemSend message,
              message_of(command.where, modem, modems.size(), command.values));
  const PhysicsModem& by = modems[modem - 1];
  return push_alone({by.sort, by.owner}, message, command.from);
}

Status World::Parts::grip(std::size_t agent, const GivenCommand& command) {
  const AgentOwner owner = owner_of(agent);
  if (owner.sort == OwnerSort::kObject || !world().things().find(owner.sort, owner.number))
    return refusal(command.where, "an agent without a gripper or hands",
                   "one whose object has the table gripper or hands");
  NERITIC_TRY_STATUS(check_count(command.where, command.values.size(), 1, 1));
  NERITIC_TRY_STATUS(check_choices(command.where, command.values));
  return push_alone(owner, ros::read_values(PayloadKind::kGrip, command.values), command.from);
}

Status World::Parts::regulator(std::size_t agent, const GivenCommand& command) {
  const AgentOwner owner = owner_of(agent);
  if (owner.sort != OwnerSort::kDiver || !world().humans()[owner.number].regulator)
    return refusal(command.where, "an agent without regulators",
                   "a diver whose object has the table regulator");
  NERITIC_TRY_STATUS(check_count(command.where, command.values.size(), 2, 2));
  NERITIC_TRY_STATUS(check_choices(command.where, command.values));
  return push_alone(owner, ros::read_values(PayloadKind::kRegulator, command.values), command.from);
}

// A command that takes the authority over a group: its payload's kind, and its numbers.
Result<WantedPayload> World::Parts::wanted(const AgentOwner& owner, const std::string& kind,
                                           const GivenCommand& command) const {
  const std::string& where = command.where;
  const std::span<const double> values = command.values;
  switch (owner.sort) {
    case OwnerSort::kVehicle:
      if (std::ranges::find(kVehicleCommands, kind) == kVehicleCommands.end())
        return unknown_name(world().vehicles()[owner.number].name, kind,
                            {kVehicleCommands.begin(), kVehicleCommands.end()});
      return vehicle_command(world().vehicles()[owner.number], where, kind, values);
    case OwnerSort::kDiver: {
      NERITIC_TRY(WantedPayload said, diver_command(where, kind, values));
      if (said.kind == PayloadKind::kGas)
        NERITIC_TRY_STATUS(check_tank(world().humans()[owner.number], where, said.values[0]));
      return said;
    }
    default:
      return object_command(world().objects()[owner.number], where, kind, values);
  }
}

Status World::Parts::steer(std::size_t agent, const std::string& kind, const GivenCommand& command,
                           double hold_s) {
  const AgentOwner owner = owner_of(agent);
  NERITIC_TRY(const WantedPayload act, wanted(owner, kind, command));
  NERITIC_TRY_STATUS(ros::check_values(act.kind, act.values, command.where));
  const Payload payload = ros::read_values(act.kind, act.values);
  if (!plausible(payload)) return ros::implausible(act.kind, act.values, command.where);
  const StreamTable& table = world().streams();
  const StreamId events = table.id(owner.sort, owner.number, PayloadKind::kEvent);
  NERITIC_TRY(const SourceId id, source(command.from));
  const std::size_t group = group_of(act.kind).value();
  // A wrench acts before a setpoint: for a setpoint it goes.
  constexpr auto kWrench = static_cast<std::uint64_t>(VehicleGroup::kWrench);
  if (owner.sort == OwnerSort::kVehicle &&
      group == static_cast<std::size_t>(VehicleGroup::kSetpoint) &&
      holders.contains({events, kWrench}))
    NERITIC_TRY_STATUS(hand_over(events, kWrench, Authority::kAutopilot, id, kVehicleHold_s[0]));
  NERITIC_TRY_STATUS(hand_over(events, group, Authority::kLive, id, hold_s));
  return push(id, table.id(owner.sort, owner.number, act.kind), payload, now_ns());
}

Status World::command(const std::string& name, const std::string& kind,
                      std::span<const double> values, double hold_s, const std::string& from) {
  NERITIC_TRY(const std::size_t index, agent(name));
  const GivenCommand command{name + ": " + kind, values, from};
  if (!(hold_s >= 0.0 && hold_s <= kHoldForever_s))
    return refusal(command.where + ": hold_s", fmt::format("{}", hold_s),
                   "0 (for ever) or more seconds");
  NERITIC_TRY_STATUS(check_finite(command.where, values));
  if (kind == "send") return parts_->send(index, command);
  if (kind == "grip") return parts_->grip(index, command);
  if (kind == "regulator") return parts_->regulator(index, command);
  return parts_->steer(index, kind, command, hold_s == 0.0 ? kHoldForever_s : hold_s);
}

Status World::release(const std::string& name, const std::string& from) {
  Parts& parts = *parts_;
  NERITIC_TRY(const std::size_t index, agent(name));
  const AgentOwner owner = parts.owner_of(index);
  const PhysicsWorld& world = parts.world();
  const StreamId events = world.streams().id(owner.sort, owner.number, PayloadKind::kEvent);
  NERITIC_TRY(const SourceId source, parts.source(from));
  std::vector<std::uint64_t> groups;
  for (const auto& [key, holder] : parts.holders)
    if (key.first == events) groups.push_back(key.second);
  for (const std::uint64_t group : groups) {
    SourceId chosen = 0;
    double hold_s = 0.0;
    const Authority authority =
        chosen_authority(world.start_inputs(), owner.sort, owner.number, group, chosen, hold_s);
    NERITIC_TRY_STATUS(parts.push(source, events,
                                  Event{.group = group,
                                        .authority = static_cast<std::uint64_t>(authority),
                                        .source = chosen,
                                        .hold_s = hold_s},
                                  time_ns()));
    parts.holders.erase({events, group});
  }
  return {};
}

Status World::inject(const std::string& name, std::span<const double> values,
                     const std::string& from, std::optional<double> stamp_s) {
  Parts& parts = *parts_;
  NERITIC_TRY(const std::uint32_t id, stream(name));
  if (parts.streams[id].sort != StreamInfo::Sort::kInput)
    return refusal("inject: " + name, "a stream that leaves", "a stream of inputs");
  if (parts.streams[id].fields.empty())
    return refusal("inject: " + name, "events, which hand over the authority",
                   "a stream of inputs with fields; commands and release() hand over");
  const PayloadKind kind = parts.world().streams()[id].kind;
  const std::size_t count = ros::value_count(kind);
  NERITIC_TRY_STATUS(check_count(name, values.size(), count, count));
  NERITIC_TRY_STATUS(check_finite(name, values));
  NERITIC_TRY_STATUS(ros::check_values(kind, values, name));
  if (stamp_s && !(std::abs(*stamp_s) <= 1e9))
    return refusal(name + ": stamp", fmt::format("{}", *stamp_s), "seconds of simulated time");
  NERITIC_TRY(const SourceId source, parts.source(from));
  const Payload payload = ros::read_values(kind, values);
  // Also where the line that refuses it is another one, the inbox counts it by its source.
  const Status pushed =
      parts.push(source, id, payload, stamp_s ? std::llround(*stamp_s * 1e9) : time_ns());
  if (!pushed.ok() && !plausible(payload)) return ros::implausible(kind, values, name);
  return pushed;
}

}  // namespace neritic::testbed
