// A motion suit's bytes as joints and fingers: the wire vectors, its posture at rest, pieces, a
// restart.
#include "testbed/devices/suit_adapter.hpp"

#include "diver/kinematics.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

using net::bytes_of;

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = glm::conjugate(a) * b;
  return 2.0 * std::atan2(glm::length(Vec3(d.x, d.y, d.z)), std::abs(d.w));
}

TEST(SuitPosture, JointsAndFingersComeBackThroughASuitsFrame) {
  diver::JointAngles angles{};
  for (std::size_t i = 0; i < angles.size(); ++i)
    angles[i] = Vec3(0.1, -0.3, 0.2) * (0.3 + 0.1 * static_cast<double>(i));
  const diver::JointRotations joints = diver::rotations_of(angles);
  std::array<double, 10> flexion{};
  for (std::size_t i = 0; i < 10; ++i) flexion[i] = 0.1 * static_cast<double>(i);
  const Quat turned = glm::angleAxis(1.1, glm::normalize(Vec3(1, 2, 3)));
  const net::SuitFrame frame = suit_frame(joints, flexion, turned);
  const diver::JointRotations back = joints_of(frame);
  for (std::size_t i = 0; i < joints.size(); ++i)
    EXPECT_LT(angle_between(joints[i], back[i]), 1e-6) << diver::kSegmentNames[i + 1];
  const HandJoints hands = hands_of(frame, back);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(hands.flexion_rad[i], flexion[i], 1e-6) << i;
  EXPECT_LT(angle_between(hands.wrist[0], joints[diver::joint_of(diver::kLeftHand)]), 1e-6);
}

// The wire's posture at rest is that with arms spread; a knee bends about the wire's y.
TEST(SuitPosture, RestIsArmsSpreadAndAxesAreMvns) {
  net::SuitFrame frame;
  for (std::size_t i = 0; i < frame.body.size(); ++i)
    frame.body[i] = {static_cast<std::uint32_t>(i + 1), {}, {1, 0, 0, 0}};
  diver::JointAngles angles = diver::angles_of(joints_of(frame));
  EXPECT_NEAR(angles[diver::joint_of(diver::kLeftUpperArm)].z, kPi / 2, 1e-9);
  EXPECT_NEAR(angles[diver::joint_of(diver::kRightUpperArm)].z, -kPi / 2, 1e-9);
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (diver::child_of(i) != diver::kLeftUpperArm && diver::child_of(i) != diver::kRightUpperArm) {
      EXPECT_LT(glm::length(angles[i]), 1e-9) << i;
    }
  // Shin and foot turned by +60 degrees about y, to the left: the heel rises behind.
  for (const MvnSegment segment : {kMvnRightLowerLeg, kMvnRightFoot, kMvnRightToe})
    frame.body[segment].rotation = {std::sqrt(0.75F), 0, 0.5F, 0};
  angles = diver::angles_of(joints_of(frame));
  EXPECT_NEAR(angles[diver::joint_of(diver::kRightLowerLeg)].y, -kPi / 3, 1e-6);
}

TEST(SuitAdapter, TheVectorsFrameIsWholeWithItsSecondPartAndBendsTheAbdomen) {
  Bench bench("suit = \"mxtp udp\"\n");
  SuitAdapter suit(0, false);
  const auto all = net::wire_vectors();
  const auto& vectors = all["xsens_mvn"]["vectors"];
  suit.take(bytes_of(vectors[0]), false, 1'000'000'000, bench.out);
  EXPECT_TRUE(bench.samples().empty());
  suit.take(bytes_of(vectors[1]), false, 1'001'000'000, bench.out);
  const auto samples = bench.samples();
  ASSERT_EQ(samples.size(), 2u);
  const auto& body = std::get<BodyJoints>(samples[0].payload);
  // L5 leans forward by 90 degrees about y, L3 not at all: the abdomen is between them.
  EXPECT_NEAR(angle_between(body.joints[diver::joint_of(diver::kAbdomen)], Quat(1, 0, 0, 0)),
              kPi / 4, 1e-6);
  EXPECT_EQ(samples[0].header.captured_ns, 1'000'000'000);  // its first part came then
  // Other types are whole and of no use here.
  for (std::size_t i = 2; i <= 9; ++i)
    suit.take(bytes_of(vectors[i]), false, 1'002'000'000, bench.out);
  for (const auto& bad : all["xsens_mvn"]["malformed"])
    if (bad["hex"] != "") suit.take(bytes_of(bad), false, 1'003'000'000, bench.out);
  EXPECT_EQ(suit.counts().unused, 8u);
  EXPECT_EQ(suit.counts().malformed, 5u);
  expect_adds_up(suit.counts());
}

// Older programs leave the payload's length 0.
TEST(SuitAdapter, AStreamInPiecesGivesTheSameFramesWithAndWithoutTheirLength) {
  for (const bool with_length : {true, false}) {
    Bench bench("suit = \"mxtp tcp\"\n");
    SuitAdapter suit(0, true);
    SimulatedDeviceOptions options;
    options.rate_hz = 50.0;
    const auto device = simulated_device("mxtp", options);
    std::vector<std::byte> wire;
    const auto put = [&](std::vector<std::byte> bytes) {
      if (!with_length) bytes[22] = bytes[23] = std::byte{0};
      wire.insert(wire.end(), bytes.begin(), bytes.end());
    };
    for (int ms = 1; ms <= 2000; ++ms)
      device->run({}, TimeNs{ms} * kMillisecond_ns, [&](std::vector<std::byte> bytes, TimeNs) {
        put(bytes);
        // A type that nothing uses, of a length that its items do not tell.
        bytes[4] = std::byte{'2'}, bytes[5] = std::byte{'4'};
        put(bytes);
        if (ms / 20 == 50) wire.insert(wire.end(), 77, std::byte{'M'});  // what is none in between
      });
    for (std::size_t at = 0, i = 0; at < wire.size(); ++i) {
      const std::size_t some = std::min<std::size_t>(1 + mix64(i) % 3000, wire.size() - at);
      suit.take(net::Bytes(wire).subspan(at, some), false, static_cast<TimeNs>(at), bench.out);
      at += some;
    }
    EXPECT_EQ(bench.samples().size(), 200u) << with_length;
    EXPECT_GE(suit.counts().malformed, 1u);
    EXPECT_EQ(suit.counts().used, 200u) << with_length;
    expect_adds_up(suit.counts());
  }
}

// The samples' number and time begin again together, without a pause.
TEST(SuitAdapter, ARestartedSuitIsOnTimeAgain) {
  Bench bench("suit = \"mxtp udp\"\n");
  SuitAdapter suit(0, false);
  const net::SuitFrame still = suit_frame({}, {}, Quat(1, 0, 0, 0));
  TimeNs last_age_ns = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const std::uint32_t number = i < 200 ? 5000 + i : i - 200;
    const TimeNs now = kSecond_ns + i * 10 * kMillisecond_ns;
    suit.take(net::encode_mxtp({.sample = number,
                                .items = 23,
                                .time_ms = i < 200 ? 50'000 + 10 * i : 10 * (i - 200),
                                .body_segments = 23},
                               still.body),
              false, now, bench.out);
    for (const Sample& sample : bench.samples()) last_age_ns = now - sample.header.captured_ns;
  }
  EXPECT_EQ(suit.counts().restarts, 1u);
  EXPECT_EQ(last_age_ns, 0);
  EXPECT_NEAR(suit.clock().offset_s, 3.0, 1e-6);
  EXPECT_EQ(bench.out.sent(), bench.out.accepted());
}

// A suit of which every fourth frame is sent, over a pause of 5 s.
TEST(SuitAdapter, ADecimatedSuitMovesAgainAfterAPause) {
  Bench bench("suit = \"mxtp udp\"\n");
  SuitAdapter suit(0, false);
  const net::SuitFrame still = suit_frame({}, {}, Quat(1, 0, 0, 0));
  std::size_t moved = 0;
  for (std::uint32_t i = 0; i < 600; ++i) {
    if (i >= 150 && i < 450) continue;
    suit.take(
        net::encode_mxtp(
            {.sample = 4 * i, .items = 23, .time_ms = 4 * i * 1000 / 240, .body_segments = 23},
            still.body),
        false, kSecond_ns + i * 4 * kSecond_ns / 240, bench.out);
    const std::size_t now = bench.samples().size();
    if (i >= 450) moved += now;
    if (i == 452) {
      EXPECT_EQ(suit.trouble(), "its packets' numbers leap by more than 1000");
    }
  }
  EXPECT_EQ(moved, 2u * 147u);
  EXPECT_EQ(suit.trouble(), "");
  expect_adds_up(suit.counts());
}

TEST(SuitAdapter, OneThatGivesNoWholeFrameSaysSo) {
  Bench bench("suit = \"mxtp udp\"\n");
  SuitAdapter suit(0, false);
  const net::SuitFrame still = suit_frame({}, {}, Quat(1, 0, 0, 0));
  for (std::uint32_t i = 0; i < 60; ++i)
    suit.take(net::encode_mxtp({.sample = i, .items = 5, .time_ms = 10 * i, .body_segments = 5},
                               std::span(still.body).first(5)),
              false, kSecond_ns + i * 10 * kMillisecond_ns, bench.out);
  EXPECT_EQ(suit.trouble(), "no frame has all 23 segments of the body");
  suit.take(net::encode_mxtp({.sample = 60, .items = 23, .time_ms = 600, .body_segments = 23},
                             still.body),
            false, 2 * kSecond_ns, bench.out);
  EXPECT_EQ(suit.trouble(), "");
  const auto vectors = net::wire_vectors();
  for (int i = 0; i < 60; ++i)
    suit.take(bytes_of(vectors["xsens_mvn"]["vectors"][2]), false, 3 * kSecond_ns, bench.out);
  EXPECT_EQ(suit.trouble(), "it sends type 20; used: 02, position and orientation (quaternion)");
}

}  // namespace
}  // namespace neritic::testbed
