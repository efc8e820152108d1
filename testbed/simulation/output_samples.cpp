#include "testbed/simulation/output_samples.hpp"

#include <algorithm>
#include <cmath>

#include "testbed/simulation/diver_condition.hpp"
#include "testbed/simulation/human_readings.hpp"
#include "testbed/simulation/periods.hpp"

namespace neritic::testbed {
namespace {

// Whether a vehicle's file may name such a sensor; a USBL may also be a modem's.
bool is_sensor(PayloadKind kind) {
  switch (kind) {
    case PayloadKind::kImu:
    case PayloadKind::kDvl:
    case PayloadKind::kPressure:
    case PayloadKind::kCompass:
    case PayloadKind::kAltimeter:
    case PayloadKind::kUsbl:
      return true;
    default:
      return false;
  }
}

bool leaves(const Stream& stream) {
  if (is_sensor(stream.kind)) return true;
  switch (stream.kind) {
    case PayloadKind::kCollision:
    case PayloadKind::kMotion:
    case PayloadKind::kComputer:
    case PayloadKind::kModem:
    case PayloadKind::kCondition:
    case PayloadKind::kSupply:
    case PayloadKind::kGripper:
    case PayloadKind::kTether:
    case PayloadKind::kBattery:
    case PayloadKind::kHuman:
      return true;
    default:
      return false;
  }
}

// Calls visit with the vehicle's newest reading of that kind.
template <class Visit>
auto with_reading(PayloadKind kind, const rov::SensorReadings& readings, const Visit& visit) {
  switch (kind) {
    case PayloadKind::kImu:
      return visit(readings.imu);
    case PayloadKind::kDvl:
      return visit(readings.dvl);
    case PayloadKind::kPressure:
      return visit(readings.pressure);
    case PayloadKind::kCompass:
      return visit(readings.heading_rad);
    case PayloadKind::kAltimeter:
      return visit(readings.altimeter);
    case PayloadKind::kUsbl:
      return visit(readings.usbl);
    default:
      check_failed(__FILE__, __LINE__, "a vehicle's sensor", std::string(name_of(kind)));
  }
}

Payload payload_of(PayloadKind kind, const rov::SensorReadings& readings) {
  return with_reading(kind, readings, [](const auto& reading) -> Payload {
    if constexpr (std::is_same_v<decltype(reading.value), double>)
      return CompassReading{reading.value};
    else
      return reading.value;
  });
}

constexpr double kLongAgo_s = -1e9;

TimeNs to_ns(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

std::vector<StreamId> OutputSamples::all(const PhysicsWorld& world) {
  std::vector<StreamId> out;
  for (StreamId id = 0; id < world.streams().size(); ++id)
    if (leaves(world.streams()[id])) out.push_back(id);
  return out;
}

OutputSamples::OutputSamples(const PhysicsWorld& world, const std::vector<StreamId>& wanted)
    : world_(world), collisions_(world) {
  for (const StreamId id : wanted) {
    NERITIC_CHECK(leaves(world.streams()[id]), "stream {} enters", world.streams()[id].name);
    outputs_.push_back({id});
  }
  std::size_t most = outputs_.size() + world.modems().all().size() * sonar::ModemState::kKept;
  for (const Output& output : outputs_) {
    const Stream& stream = world.streams()[output.stream];
    if (is_sensor(stream.kind) && stream.sort == OwnerSort::kVehicle)
      most += world.vehicles()[stream.owner].earlier;
  }
  samples_.reserve(most);
}

// Readings at 0, period_s, 2 period_s ..., each at the first step that is not before it.
OutputSamples::Made OutputSamples::every(double period_s, std::uint64_t step) const {
  const std::uint64_t periods = periods_at(step, world_.step_s(), period_s);
  return {periods + 1, static_cast<double>(periods) * period_s};
}

OutputSamples::Made OutputSamples::made(const Stream& stream,
                                        const sim::Snapshot<PhysicsState>& snapshot) const {
  if (stream.kind == PayloadKind::kMotion || stream.kind == PayloadKind::kGripper ||
      stream.kind == PayloadKind::kTether)
    return every(std::max(1.0 / kDiverMotion_hz, world_.step_s()), snapshot.step);
  if (stream.kind == PayloadKind::kComputer || stream.kind == PayloadKind::kCondition ||
      stream.kind == PayloadKind::kSupply)
    return every(std::max(diver::kComputerSample_s, world_.step_s()), snapshot.step);
  if (stream.kind == PayloadKind::kBattery)
    return every(std::max(1.0 / kBattery_hz, world_.step_s()), snapshot.step);
  if (stream.kind == PayloadKind::kHuman)
    return every(std::max(1.0 / kHuman_hz, world_.step_s()), snapshot.step);
  if (stream.kind == PayloadKind::kCollision) {
    const PhysicsState& state = snapshot.state;
    const ContactState& contact = stream.sort == OwnerSort::kVehicle
                                      ? state.vehicles()[stream.owner].contact
                                      : state.humans()[stream.owner].contact;
    // Whether the step before the first snapshot touched something is not known.
    return {contact.touched_steps, begun_ ? snapshot.time_s : kLongAgo_s};
  }
  if (const auto modem = ranging_of(stream)) {
    const auto& fix = snapshot.state.modem_tasks()[*modem].fix;
    return {fix.count, fix.time_s};
  }
  return made(stream.kind, *world_.readings(snapshot.state, stream.owner));
}

OutputSamples::Made OutputSamples::made(PayloadKind kind, const rov::SensorReadings& readings) {
  return with_reading(kind, readings, [](const auto& reading) {
    return Made{reading.count, reading.time_s};
  });
}

// The modem whose ranges the stream has.
std::optional<std::size_t> OutputSamples::ranging_of(const Stream& stream) const {
  if (stream.kind != PayloadKind::kUsbl) return std::nullopt;
  const auto modem = world_.modems().find(stream.sort, stream.owner);
  return modem && world_.modems().all()[*modem].ranging ? modem : std::nullopt;
}

// Everything that a modem reported since the last snapshot: of the first, since its step began.
void OutputSamples::add_reports(Output& output, const Stream& stream,
                                const sim::Snapshot<PhysicsState>& snapshot) {
  const sonar::ModemState& modem =
      snapshot.state.modems()[*world_.modems().find(stream.sort, stream.owner)];
  const std::uint64_t all = modem.counts.all();
  const double began_s = snapshot.time_s - world_.step_s();
  for (std::uint64_t k = sonar::first_kept(modem, begun_ ? output.count : 0); k < all; ++k) {
    const sonar::ModemReport& report = modem.reports[k % sonar::ModemState::kKept];
    // Sent messages leave at the step's beginning; those that come, come after it.
    const bool leaves = report.event <= sonar::ModemEvent::kRefused;
    if (!begun_ && (leaves ? report.at_s < began_s : report.at_s <= began_s)) continue;
    const TimeNs age_ns = std::max<TimeNs>(to_ns(snapshot.time_s - report.at_s), 0);
    samples_.push_back(
        {{output.stream, kSimulation, k, snapshot.host_ns - age_ns, snapshot.host_ns},
         modem_reading(report)});
  }
  output.count = all;
}

Payload OutputSamples::payload(const Stream& stream, const sim::Snapshot<PhysicsState>& snapshot) {
  const PhysicsState& state = snapshot.state;
  if (const auto modem = ranging_of(stream)) return state.modem_tasks()[*modem].fix.value;
  if (stream.kind == PayloadKind::kCollision)
    return collisions_.find(stream.sort, stream.owner, state);
  if (stream.kind == PayloadKind::kGripper)
    return grip_reading(world_.things(), *world_.things().find(stream.sort, stream.owner),
                        world_.humans(), state);
  if (stream.kind == PayloadKind::kTether)
    return tether_reading(state.tethers()[*world_.vehicles()[stream.owner].tether]);
  if (stream.kind == PayloadKind::kBattery) {
    const rov::Battery& battery = *world_.vehicles()[stream.owner].file.parameters.battery;
    const rov::BatteryState& now = *world_.battery(state, stream.owner);
    return BatteryReading{now.voltage_v, now.current_a, now.charge,
                          rov::battery_left_s(battery, now), now.empty};
  }
  if (stream.sort == OwnerSort::kDiver) {
    const PhysicsHuman& human = world_.humans()[stream.owner];
    const HumanPhysics& now = state.humans()[stream.owner];
    if (stream.kind == PayloadKind::kMotion) return motion_reading(human, now);
    if (stream.kind == PayloadKind::kHuman)
      return human_reading(human, now, world_.looks_at(state, stream.owner, snapshot.time_s));
    if (stream.kind == PayloadKind::kCondition) return condition_reading(human, state, now);
    if (stream.kind == PayloadKind::kSupply)
      return supply_reading(world_.humans(), stream.owner, state);
    return computer_reading(human, now);
  }
  return payload_of(stream.kind, *world_.readings(state, stream.owner));
}

// Adds the newest sample, or one of a part of the step, if it is not yet counted.
template <class MakePayload>
void OutputSamples::add(Output& output, const Made& now,
                        const sim::Snapshot<PhysicsState>& snapshot, const MakePayload& payload) {
  // At the first snapshot: those of its own step.
  const bool due =
      now.count != output.count && (begun_ || now.time_s > snapshot.time_s - world_.step_s());
  output.count = now.count;
  if (!due) return;
  const TimeNs age_ns = to_ns(snapshot.time_s - now.time_s);
  samples_.push_back(
      {{output.stream, kSimulation, now.count - 1, snapshot.host_ns - age_ns, snapshot.host_ns},
       payload()});
}

std::span<const Sample> OutputSamples::of(const sim::Snapshot<PhysicsState>& snapshot) {
  samples_.clear();
  for (Output& output : outputs_) {
    const Stream& stream = world_.streams()[output.stream];
    if (stream.kind == PayloadKind::kModem) {
      add_reports(output, stream, snapshot);
      continue;
    }
    if (is_sensor(stream.kind) && !ranging_of(stream))
      for (const EarlierReadings& earlier : world_.earlier_readings(snapshot.state, stream.owner))
        add(output, made(stream.kind, earlier.readings), snapshot,
            [&] { return payload_of(stream.kind, earlier.readings); });
    add(output, made(stream, snapshot), snapshot, [&] { return payload(stream, snapshot); });
  }
  begun_ = true;
  return samples_;
}

}  // namespace neritic::testbed
