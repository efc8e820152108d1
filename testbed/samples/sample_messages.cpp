#include "testbed/samples/sample_messages.hpp"

#include <array>

#include "engine/recording/ros_types.hpp"
#include "testbed/samples/field_messages.hpp"

namespace neritic::testbed {
namespace {

struct KindText {
  const char* type;
  const char* says;
};
// In the order of PayloadKind.
constexpr std::array<KindText, kPayloadKinds> kTexts{{
    {"BodyJoints", "posture: parent_from_child of each joint"},
    {"HandJoints", "wrists (parent_from_child) and fingers, left hand first"},
    {"HandPoses", "tracked hands, left first; tracked: bit 0 left, bit 1 right"},
    {"HeadPose", "tracked head: the middle of the eyes; placed 1: its place counts"},
    {"Gaze", "directions of the eyes"},
    {"JacketButtons", "pressed: 1 inflate, 2 deflate, 4 dump"},
    {"Breath", "measured breath"},
    {"Heart", "measured heart"},
    {"GasSupply", "the tank that is breathed from, 0 is the first"},
    {"VehicleWrench", "surge, sway, heave in N, roll, pitch, yaw in N m: forward, starboard, down"},
    {"VehicleSetpoint", "where a vehicle is to be; heading from north to east"},
    {"ThrusterFault", "bit i: thruster i + 1 fails"},
    {"ObjectPose", "a tracked object; measured 1: its velocities count"},
    {"Event", "a change of authority"},
    {"ImuReading", "inertial unit: forward, starboard, down"},
    {"DvlReading", "Doppler velocity log; heard: bit i is beam i"},
    {"PressureReading", "absolute pressure, and the depth that the sensor makes of it"},
    {"CompassReading", "heading from north to east"},
    {"AltimeterReading", "distance along the beam; heard 0: no echo"},
    {"UsblReading", "acoustic position, north, east, down; heard 0: no answer"},
    {"CollisionReading", "what a body touched"},
    {"DiverMotion", "a diver's motion and signs of life; rotation from starboard, up, back"},
    {"ComputerReading", "a dive computer's display; -1: no limit or no end"},
}};

const KindText& text_of(PayloadKind kind) {
  return kTexts.at(static_cast<std::size_t>(kind));
}

constexpr const char* kEnvelope =
    "# Axes, unless said: x east, y up, z south, metres. Times on the run's clock, nanoseconds.\n"
    "std_msgs/Header header\n"
    "uint64 step\nuint32 source\nuint64 sequence\nint64 captured_ns\nint64 arrived_ns\n";

}  // namespace

std::string message_type(PayloadKind kind) {
  return fmt::format("neritic_msgs/msg/{}", text_of(kind).type);
}

recording::McapSchema sample_schema(PayloadKind kind) {
  std::string lines = fmt::format("# {}\n{}", text_of(kind).says, kEnvelope);
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
