// Gaze: angles, pixels, fixations and saccades, against closed forms and a person's marks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "diver/gaze_csv.hpp"
#include "engine/core/files.hpp"
#include "engine/core/random.hpp"
#include "tests/diver/physio_signals.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

TEST(GazeAngle, IsExactNearZeroAndNoNumberNowhere) {
  const Vec3 ahead(0.0, 0.0, -1.0);
  EXPECT_NEAR(degrees(angle_between(ahead, Vec3(0.01745240643728351, 0.0, -0.9998476951563913))),
              1.0, 1e-12);
  EXPECT_EQ(angle_between(ahead, ahead), 0.0);
  const Vec3 tiny(1e-9, 0.0, -1.0);
  EXPECT_NEAR(angle_between(ahead, tiny), 1e-9, 1e-18);  // acos gives 0
  EXPECT_NEAR(angle_between(ahead, -ahead), kPi, 1e-15);
  const Vec3 odd = glm::normalize(Vec3(0.3, -0.7, 0.2));
  EXPECT_EQ(angle_between(odd, odd), 0.0);
}

TEST(GazePixel, IsWhereAPinholeShowsWhatIsLookedAt) {
  const GazeCamera here{{}, 500.0, 400.0, 320.5, 240.5};
  const auto middle = gaze_pixel(Vec3(0.0), Vec3(0.0, 0.0, -1.0), 1e300 * 1e300, here);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x, 320.5, 1e-12);
  EXPECT_NEAR(middle->y, 240.5, 1e-12);
  const auto off = gaze_pixel(Vec3(0.0), Vec3(0.1, 0.2, -1.0), INFINITY, here);
  ASSERT_TRUE(off);
  EXPECT_NEAR(off->x, 320.5 + 50.0, 1e-9);
  EXPECT_NEAR(off->y, 240.5 - 80.0, 1e-9);  // row 0 on top
  // A camera 1 m to the right, turned to look back at the gaze's end from the other side.
  const Vec3 target(0.2, 0.1, -5.0);
  const GazeCamera other{look_at(Vec3(1.0, 0.0, -9.0), target), 600.0, 600.0, 100.0, 50.0};
  const auto seen = gaze_pixel(Vec3(0.0), target, glm::length(target), other);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->x, 100.0, 1e-9);
  EXPECT_NEAR(seen->y, 50.0, 1e-9);
  EXPECT_FALSE(gaze_pixel(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 2.0, here));
}

// Two fixations of 300 ms and a minimum-jerk saccade of 10 degrees in 43 ms between, at 1 kHz.
std::vector<GazeSample> ten_degrees() {
  std::vector<GazeSample> out;
  for (int i = 0; i <= 643; ++i) {
    const double s = std::clamp((i - 300.0) / 43.0, 0.0, 1.0);
    const double x = 10.0 * (10.0 * s * s * s - 15.0 * s * s * s * s + 6.0 * s * s * s * s * s);
    out.push_back({1e-3 * i, direction_of_angles(radians(x), 0.0)});
  }
  return out;
}

TEST(GazeByVelocity, OneSaccadeBetweenTwoFixations) {
  GazeSettings settings;
  settings.velocity_window_s = 0.002;  // the plain central difference
  const auto samples = ten_degrees();
  ASSERT_EQ(samples.size(), 644u);
  const GazeEvents events = find_gaze_events(samples, settings);
  ASSERT_EQ(events.fixations.size(), 2u);
  ASSERT_EQ(events.saccades.size(), 1u);
  EXPECT_EQ(std::ranges::count(events.classes, GazeClass::kSaccade), 38);
  EXPECT_NEAR(degrees(events.saccades[0].peak_rad_s), 434.94753563235867, 1e-6);
  EXPECT_NEAR(degrees(events.saccades[0].amplitude_rad), 10.0, 0.1);
  EXPECT_NEAR(degrees(angle_between(events.fixations[0].direction, events.fixations[1].direction)),
              10.0, 0.02);
  EXPECT_NEAR(events.fixations[0].end_s - events.fixations[0].start_s, 0.300, 0.005);
  EXPECT_FALSE(events.fixations[0].may_be_pursuit);
  const GazeEvents usual = find_gaze_events(samples, {});
  EXPECT_EQ(usual.fixations.size(), 2u);
  EXPECT_EQ(usual.saccades.size(), 1u);
}

// An eye that looks at 132 places for 0.2 to 0.6 s each, with 131 saccades of 2 to 15 degrees whose
// durations are Carpenter's (1988: 2.2 ms a degree and 21 ms) and whose shape is of minimum jerk;
// and normal noise on both axes of each sample. Drift: of the head, degrees a second.
constexpr int kSaccades = 131;
std::vector<GazeSample> noisy_gaze(double rate_hz, double noise_deg, double drift_deg_s = 0.0) {
  auto uniform = [n = std::uint64_t{0}](double from, double to) mutable {
    return from + (to - from) * random_uniform({5, 6, 7}, n++);
  };
  struct Leg {
    double start_s, seconds;
    Vec2 from, to;
  };
  std::vector<Leg> legs;
  double t = 0.0;
  Vec2 at(0.0);
  for (int i = 0; i < kSaccades; ++i) {
    t += uniform(0.2, 0.6);
    const double size = uniform(2.0, 15.0), turn = uniform(0.0, 2.0 * kPi);
    Vec2 to = at + size * Vec2(std::cos(turn), std::sin(turn));
    if (glm::length(to) > 20.0) to = at - size * glm::normalize(at);
    legs.push_back({t, 0.021 + 0.0022 * size, at, to});
    t += legs.back().seconds;
    at = to;
  }
  std::vector<GazeSample> out;
  std::size_t leg = 0;
  for (int i = 0; i / rate_hz < t + 0.4; ++i) {
    const double now = i / rate_hz;
    while (leg + 1 < legs.size() && now >= legs[leg + 1].start_s) ++leg;
    const Leg& l = legs[leg];
    const double s = std::clamp((now - l.start_s) / l.seconds, 0.0, 1.0);
    const double done = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    const auto n = static_cast<std::uint64_t>(i);
    const Vec2 seen = l.from + done * (l.to - l.from) +
                      noise_deg * Vec2(test::gauss({8, 9, 1}, n), test::gauss({8, 9, 2}, n));
    const double head = std::remainder(drift_deg_s * now, 60.0);
    out.push_back({now, glm::angleAxis(radians(head), Vec3(0, 1, 0)) *
                            direction_of_angles(radians(seen.x), radians(seen.y))});
  }
  return out;
}

// Plain I-VT finds 205 of 131 at 0.15 degrees and 200 Hz, and 2180 at 0.3 degrees and 500 Hz. Here
// the count is right within 3 %, or the velocity asked says which saccades are missed; noise is
// never taken for saccades.
TEST(GazeByVelocity, SaccadesAreCountedThroughNoise) {
  for (const double rate_hz : {60.0, 200.0, 500.0})
    for (const double noise_deg : {0.0, 0.05, 0.15, 0.3}) {
      SCOPED_TRACE(fmt::format("{} Hz, {} deg", rate_hz, noise_deg));
      GazeMonitor monitor{GazeSettings{}};
      GazeEvents events;
      for (const GazeSample& sample : noisy_gaze(rate_hz, noise_deg)) monitor.push(sample, events);
      monitor.finish(events);
      const GazeNoiseFound noise = monitor.noise();
      const double found = static_cast<double>(events.saccades.size());
      EXPECT_NEAR(degrees(noise.deviation_rad), noise_deg, 0.1 * noise_deg + 1e-6);
      EXPECT_LE(found, 1.03 * kSaccades);
      if (noise_deg <= 0.15) {
        EXPECT_GE(found, 0.97 * kSaccades);
      } else {
        EXPECT_GT(degrees(smallest_saccade_rad(noise)), rate_hz > 400.0 ? 0.9 : 1.5);
      }
      EXPECT_GE(found, 0.9 * kSaccades);
      EXPECT_EQ(events.blinks.size(), 0u);
    }
}

// An eye that follows something is no noise.
TEST(GazeByVelocity, NoiseIsToldFromPursuit) {
  GazeNoise noise;
  for (int i = 0; i < 1000; ++i)
    noise.push(0.005 * i, direction_of_angles(radians(-40.0 + 0.08 * i), 0.0));
  EXPECT_LT(degrees(noise.deviation_rad()), 1e-3);
  GazeNoise shaken;
  for (const GazeSample& sample : noisy_gaze(200.0, 0.1, 20.0))
    shaken.push(sample.time_s, sample.direction);
  EXPECT_NEAR(degrees(shaken.deviation_rad()), 0.1, 0.02);
}

// A tracker that does not say when it lost the eye: the lid's spike is faster than any eye.
TEST(GazeByVelocity, WhatIsFasterThanAnyEyeIsABlink) {
  std::vector<GazeSample> samples = ten_degrees();
  for (int i = 100; i < 160; ++i) {
    const double share = std::min({1.0, (i - 100) / 8.0, (160 - i) / 8.0});
    samples[static_cast<std::size_t>(i)].direction =
        direction_of_angles(0.0, radians(-14.0 * share));
  }
  const GazeEvents events = find_gaze_events(samples, {});
  ASSERT_EQ(events.saccades.size(), 1u);
  EXPECT_NEAR(degrees(events.saccades[0].amplitude_rad), 10.0, 0.5);
  EXPECT_EQ(events.blinks.size(), 2u);  // down and up
}

TEST(GazeByDispersion, OneSaccadeBetweenTwoFixations) {
  for (GazeSettings settings :
       {headset_gaze(GazeMethod::kDispersion), GazeSettings{.method = GazeMethod::kDispersion}}) {
    const GazeEvents events = find_gaze_events(ten_degrees(), settings);
    ASSERT_EQ(events.fixations.size(), 2u);
    EXPECT_EQ(events.saccades.size(), 1u);
    EXPECT_EQ(events.classes.size(), 644u);
    EXPECT_NEAR(
        degrees(angle_between(events.fixations[0].direction, events.fixations[1].direction)), 10.0,
        0.2);
  }
}

// Faster than the tracker: no sample lies between two fixations.
TEST(GazeByDispersion, ALeapBetweenTwoSamplesIsASaccade) {
  std::vector<GazeSample> samples;
  for (int i = 0; i < 100; ++i)
    samples.push_back({0.01 * i, direction_of_angles(i < 50 ? 0.0 : radians(20.0), 0.0)});
  for (const GazeMethod method : {GazeMethod::kDispersion, GazeMethod::kVelocity}) {
    const GazeEvents events = find_gaze_events(samples, headset_gaze(method));
    ASSERT_EQ(events.fixations.size(), 2u);
    ASSERT_EQ(events.saccades.size(), 1u);
    EXPECT_NEAR(degrees(events.saccades[0].amplitude_rad), 20.0, 1e-6);
    EXPECT_GT(degrees(events.saccades[0].peak_rad_s), 900.0);
  }
}

// The published trap: a dot at 20 degrees a second. Neither answer is right, and the output says
// so.
TEST(GazeByVelocity, PursuitIsOneFixationThatIsMarked) {
  std::vector<GazeSample> samples;
  for (int i = 0; i < 1000; ++i)
    samples.push_back({1e-3 * i, direction_of_angles(radians(-10.0 + 0.02 * i), 0.0)});
  const GazeEvents events = find_gaze_events(samples, {});
  ASSERT_EQ(events.fixations.size(), 1u);
  EXPECT_TRUE(events.fixations[0].may_be_pursuit);
  GazeSettings dispersion;
  dispersion.method = GazeMethod::kDispersion;
  EXPECT_NE(find_gaze_events(samples, dispersion).fixations.size(), 1u);
}

// An eye that the tracker did not see is no gaze, in whatever words it says so.
TEST(GazeCsv, WordsOfAStatusAreReadAndOthersRefused) {
  const auto valid = [](const char* word) {
    const auto gaze =
        parse_gaze_csv(fmt::format("t_s,x_deg,y_deg,status\n0,1,1,{}\n", word), "a.csv", 0.0);
    EXPECT_TRUE(gaze.ok()) << gaze.error().message;
    return gaze->samples[0].valid;
  };
  for (const char* word : {"1", "true", "True", "yes", "VALID", "2"})
    EXPECT_TRUE(valid(word)) << word;
  for (const char* word : {"0", "false", "False", "no", "Invalid", "", "nan"})
    EXPECT_FALSE(valid(word)) << word;
  EXPECT_THAT(
      parse_gaze_csv("t_s,x_deg,y_deg,valid\n0,1,1,1\n1,1,1,blink\n", "a.csv", 0.0).error().message,
      testing::HasSubstr("a.csv:3: found valid 'blink'; accepted: true, false or a number"));
}

// A screen ends before the side: such angles are no other direction.
TEST(GazeCsv, AnglesThatNoScreenHasAreRefusedAndCounted) {
  const auto gaze = parse_gaze_csv(
      "t_s,x_deg,y_deg\n0,89,0\n0.01,90,0\n0.02,135,0\n0.03,-100,0\n0.04,0,91\n0.05,180,0\n",
      "a.csv", 0.0);
  ASSERT_TRUE(gaze.ok());
  GazeMonitor monitor{GazeSettings{}};
  GazeEvents events;
  for (const GazeSample& sample : gaze->samples) monitor.push(sample, events);
  EXPECT_EQ(monitor.state().refused, 5u);
  EXPECT_NEAR(degrees(std::atan2(monitor.state().direction.x, -monitor.state().direction.z)), 89.0,
              1e-9);
}

TEST(GazeMonitor, WhatIsNoGazeIsRefusedCountedAndTheLastGoodOneHeld) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  GazeMonitor monitor({});
  GazeEvents events;
  const Vec3 good(0.6, 0.0, -0.8);
  for (int i = 0; i < 50; ++i) monitor.push({0.005 * i, good}, events);
  const GazeSample bad[] = {{nan, good},      {1.0, Vec3(nan, 0.0, 0.0)},
                            {1.0, Vec3(0.0)}, {1.0, Vec3(INFINITY, 0.0, 0.0)},
                            {-5.0, good},     {1e30, good}};
  for (const GazeSample& sample : bad) monitor.push(sample, events);
  EXPECT_EQ(monitor.state().refused, std::size(bad));
  EXPECT_EQ(monitor.state().direction, good);
  for (int i = 50; i < 100; ++i) monitor.push({0.005 * i, good}, events);
  EXPECT_GT(monitor.state().fixated_s, 0.3);
  monitor.finish(events);
  EXPECT_EQ(events.classes.size(), 100u + std::size(bad));
}

TEST(GazeMonitor, AClockThatWasOnceWrongIsForgiven) {
  GazeMonitor monitor({});
  GazeEvents events;
  monitor.push({1e11, Vec3(0.0, 0.0, -1.0)}, events);
  for (int i = 0; i < 100; ++i) monitor.push({0.01 * i, Vec3(0.0, 0.0, -1.0)}, events);
  EXPECT_LE(monitor.state().refused, 20u);
  EXPECT_GT(monitor.state().fixated_s, 0.5);
}

TEST(GazeMonitor, ALongBlinkPartsFixationsAndAShortOneDoesNot) {
  for (const int blink_ms : {50, 300}) {
    std::vector<GazeSample> samples;
    for (int i = 0; i < 200; ++i) {
      const bool blind = i * 5 >= 400 && i * 5 < 400 + blink_ms;
      samples.push_back({0.005 * i, Vec3(0.0, 0.0, -1.0), !blind});
    }
    const GazeEvents events = find_gaze_events(samples, {});
    EXPECT_EQ(events.fixations.size(), blink_ms == 50 ? 1u : 2u);
    EXPECT_EQ(std::ranges::count(events.classes, GazeClass::kLost), blink_ms / 5);
    EXPECT_EQ(events.classes.size(), samples.size());
  }
}

// Gaze that leaps anywhere at any rate: no number that is not one, and classes for every sample.
TEST(GazeMonitor, StaysFiniteWhateverComes) {
  for (const double rate_hz : {1.0, 30.0, 1000.0, 1e6})
    for (const GazeMethod method : {GazeMethod::kVelocity, GazeMethod::kDispersion}) {
      GazeMonitor monitor(headset_gaze(method));
      GazeEvents events;
      constexpr int kCount = 3000;
      for (int i = 0; i < kCount; ++i) {
        const auto turn = [&](int k) { return 2.0 * random_uniform({1, 2, 3}, 3 * i + k) - 1.0; };
        monitor.push({i / rate_hz, Vec3(turn(0), turn(1), turn(2)), i % 7 != 0}, events);
        ASSERT_TRUE(std::isfinite(monitor.state().velocity_rad_s));
        ASSERT_TRUE(is_finite(monitor.state().fixation));
      }
      monitor.finish(events);
      EXPECT_EQ(events.classes.size(), static_cast<std::size_t>(kCount));
    }
}

// Sample by sample against a person's marks; plain I-VT at 30 degrees a second is said to reach
// 0.71.
TEST(EyeRecording, SaccadesAgreeWithAPersonsMarksBetterThanPlainVelocityDoes) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto path = shared / "data" / "recordings" / "eye_fixations" / "lookAtPoint_EL_S1_30s.csv";
  const auto recording = parse_gaze_csv(*read_text(path), "eye.csv", 0.0);
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  ASSERT_EQ(recording->samples.size(), 30000u);
  ASSERT_EQ(recording->marks.size(), 30000u);
  std::vector<bool> marked;
  for (const int mark : recording->marks) marked.push_back(mark == 2);
  const GazeEvents events = find_gaze_events(recording->samples, {});
  ASSERT_EQ(events.classes.size(), marked.size());
  std::vector<bool> found;
  for (const GazeClass c : events.classes) found.push_back(c == GazeClass::kSaccade);
  EXPECT_GE(saccade_kappa(marked, found), 0.71);
  // Without the blinks and the noise among them the saccades that are told agree better.
  EXPECT_NEAR(saccade_kappa(marked, in_saccades(recording->samples, events.saccades)), 0.876, 5e-3);
  // The person marked eight blinks; saccades are where the person saw some, or the eye settle.
  EXPECT_EQ(events.blinks.size(), 8u);
  for (const Saccade& s : events.saccades) {
    bool eye = false;
    for (std::size_t i = 0; i < marked.size(); ++i) {
      const double t = recording->samples[i].time_s;
      if (t < s.start_s || t > s.end_s) continue;
      eye = eye || recording->marks[i] == 2 || recording->marks[i] == 3;
      EXPECT_NE(recording->marks[i], 5) << t;
    }
    EXPECT_TRUE(eye) << s.start_s;
    // Bahill 1975: of 30 degrees some 550 deg/s, with a spread of half as much again.
    EXPECT_LT(degrees(s.peak_rad_s), 700.0);
  }
  // A person who looks at points does so for a few hundred milliseconds each.
  EXPECT_GT(events.fixations.size(), 30u);
  EXPECT_LT(events.fixations.size(), 90u);
}

}  // namespace
}  // namespace neritic::diver
