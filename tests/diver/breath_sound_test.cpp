// Breath: rates of made-up and of recorded sounds, and the two threads.
#include <gtest/gtest.h>

#include <limits>

#include "diver/breath_monitor.hpp"
#include "diver/physio_wav.hpp"
#include "engine/core/files.hpp"
#include "tests/diver/physio_signals.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

constexpr double kSoundRate_hz = 8000.0;

// White noise times an envelope of bursts: in from 0 to 1.5 s, out from 2 to 3.5 s of every 4 s: 15
// breaths a minute.
std::vector<float> bursts(double in, double out, double seconds, double rate_hz = kSoundRate_hz) {
  std::vector<float> sound;
  for (std::size_t i = 0; i < static_cast<std::size_t>(seconds * rate_hz); ++i) {
    const double phase = std::fmod(static_cast<double>(i) / rate_hz, 4.0);
    const double size = phase < 1.5 ? in : phase >= 2.0 && phase < 3.5 ? out : 0.02;
    sound.push_back(static_cast<float>(0.1 * size * test::gauss({3}, i)));
  }
  return sound;
}

BreathState analysed(const std::vector<float>& sound, BreathEstimator estimator,
                     double rate_hz = kSoundRate_hz) {
  BreathAnalyser analyser(rate_hz, {estimator, 10.0, 30.0});
  return analyser.take(sound);
}

TEST(BreathSound, TheSpectrumFindsTwiceTheRateWhereInAndOutAreAlike) {
  const BreathState state = analysed(bursts(1.0, 1.0, 60.0), BreathEstimator::kSpectrum);
  EXPECT_TRUE(state.estimate.breathing);
  EXPECT_NEAR(state.estimate.rate_bpm, 30.0, 0.5);
}

TEST(BreathSound, UnequalPhasesAreTold) {
  for (const double out : {0.25, 0.6}) {
    const BreathState state = analysed(bursts(1.0, out, 60.0), BreathEstimator::kMultiBand);
    EXPECT_TRUE(state.estimate.breathing);
    EXPECT_NEAR(state.estimate.rate_bpm, 15.0, 0.5) << out;
  }
  EXPECT_NEAR(analysed(bursts(1.0, 0.25, 60.0), BreathEstimator::kSpectrum).estimate.rate_bpm, 15.0,
              0.5);
}

// A regulator: in, the valve's hiss above 1 kHz; out, bubbles below 500 Hz; both as loud.
TEST(BreathSound, ARegulatorsHissAndBubblesAreOneBreath) {
  for (const double rate_hz : {8000.0, 44100.0}) {
    auto hiss = SecondOrderFilter::high_pass(1000.0, rate_hz);
    auto bubbles = SecondOrderFilter::low_pass(500.0, rate_hz);
    std::vector<float> sound;
    for (std::size_t i = 0; i < static_cast<std::size_t>(40.0 * rate_hz); ++i) {
      const double phase = std::fmod(static_cast<double>(i) / rate_hz, 4.0);
      const double noise = test::gauss({5}, i);
      const double high = hiss.step(noise), low = 3.0 * bubbles.step(noise);
      sound.push_back(static_cast<float>(0.05 * (phase < 1.5                   ? high
                                                 : phase >= 2.0 && phase < 3.5 ? low
                                                                               : 0.02 * noise)));
    }
    const BreathState state = analysed(sound, BreathEstimator::kMultiBand, rate_hz);
    EXPECT_NEAR(state.estimate.rate_bpm, 15.0, 0.5) << rate_hz;
  }
}

TEST(BreathSound, APauseIsNoRate) {
  std::vector<float> sound = bursts(1.0, 0.5, 40.0);
  const std::vector<float> pause = bursts(0.02, 0.02, 12.0);
  sound.insert(sound.end(), pause.begin(), pause.end());
  for (const BreathEstimator e : {BreathEstimator::kSpectrum, BreathEstimator::kAutocorrelation,
                                  BreathEstimator::kMultiBand}) {
    BreathAnalyser analyser(kSoundRate_hz, {e, 10.0, 10.0});
    analyser.take(sound);
    const BreathState& state = analyser.take({});
    EXPECT_FALSE(state.estimate.breathing) << name_of(e);
    EXPECT_EQ(state.estimate.rate_bpm, 0.0);
    EXPECT_GE(state.quiet_s, 10.0);
  }
}

TEST(BreathSound, SilenceNoiseAndNothingAreNoBreath) {
  const std::vector<float> silence(160000, 0.0f), steady = bursts(1.0, 1.0, 0.0);
  EXPECT_FALSE(analysed(silence, BreathEstimator::kMultiBand).estimate.breathing);
  std::vector<float> noise;
  for (std::size_t i = 0; i < 240000; ++i)
    noise.push_back(static_cast<float>(0.1 * test::gauss({9}, i)));
  EXPECT_FALSE(analysed(noise, BreathEstimator::kMultiBand).estimate.breathing);
  EXPECT_FALSE(analysed({}, BreathEstimator::kMultiBand).estimate.breathing);
  EXPECT_FALSE(analysed({0.5f}, BreathEstimator::kSpectrum).estimate.breathing);
}

TEST(BreathSound, WhatIsNoNumberIsRefusedAndCounted) {
  std::vector<float> sound = bursts(1.0, 0.5, 40.0);
  const BreathState before = analysed(sound, BreathEstimator::kMultiBand);
  std::uint64_t bad = 0;
  for (std::size_t i = 777; i < sound.size(); i += 997) {
    sound[i] = i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : INFINITY;
    ++bad;
  }
  const BreathState after = analysed(sound, BreathEstimator::kMultiBand);
  EXPECT_EQ(after.refused, bad);
  EXPECT_NEAR(after.estimate.rate_bpm, before.estimate.rate_bpm, 0.2);
}

TEST(BreathMonitor, TwoThreadsGiveWhatOneDoes) {
  const std::vector<float> sound = bursts(1.0, 0.4, 100.0, 1000.0);
  const BreathSettings settings{BreathEstimator::kMultiBand, 2.0, 20.0};
  Recording recording{"", 1000.0};
  recording.samples.assign(sound.begin(), sound.end());
  const auto expected = analyse_breath(recording, settings);
  BreathMonitor monitor(1000.0, settings);
  std::size_t seen = 0;
  // In pieces of a size that fits nothing, as from a sound card.
  for (std::size_t from = 0; from < sound.size(); from += 173) {
    const std::size_t count = std::min<std::size_t>(173, sound.size() - from);
    monitor.record(std::span(sound).subspan(from, count));
    monitor.wait();
    const BreathState& state = monitor.state();
    if (state.blocks == seen) continue;
    ASSERT_EQ(state.blocks, ++seen);
    EXPECT_EQ(state.estimate.rate_bpm, expected[seen - 1].estimate.rate_bpm);
    EXPECT_EQ(state.time_s, expected[seen - 1].time_s);
    EXPECT_EQ(state.lost_blocks, 0u);
  }
  EXPECT_EQ(seen, expected.size());
  EXPECT_NEAR(expected.back().estimate.rate_bpm, 15.0, 0.5);
}

// Recorded far faster than any analysis: blocks are lost, every one is counted, nobody waits.
TEST(BreathMonitor, WhatCannotBeAnalysedInTimeIsLostAndCounted) {
  BreathMonitor monitor(1000.0, {BreathEstimator::kMultiBand, 0.5, 60.0});
  const std::vector<float> sound = bursts(1.0, 0.4, 0.5, 1000.0);
  constexpr std::uint64_t kBlocks = 3000;
  for (std::uint64_t i = 0; i < kBlocks; ++i) monitor.record(sound);
  monitor.wait();
  monitor.record(sound);  // carries the count of those lost at the end
  monitor.wait();
  const BreathState& state = monitor.state();
  EXPECT_EQ(state.blocks + state.lost_blocks, kBlocks + 1);
  EXPECT_GT(state.blocks, 1u);
}

TEST(BreathMonitor, EndsWhileItWorks) {
  for (int i = 0; i < 20; ++i) {
    BreathMonitor monitor(1000.0, {BreathEstimator::kSpectrum, 0.5, 60.0});
    monitor.record(bursts(1.0, 0.4, 3.0, 1000.0));
  }
}

struct WindowErrors {
  std::vector<double> sizes;
  int refused = 0, doubled = 0;
  double median() {
    std::ranges::sort(sizes);
    return sizes[sizes.size() / 2];
  }
  double within(double bpm) const {
    return static_cast<double>(std::ranges::count_if(sizes, [&](double e) { return e <= bpm; })) /
           static_cast<double>(sizes.size());
  }
};

WindowErrors errors_of(const std::filesystem::path& folder, BreathEstimator estimator,
                       double window_s) {
  WindowErrors out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".wav") continue;
    const double true_bpm = std::stod(name.substr(name.find('_') + 1));
    const auto sound = parse_wav(*read_file(entry.path()), name, 0);
    for (const BreathState& state : analyse_breath(*sound, {estimator, 10.0, window_s})) {
      if (state.time_s < window_s - 1e-6) continue;
      if (!state.estimate.breathing) {
        ++out.refused;
        continue;
      }
      out.sizes.push_back(std::abs(state.estimate.rate_bpm - true_bpm));
      out.doubled += state.estimate.rate_bpm > 1.6 * true_bpm;
    }
  }
  return out;
}

// Breaths paced by a metronome. Of the whole set of 30 recordings it is published that the plain
// spectrum is off by 11 to 12 (80 to 90 % doubled), and multi-band autocorrelation by .77 to .84 at
// 10 s (62 % within 2) and .13 to .2 at 30 s (68 to 81 %); here are ten of them.
TEST(BreathRecordings, BandsHalveTheErrorOfThePlainSpectrumAndMore) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto folder = shared / "data" / "recordings" / "breath_paced";
  struct Row {
    double window_s, most_median, least_within_2;
  };
  for (const Row& row : {Row{10.0, 1.2, 0.54}, Row{20.0, 0.8, 0.55}, Row{30.0, 0.3, 0.65}}) {
    WindowErrors plain = errors_of(folder, BreathEstimator::kSpectrum, row.window_s);
    WindowErrors bands = errors_of(folder, BreathEstimator::kMultiBand, row.window_s);
    SCOPED_TRACE(fmt::format("{} s: {} of {}", row.window_s, bands.sizes.size(),
                             bands.sizes.size() + static_cast<std::size_t>(bands.refused)));
    EXPECT_LT(bands.median(), row.most_median);
    EXPECT_GT(bands.within(2.0), row.least_within_2);
    EXPECT_GT(plain.median(), 5.0 * bands.median());
    EXPECT_GT(plain.doubled, 2 * bands.doubled);
    EXPECT_GT(bands.sizes.size(), 2 * static_cast<std::size_t>(bands.refused));
  }
}

}  // namespace
}  // namespace neritic::diver
