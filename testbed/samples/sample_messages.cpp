#include "testbed/samples/sample_messages.hpp"

#include "engine/recording/ros_types.hpp"
#include "testbed/samples/field_messages.hpp"

namespace neritic::testbed {
namespace {

// For readers of the schema, beside the names of the fields.
std::string_view words_of(PayloadKind kind) {
  switch (kind) {
    case PayloadKind::kBodyJoints:
      return "posture: parent_from_child of each joint";
    case PayloadKind::kHandPoses:
      return "tracked hands, left first; tracked: bit 0 left, bit 1 right";
    case PayloadKind::kHeadPose:
      return "tracked head: the middle of the eyes; placed 1: its place counts";
    case PayloadKind::kButtons:
      return "pressed: 1 inflate, 2 deflate, 4 dump";
    case PayloadKind::kGas:
      return "the tank that is breathed from, 0 is the first";
    case PayloadKind::kWrench:
      return "surge, sway, heave in N, roll, pitch, yaw in N m: forward, starboard, down";
    case PayloadKind::kSetpoint:
      return "where a vehicle is to be; heading from north to east";
    case PayloadKind::kVelocity:
      return "forward, starboard, down of the heading; yaw from north to east";
    case PayloadKind::kFault:
      return "bit i: thruster i + 1 fails";
    case PayloadKind::kObjectPose:
      return "a tracked object; measured 1: its velocities count";
    case PayloadKind::kSend:
      return "a message for a modem to send; to: from 1 on, 0 all; words: its bytes, little-endian";
    case PayloadKind::kModem:
      return "event: 0 sent, 1 refused, 2 received, lost: 3 too weak, 4 noisy, 5 collided, 6 was "
             "sending; message_kind: 1, 2 of ranging";
    case PayloadKind::kRegulator:
      return "supply: 0 by itself, 1 own tanks, 2 the donor's; flow: 0 by the scene, 1 blows, 2 "
             "holds";
    case PayloadKind::kCondition:
      return "a model of hypoxia, carbon dioxide, oxygen, narcosis, cold; lost: their bits, 0 "
             "awake";
    case PayloadKind::kSupply:
      return "what is breathed; donor: a diver's number from 1 on, 0 its own; litres at 1 bar";
    case PayloadKind::kGrip:
      return "choice: 0 by itself, 1 open, 2 close";
    case PayloadKind::kGripper:
      return "held: an object's number from 1 on, 0 nothing; place, load, nearest thing";
    case PayloadKind::kTether:
      return "a tether; pull: on the vehicle; touching: segments that press on something solid";
    case PayloadKind::kBattery:
      return "a battery; voltage and current at its terminals, charge of 1, time left at this "
             "power; "
             "empty 1: no thruster has power";
    case PayloadKind::kHuman:
      return "a person's state; qualities: 0 missing, 1 source lost, 2 modelled, 3 poor, 4 good; "
             "gaze_object: an object's number from 1 on, 0 nothing";
    case PayloadKind::kPressure:
      return "absolute pressure, and the depth that the sensor makes of it";
    case PayloadKind::kCompass:
      return "heading from north to east";
    case PayloadKind::kUsbl:
      return "acoustic position, north, east, down; heard 0: no answer";
    case PayloadKind::kMotion:
      return "motion and signs of life; rotation from starboard, up, back";
    case PayloadKind::kComputer:
      return "a dive computer's display; -1: no limit or no end";
    default:
      return "a sample";
  }
}

constexpr const char* kEnvelope =
    "# Axes, unless said: x east, y up, z south, metres. Times: header the scene's; others the "
    "host's clock, in "
    "nanoseconds, in simulated time the scene's.\n"
    "std_msgs/Header header\n"
    "uint64 step\nuint32 source\nuint64 sequence\nint64 captured_ns\nint64 arrived_ns\n";

}  // namespace

// "hand_poses" as "neritic_msgs/msg/HandPoses".
std::string message_type(PayloadKind kind) {
  std::string type = "neritic_msgs/msg/";
  bool begins = true;
  for (const char c : name_of(kind)) {
    if (c != '_') type += begins ? static_cast<char>(c - 'a' + 'A') : c;
    begins = c == '_';
  }
  return type;
}

recording::McapSchema sample_schema(PayloadKind kind) {
  std::string lines = fmt::format("# {}\n{}", words_of(kind), kEnvelope);
  std::visit([&](const auto& value) { lines += message_lines(value); }, empty_payload(kind));
  return recording::own_schema(message_type(kind), lines);
}

std::string sample_message(const Sample& sample, const SampleMoment& moment) {
  std::string bytes;
  recording::CdrWriter out(bytes);
  out.header(moment.captured_scene_ns, "");
  out.number(moment.step);
  out.number(sample.header.source);
  out.number(sample.header.sequence);
  out.number(sample.header.captured_ns);
  out.number(sample.header.arrived_ns);
  std::visit([&](const auto& value) { put_message(out, value); }, sample.payload);
  return bytes;
}

std::optional<ReadSample> read_sample(PayloadKind kind, std::span<const std::byte> bytes) {
  recording::CdrReader in(bytes);
  ReadSample read;
  in.number<std::int32_t>(), in.number<std::uint32_t>(), in.text();  // header
  read.step = in.number<std::uint64_t>();
  SampleHeader& header = read.sample.header;
  header.source = in.number<SourceId>();
  header.sequence = in.number<std::uint64_t>();
  header.captured_ns = in.number<TimeNs>();
  header.arrived_ns = in.number<TimeNs>();
  read.sample.payload = empty_payload(kind);
  std::visit([&](auto& value) { take_message(in, value); }, read.sample.payload);
  if (!in.whole() || in.left() > 0) return std::nullopt;
  return read;
}

}  // namespace neritic::testbed
