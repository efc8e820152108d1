// Streams of Lab Streaming Layer through the library's interface (tests/fakes/lsl): found, stamped,
// clocks mapped, lost and found again, refused.
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "testbed/devices/lsl_outlet.hpp"
#include "tests/fakes/lsl/fake_lsl.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

using test::FakeLsl;

struct LslLab {
  explicit LslLab(const std::string& sources) : dive(dive_of(lab_text(sources))) {}
  Result<std::unique_ptr<DeviceSource>> open(
      DeviceSource::Pace pace = DeviceSource::Pace::kPolled) {
    return DeviceSource::open(dive.scene.sources.at(0), *dive.world, dive.simulation->inbox(),
                              pace);
  }
  std::vector<Sample> samples() {
    const auto drained = dive.simulation->inbox().drain();
    return {drained.begin(), drained.end()};
  }
  TestDive dive;
};

// By the sender's clock, so that the newest was measured just now.
std::vector<double> stamps_until_now(FakeLsl& lsl, double correction_s, std::size_t count,
                                     double rate_hz) {
  std::vector<double> stamps;
  const double now_s = lsl.local_clock() - correction_s;
  for (std::size_t i = 0; i < count; ++i)
    stamps.push_back(now_s - static_cast<double>(count - 1 - i) / rate_hz);
  return stamps;
}

TEST(LabStreamingLayer, AJacketsButtonsArriveAtTheTimeTheyWerePressedBySendersClock) {
  FakeLsl lsl;
  constexpr double kCorrection_s = 1234.5;  // the sender's clock is behind by that
  lsl.add("jacket", 3);
  lsl.clock("jacket", kCorrection_s, 1e-4);
  LslLab lab("jacket = \"jacket lsl jacket\"\n");
  const auto source = lab.open(DeviceSource::Pace::kThread);
  ASSERT_TRUE(source.ok()) << source.error().message;
  std::vector<Sample> samples;
  double pressed_s = 0.0;
  // The library's first answer to how far its clock is off comes late; samples come meanwhile.
  for (int i = 0; i < 1000 && (samples.size() < 20 || lsl.exchanges("jacket") == 0); ++i) {
    pressed_s = lsl.local_clock();
    lsl.push("jacket", {1.0F, 0.0F, 0.0F}, {pressed_s - kCorrection_s});
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (const Sample& sample : lab.samples()) samples.push_back(sample);
  }
  ASSERT_GE(samples.size(), 20u);
  ASSERT_GE(lsl.exchanges("jacket"), 1);
  EXPECT_EQ(std::get<JacketButtons>(samples.back().payload).pressed, diver::kInflate);
  const TimeNs captured_ns = samples.back().header.captured_ns;
  // The monotonic clock of both.
  EXPECT_NEAR(1e-9 * static_cast<double>(captured_ns - now_ns()), pressed_s - lsl.local_clock(),
              0.03);
  const DeviceHealth health = (*source)->health();
  EXPECT_TRUE(health.clock.known);
  EXPECT_NEAR(health.clock.offset_s, kCorrection_s, 1e-3);
  EXPECT_EQ(health.link.lost, 0u);
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, AnEcgAndASoundComeWholeThroughChunksOfAnyLength) {
  FakeLsl lsl;
  lsl.add("ecg", 1, 130.0);
  LslLab strap("strap = \"strap lsl ecg\"\n");
  auto source = strap.open();
  ASSERT_TRUE(source.ok()) << source.error().message;
  std::size_t sent = 0;
  for (const std::size_t count : {1u, 5000u, 72u, 73u, 9000u}) {
    lsl.push("ecg", std::vector<float>(count, 100.0F), stamps_until_now(lsl, 0.0, count, 130.0));
    for (int i = 0; i < 4; ++i) (*source)->receive_at(now_ns(), 0);
    sent += count;
  }
  ASSERT_TRUE((*source)->poll(strap.dive.simulation->inbox(), 1e-9 * now_ns()).ok());
  EXPECT_EQ((*source)->health().link.datagrams, sent / 73);
  lsl.add("breath", 1, 16000.0);
  LslLab microphone("mic = \"microphone lsl breath\"\n");
  auto heard = microphone.open();
  ASSERT_TRUE(heard.ok()) << heard.error().message;
  lsl.push("breath", std::vector<float>(4096, 0.1F), stamps_until_now(lsl, 0.0, 4096, 16000.0));
  (*heard)->receive_at(now_ns(), 0);
  ASSERT_TRUE((*heard)->poll(microphone.dive.simulation->inbox(), 1e-9 * now_ns()).ok());
  EXPECT_EQ((*heard)->health().link.used, 8u);
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, AGazeIsADirectionAndEyesThatAreNotSeenAreLost) {
  FakeLsl lsl;
  lsl.add("eyes", 3, 120.0);
  LslLab lab("gaze = \"gaze lsl eyes\"\n");
  auto source = lab.open();
  ASSERT_TRUE(source.ok()) << source.error().message;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  lsl.push("eyes", {0.0F, 0.0F, -2.0F, 3.0F, 0.0F, -4.0F, nan, nan, nan},
           stamps_until_now(lsl, 0.0, 3, 120.0));
  for (int i = 0; i < 3; ++i) (*source)->receive_at(now_ns(), 0);
  const auto samples = lab.samples();
  ASSERT_EQ(samples.size(), 3u);
  const auto state = [&](std::size_t i) { return std::get<Gaze>(samples[i].payload).state; };
  EXPECT_LT(glm::distance(state(0).direction, Vec3(0, 0, -1)), 1e-6);
  EXPECT_LT(glm::distance(state(1).direction, Vec3(0.6, 0, -0.8)), 1e-6);
  EXPECT_EQ(state(2).now, diver::GazeClass::kLost);
  EXPECT_LT(glm::distance(state(2).direction, Vec3(0.6, 0, -0.8)), 1e-6);
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, AStreamThatGoesIsSilentAndOneThatIsLostIsFoundAgain) {
  FakeLsl lsl;
  lsl.add("jacket", 3);
  lsl.clock("jacket", 0.0, 1e-4, 3);
  LslLab lab("jacket = \"jacket lsl jacket\"\n");
  auto opened = lab.open();
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  DeviceSource& source = **opened;
  const auto press = [&] {
    lsl.push("jacket", {0.0F, 1.0F, 0.0F}, {lsl.local_clock()});
    source.receive_at(now_ns(), 0);
    EXPECT_TRUE(source.poll(lab.dive.simulation->inbox(), 1e-9 * now_ns()).ok());
    return lab.samples().size();
  };
  EXPECT_EQ(press(), 1u);
  lsl.presence("jacket", FakeLsl::kGoneForNow);
  EXPECT_EQ(press(), 0u);
  lsl.presence("jacket", FakeLsl::kThere);
  EXPECT_EQ(press(), 1u);
  lsl.presence("jacket", FakeLsl::kLost);
  EXPECT_EQ(press(), 0u);
  lsl.presence("jacket", FakeLsl::kThere);  // its sender was started again
  std::size_t found = 0;
  for (int i = 0; i < 100 && found == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    found = press();
  }
  EXPECT_GT(found, 0u);
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, WhatDoesNotFitIsRefusedInOneLine) {
  FakeLsl lsl;
  lsl.add("eight", 8);
  lsl.add("fast", 1, 1000.0);
  lsl.add("music", 1, 44100.0);
  const auto refusal_of = [](const std::string& line) {
    LslLab lab(line);
    const auto source = lab.open();
    EXPECT_FALSE(source.ok()) << line;
    return source.ok() ? std::string() : source.error().message;
  };
  EXPECT_EQ(refusal_of("jacket = \"jacket lsl eight\"\n"),
            "source jacket: LSL: eight: found 8 channels; accepted: 3 of a jacket");
  EXPECT_EQ(refusal_of("strap = \"strap lsl fast\"\n"),
            "source strap: LSL: fast: found 1000 samples a second; accepted: 130");
  EXPECT_EQ(refusal_of("mic = \"microphone lsl music\"\n"),
            "source mic: LSL: music: found 44100 samples a second; accepted: 16000");
  EXPECT_EQ(refusal_of("strap = \"strap lsl nobody\"\n"),
            "source strap: LSL: no stream nobody within 3 s");
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, MarkersLeaveWithTheTimeOfTheirArrival) {
  FakeLsl lsl;
  {
    const auto outlet = LslOutlet::create("neritic markers");
    ASSERT_TRUE(outlet.ok()) << outlet.error().message;
    const double before_s = lsl.local_clock();
    (*outlet)->send("trial 3 begins", 250 * kMillisecond_ns);
    const double after_s = lsl.local_clock();
    const std::string sent = lsl.markers("neritic markers");
    EXPECT_NE(sent.find(" trial 3 begins\n"), std::string::npos) << sent;
    const double arrived_s = std::stod(sent) + 0.25;
    EXPECT_GT(arrived_s, before_s - 1e-3);
    EXPECT_LT(arrived_s, after_s + 1e-3);
  }
  EXPECT_EQ(lsl.wrong_calls(), "");
}

TEST(LabStreamingLayer, NumbersThatAreNoneAndStampsThatJumpHarmNothing) {
  FakeLsl lsl;
  lsl.add("jacket", 3);
  LslLab lab("jacket = \"jacket lsl jacket\"\n");
  auto source = lab.open();
  ASSERT_TRUE(source.ok()) << source.error().message;
  const float nan = std::nanf("");
  for (const double stamp : {0.0, -1.0, 1e300, std::nan(""), -1e300, lsl.local_clock()}) {
    lsl.push("jacket", {nan, INFINITY, -INFINITY}, {stamp});
    (*source)->receive_at(now_ns(), 0);
    for (const Sample& sample : lab.samples()) EXPECT_TRUE(all_finite(sample.payload));
  }
  expect_adds_up((*source)->health().link);
  EXPECT_EQ(lsl.wrong_calls(), "");
}

}  // namespace
}  // namespace neritic::testbed
