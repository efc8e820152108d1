#include "testbed/samples/inbox.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

using enum SampleVerdict;

std::uint64_t pressed(const Sample& sample) {
  return std::get<JacketButtons>(sample.payload).pressed;
}

TEST(SampleInbox, SamplesLeaveInTheOrderInWhichTheyCame) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 8);
  const SourceId suit = inbox.open("suit").value();
  for (std::uint64_t i = 0; i < 8; ++i)
    EXPECT_EQ(inbox.push(sample_of(table, "diver/buttons", suit, i, JacketButtons{i})), kAccepted);
  const auto drained = inbox.drain();
  ASSERT_EQ(drained.size(), 8u);
  for (std::uint64_t i = 0; i < 8; ++i) EXPECT_EQ(pressed(drained[i]), i);
  EXPECT_TRUE(inbox.drain().empty());
  EXPECT_EQ(inbox.counts(suit).dropped, 0u);
}

// Saved states, recordings and the server's clients then have the same names.
TEST(SampleInbox, ASourceHasANameThatAllCanWriteAndRead) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 8);
  for (const std::string& name : {std::string("a"), std::string(64, 'x'), std::string("tcp://~")})
    EXPECT_TRUE(inbox.open(name).ok()) << name;
  const std::string none[] = {
      "",          "two words", "tab\tx",    "s\xc3\xbcit", std::string(65, 'x'),
      "autopilot", "nobody",    "recording", "simulation"};
  for (const std::string& name : none) {
    const auto opened = inbox.open(name);
    ASSERT_FALSE(opened.ok()) << name;
    EXPECT_EQ(opened.error().code, ErrorCode::kBadInput);
    EXPECT_TRUE(opened.error().message.starts_with("source: found ")) << opened.error().message;
    EXPECT_EQ(opened.error().message.find_first_of("\n\t"), std::string::npos);
  }
  EXPECT_EQ(inbox.source_names().size(), 4u);
}

TEST(SampleInbox, EveryWrongSampleIsRefusedAndCountedByItsSource) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 64);
  const SourceId suit = inbox.open("suit").value(), other = inbox.open("other").value();
  const auto buttons = [&](std::uint64_t sequence, TimeNs captured_ns, TimeNs arrived_ns) {
    Sample sample = sample_of(table, "diver/buttons", suit, sequence, JacketButtons{1});
    sample.header.captured_ns = captured_ns;
    sample.header.arrived_ns = arrived_ns;
    return inbox.push(sample);
  };
  constexpr TimeNs kSecond = 1'000'000'000;
  EXPECT_EQ(buttons(5, kSecond, kSecond), kAccepted);
  EXPECT_EQ(buttons(5, kSecond, kSecond), kRepeated);
  EXPECT_EQ(buttons(9, kSecond, kSecond), kAccepted);
  EXPECT_EQ(buttons(7, kSecond, kSecond), kOutOfOrder);
  EXPECT_EQ(buttons(10, kSecond, kSecond + SampleInbox::kMaxAge_ns + 1), kLate);
  EXPECT_EQ(buttons(11, kSecond + SampleInbox::kMaxAhead_ns + 1, kSecond), kLate);
  EXPECT_EQ(inbox.push(sample_of(table, "diver/buttons", suit, 12, GasSupply{})), kNotOfStream);
  Sample wrong = sample_of(table, "diver/gas", suit, 0, GasSupply{});
  wrong.header.stream = static_cast<StreamId>(table.size());
  EXPECT_EQ(inbox.push(wrong), kNotOfStream);
  wrong.header.source = 77;
  EXPECT_EQ(inbox.push(wrong), kUnknownSource);
  HeadPose head;
  head.world_from_head.position_m.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inbox.push(sample_of(table, "diver/head", suit, 0, head)), kNotFinite);
  head.world_from_head = {Vec3(0.0, -1e12, 0.0), Quat(1, 0, 0, 0)};
  EXPECT_EQ(inbox.push(sample_of(table, "diver/head", suit, 1, head)), kNotPlausible);
  BodyJoints body;
  body.joints[3] = Quat(0.0, 0.0, 0.0, 0.0);
  EXPECT_EQ(inbox.push(sample_of(table, "diver/joints", suit, 0, body)), kNotPlausible);
  HandPoses hands;
  hands.tracked = 1;
  hands.world_from_hand[1].rotation = Quat(0.0, 0.0, 0.0, 0.0);  // which is not tracked
  EXPECT_EQ(inbox.push(sample_of(table, "diver/hand_poses", suit, 0, hands)), kAccepted);
  hands.tracked = 2;
  EXPECT_EQ(inbox.push(sample_of(table, "diver/hand_poses", suit, 1, hands)), kNotPlausible);

  VehicleVelocity fast;
  fast.velocity_m_s.x = 1e30;
  VehicleSetpoint far;
  far.position_m.z = -1e12;
  VehicleWrench strong;
  strong.wrench[2] = 1e300;
  VehicleThrusters forces;
  forces.force_n[3] = -1e9;
  const auto push = [&](const char* stream, const Payload& payload) {
    return inbox.push(sample_of(table, stream, other, 0, payload));
  };
  EXPECT_EQ(push("rov/velocity", fast), kNotPlausible);
  EXPECT_EQ(push("rov/setpoint", far), kNotPlausible);
  EXPECT_EQ(push("rov/wrench", strong), kNotPlausible);
  EXPECT_EQ(push("rov/thrusters", forces), kNotPlausible);

  const SourceCounts counts = inbox.counts(suit);
  EXPECT_EQ(counts.accepted, 3u);
  EXPECT_EQ(counts.lost, 2u);  // 6 and 8
  EXPECT_EQ(counts.repeated, 1u);
  EXPECT_EQ(counts.out_of_order, 1u);
  EXPECT_EQ(counts.late, 2u);
  EXPECT_EQ(counts.not_finite, 1u);
  EXPECT_EQ(counts.not_plausible, 3u);
  EXPECT_EQ(counts.not_of_stream, 2u);
  EXPECT_EQ(counts.refused(), 10u);
  EXPECT_EQ(inbox.unknown_sources(), 1u);
  EXPECT_EQ(inbox.counts(other).refused(), 4u);
  EXPECT_EQ(inbox.drain().size(), 3u);  // none of the wrong ones
}

TEST(SampleInbox, ASourceThatIsOpenedAgainKeepsItsNumberAndStartsAnew) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 8);
  const SourceId suit = inbox.open("suit").value();
  const auto push = [&](std::uint64_t sequence) {
    return inbox.push(sample_of(table, "diver/buttons", suit, sequence, JacketButtons{}));
  };
  EXPECT_EQ(push(900), kAccepted);
  EXPECT_EQ(push(0), kOutOfOrder);
  EXPECT_EQ(inbox.open("suit").value(), suit);
  EXPECT_EQ(push(0), kAccepted);
  EXPECT_EQ(inbox.source_names(), (std::vector<std::string>{"simulation", "suit"}));
}

TEST(SampleInbox, SourcesAreBounded) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 8);
  for (std::size_t i = 1; i < SampleInbox::kMaxSources; ++i)
    ASSERT_TRUE(inbox.open(fmt::format("device_{}", i)).ok());
  EXPECT_FALSE(inbox.open("one_more").ok());
  EXPECT_TRUE(inbox.open("device_7").ok());
}

TEST(SampleInbox, ABurstOfAMillionKeepsWhatTheBoundAllowsAndTheNewestOfEachSourceAndStream) {
  const StreamTable table = diver_and_rov();
  constexpr std::size_t kCapacity = 1024, kBurst = 1'000'000;
  SampleInbox inbox(table, kCapacity);
  const SourceId noisy = inbox.open("noisy").value(), quiet = inbox.open("quiet").value();
  for (std::uint64_t i = 0; i < kBurst; ++i)
    inbox.push(sample_of(table, i % 2 ? "diver/buttons" : "diver/gas", noisy, i / 2,
                         i % 2 ? Payload(JacketButtons{i}) : Payload(GasSupply{i})));
  inbox.push(sample_of(table, "diver/buttons", quiet, 3, JacketButtons{42}));

  const auto drained = inbox.drain();
  ASSERT_EQ(drained.size(), kCapacity + 3);
  for (std::size_t i = 0; i < kCapacity; ++i) EXPECT_EQ(drained[i].header.sequence, i / 2);
  EXPECT_EQ(std::get<GasSupply>(drained[kCapacity].payload).tank, kBurst - 2);
  EXPECT_EQ(pressed(drained[kCapacity + 1]), kBurst - 1);
  EXPECT_EQ(pressed(drained[kCapacity + 2]), 42u);
  EXPECT_EQ(inbox.counts(noisy).accepted, kBurst);
  EXPECT_EQ(inbox.counts(noisy).dropped, kBurst - kCapacity - 2);
  EXPECT_EQ(inbox.counts(noisy).lost, 0u);
  EXPECT_EQ(inbox.counts(quiet).dropped, 0u);
  // The next burst finds room again.
  for (std::uint64_t i = 0; i < 10; ++i)
    inbox.push(sample_of(table, "diver/buttons", noisy, kBurst / 2 + i, JacketButtons{i}));
  EXPECT_EQ(inbox.drain().size(), 10u);
}

// Drained and dropped samples add up to the accepted ones, and each stream's newest comes through.
TEST(SampleInbox, ThreadsThatPushBurstsLoseNothingUncounted) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 64);
  constexpr std::uint64_t kEach = 20'000;
  const char* const streams[] = {"diver/buttons", "diver/gas", "rov/fault"};
  const Payload payloads[] = {JacketButtons{}, GasSupply{}, ThrusterFault{}};
  std::vector<std::thread> producers;
  std::atomic<int> running{3};
  for (int i = 0; i < 3; ++i)
    producers.emplace_back([&, i] {
      const SourceId source = inbox.open(fmt::format("device_{}", i)).value();
      for (std::uint64_t n = 0; n < kEach; ++n)
        inbox.push(sample_of(table, streams[i], source, n, payloads[i]));
      --running;
    });
  std::uint64_t drained = 0;
  std::vector<std::uint64_t> newest(table.size());
  const auto drain = [&] {
    for (const Sample& sample : inbox.drain()) {
      ++drained;
      std::uint64_t& last = newest[sample.header.stream];
      EXPECT_TRUE(last == 0 || sample.header.sequence > last);
      last = sample.header.sequence;
    }
  };
  while (running > 0) drain();
  for (std::thread& thread : producers) thread.join();
  drain();
  std::uint64_t accepted = 0, dropped = 0;
  for (SourceId id = 1; id <= 3; ++id) {
    accepted += inbox.counts(id).accepted;
    dropped += inbox.counts(id).dropped;
  }
  EXPECT_EQ(accepted, 3 * kEach);
  EXPECT_EQ(drained + dropped, accepted);
  for (const char* stream : streams) EXPECT_EQ(newest[*table.find(stream)], kEach - 1) << stream;
}

TEST(SampleInbox, OneSampleOfAWrongTimeOrNumberDoesNotEndItsSource) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 64);
  const SourceId suit = inbox.open("suit").value();
  constexpr TimeNs kSecond = 1'000'000'000;
  const auto push = [&](std::uint64_t sequence, TimeNs captured_ns, double bias = 0.0) {
    Breath breath;
    breath.bias_m3 = bias;
    Sample sample = sample_of(table, "diver/breath", suit, sequence, breath, kSecond);
    sample.header.captured_ns = captured_ns;
    return inbox.push(sample);
  };
  EXPECT_EQ(push(~std::uint64_t{0}, 3600 * kSecond), kLate);  // nothing begins with it
  EXPECT_EQ(push(1, kSecond), kAccepted);
  EXPECT_EQ(push(2, 3600 * kSecond), kLate);
  EXPECT_EQ(push(3, kSecond), kAccepted);
  EXPECT_EQ(push(4, kSecond + 1, std::numeric_limits<double>::infinity()), kNotFinite);
  EXPECT_EQ(push(5, kSecond), kAccepted);
  EXPECT_EQ(push(1'000'000'000'000, kSecond), kOutOfOrder);
  EXPECT_EQ(push(6, kSecond), kAccepted);
  EXPECT_EQ(inbox.counts(suit).lost, 0u);
}

}  // namespace
}  // namespace neritic::testbed
