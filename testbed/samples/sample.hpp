// A sample: a header that names its source and its time, and one payload. Plain bytes; any
// thread. A device, a client, a recording or the simulation sends it (README.md).
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"
#include "testbed/samples/payloads.hpp"

namespace neritic::testbed {

using StreamId = std::uint32_t;  // index into the scene's StreamTable
using SourceId = std::uint32_t;  // given by the inbox; 0 is the simulation

inline constexpr SourceId kSimulation = 0;

struct SampleHeader {
  StreamId stream = 0;
  SourceId source = kSimulation;
  std::uint64_t sequence = 0;  // rises by one a sample of this source and stream
  // The host's clock; in simulated time the scene's. Captured: when it was measured, mapped from
  // the sender's clock. Arrived: when it reached this program; the source that pushes it sets both.
  TimeNs captured_ns = 0, arrived_ns = 0;

  static void fields(auto&& field, auto& self) {
    field("stream", self.stream);
    field("source", self.source);
    field("sequence", self.sequence);
    field("captured_ns", self.captured_ns);
    field("arrived_ns", self.arrived_ns);
  }
};

// The order is that of PayloadKind.
using Payload =
    std::variant<BodyJoints, HandJoints, HandPoses, HeadPose, Gaze, JacketButtons, Breath, Heart,
                 GasSupply, VehicleWrench, VehicleSetpoint, VehicleVelocity, VehicleThrusters,
                 ThrusterFault, ObjectPose, Event, rov::ImuReading, rov::DvlReading,
                 rov::PressureReading, CompassReading, rov::AltimeterReading, rov::UsblReading,
                 CollisionReading, DiverMotion, ComputerReading, ModemReading, ModemSend,
                 ConditionReading, SupplyReading, RegulatorUse, GripReading, GripUse, TetherReading,
                 BatteryReading, HumanReading>;

enum class PayloadKind : std::uint32_t {
  kBodyJoints,
  kHandJoints,
  kHandPoses,
  kHeadPose,
  kGaze,
  kButtons,
  kBreath,
  kHeart,
  kGas,
  kWrench,
  kSetpoint,
  kVelocity,
  kThrusters,
  kFault,
  kObjectPose,
  kEvent,
  kImu,
  kDvl,
  kPressure,
  kCompass,
  kAltimeter,
  kUsbl,
  kCollision,
  kMotion,
  kComputer,
  kModem,
  kSend,
  kCondition,
  kSupply,
  kRegulator,
  kGripper,
  kGrip,
  kTether,
  kBattery,
  kHuman,
};
inline constexpr std::size_t kPayloadKinds = std::variant_size_v<Payload>;
static_assert(kPayloadKinds == static_cast<std::size_t>(PayloadKind::kHuman) + 1);

// The last part of a stream's name: "joints", "imu".
std::string_view name_of(PayloadKind kind);
// Whether samples of the kind are inputs; the others leave.
constexpr bool enters(PayloadKind kind) {
  return kind <= PayloadKind::kEvent || kind == PayloadKind::kSend ||
         kind == PayloadKind::kRegulator || kind == PayloadKind::kGrip;
}

struct Sample {
  SampleHeader header;
  Payload payload;

  PayloadKind kind() const { return static_cast<PayloadKind>(payload.index()); }
};
static_assert(std::is_trivially_copyable_v<Sample>);

// A payload of that kind as it begins.
Payload empty_payload(PayloadKind kind);
// Every number is finite.
bool all_finite(const Payload& payload);
// Nearer than kFarthest_m, slower than kFastest (m/s or rad/s), asking for no more than kStrongest
// (N or N m), and every rotation is a unit quaternion up to the rounding of 32-bit floats.
// Precondition: all_finite.
bool plausible(const Payload& payload);
inline constexpr double kFarthest_m = 4e7;  // the Earth's circumference
inline constexpr double kFastest = 1e4;
inline constexpr double kStrongest = 1e6;

}  // namespace neritic::testbed
