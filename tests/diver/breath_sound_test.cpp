// Breath: rates of made-up and of recorded sounds, and the two threads.
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "diver/breath_monitor.hpp"
#include "tests/diver/physio_signals.hpp"

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

// In for 0.4 of a breath, hissing, and out for 0.4 of it, bubbling; or in alone.
std::vector<float> slow_breath(double rate_bpm, bool out_is_heard, double seconds) {
  constexpr double kRate_hz = 2000.0;
  auto hiss = SecondOrderFilter::high_pass(400.0, kRate_hz);
  auto bubbles = SecondOrderFilter::low_pass(200.0, kRate_hz);
  std::vector<float> sound;
  for (std::size_t i = 0; i < static_cast<std::size_t>(seconds * kRate_hz); ++i) {
    const double share = std::fmod(static_cast<double>(i) / kRate_hz * rate_bpm / 60.0, 1.0);
    const double noise = test::gauss({7}, i);
    const double high = hiss.step(noise), low = 3.0 * bubbles.step(noise);
    const bool in = share < 0.4, out = out_is_heard && share >= 0.5 && share < 0.9;
    sound.push_back(static_cast<float>(0.05 * (in ? high : out ? low : 0.02 * noise)));
  }
  return sound;
}

TEST(BreathSound, SlowBreathIsRightOrRefusedAndNeverDoubled) {
  for (const bool out_is_heard : {true, false})
    for (const double rate_bpm : {3.0, 4.0, 5.5}) {
      SCOPED_TRACE(fmt::format("{} a minute, out {}", rate_bpm, out_is_heard));
      Recording sound{"", 2000.0};
      const std::vector<float> samples = slow_breath(rate_bpm, out_is_heard, 120.0);
      sound.samples.assign(samples.begin(), samples.end());
      const std::vector<BreathState> states = analyse_breath(sound, {});
      for (const BreathState& state : states) {
        if (state.estimate.breathing) {
          EXPECT_NEAR(state.estimate.rate_bpm, rate_bpm, 0.4) << state.time_s << " s";
        }
      }
      // In alone looks like many rhythms at once: it may stay refused.
      if (out_is_heard) {
        EXPECT_TRUE(states.back().estimate.breathing);
      }
    }
}

// In swells and fades for 0.35 of a breath, out for 0.45 of it: a window of 20 s, which two breaths
// do not fit into, took halves for breaths.
TEST(BreathSound, SlowBreathThatSwellsAndFadesIsNeverDoubled) {
  constexpr double kRate_hz = 2000.0;
  for (const double rate_bpm : {3.0, 4.0, 5.0}) {
    auto hiss = SecondOrderFilter::high_pass(300.0, kRate_hz);
    auto bubbles = SecondOrderFilter::low_pass(300.0, kRate_hz);
    Recording sound{"", kRate_hz};
    for (std::size_t i = 0; i < static_cast<std::size_t>(180.0 * kRate_hz); ++i) {
      const double share = std::fmod(static_cast<double>(i) / kRate_hz * rate_bpm / 60.0, 1.0);
      const double noise = test::gauss({13}, i), high = hiss.step(noise), low = bubbles.step(noise);
      const double in = share < 0.35 ? std::sin(kPi * share / 0.35) : 0.0;
      const double out = share > 0.4 && share < 0.85 ? std::sin(kPi * (share - 0.4) / 0.45) : 0.0;
      sound.samples.push_back(0.3 * in * high + 0.6 * out * low + 0.002 * test::gauss({14}, i));
    }
    int right = 0;
    for (const BreathState& state : analyse_breath(sound, {})) {
      if (!state.estimate.breathing) continue;
      EXPECT_NEAR(state.estimate.rate_bpm, rate_bpm, 0.3) << rate_bpm << ", " << state.time_s;
      ++right;
    }
    EXPECT_GE(right, 5) << rate_bpm;
  }
}

// In and out are the same noise, out quieter by that factor; the gain drifts, and noise is added.
std::vector<float> halves(double rate_bpm, double out, double share, double drift, double noise) {
  constexpr double kRate_hz = 2000.0;
  std::vector<float> sound;
  for (std::size_t i = 0; i < static_cast<std::size_t>(50.0 * kRate_hz); ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    const double turn = std::fmod(t * rate_bpm / 60.0, 1.0);
    const double level = std::fmod(turn, 0.5) < share ? (turn < 0.5 ? 1.0 : out) : 0.0;
    const double gain = std::exp(drift * std::sin(2.0 * kPi * t / 70.0));
    sound.push_back(static_cast<float>(
        0.1 * (gain * level * test::gauss({11}, i) + noise * test::gauss({12}, i))));
  }
  return sound;
}

struct HalvesHeard {
  int right = 0, wrong = 0;
  double last_confidence = 0.0;
};
HalvesHeard hear_halves(double rate_bpm, const std::vector<float>& samples) {
  Recording sound{"", 2000.0};
  sound.samples.assign(samples.begin(), samples.end());
  HalvesHeard out;
  for (const BreathState& state : analyse_breath(sound, {})) {
    const double off = std::abs(state.estimate.rate_bpm - rate_bpm);
    if (state.estimate.breathing) ++(off < 0.06 * rate_bpm ? out.right : out.wrong);
    out.last_confidence = state.estimate.confidence;
  }
  return out;
}

TEST(BreathSound, HalvesThatAreNearlyEqualAreOneBreath) {
  struct Case {
    double out, share, drift, noise;
  };
  for (const double rate_bpm : {10.0, 15.0, 20.0})
    for (const Case& c : {Case{0.9, 0.375, 0.0, 0.02}, Case{0.8, 0.375, 0.5, 0.02},
                          Case{0.6, 0.375, 0.0, 0.2}, Case{0.9, 0.3, 0.0, 0.2}}) {
      SCOPED_TRACE(fmt::format("{} a minute, out {}, share {}", rate_bpm, c.out, c.share));
      const HalvesHeard heard =
          hear_halves(rate_bpm, halves(rate_bpm, c.out, c.share, c.drift, c.noise));
      EXPECT_EQ(heard.wrong, 0);
      EXPECT_GE(heard.right, 2);
    }
}

TEST(BreathSound, HalvesThatAreEqualAreNoRateAndNoConfidence) {
  for (const double rate_bpm : {6.0, 12.0, 15.0, 25.0, 40.0}) {
    SCOPED_TRACE(rate_bpm);
    const HalvesHeard heard = hear_halves(rate_bpm, halves(rate_bpm, 1.0, 0.375, 0.0, 0.05));
    EXPECT_EQ(heard.wrong, 0);
    if (heard.right == 0) {
      EXPECT_LT(heard.last_confidence, 0.9);
    }
  }
}

// Open circuit: in, a hiss above 400 Hz for that share of a breath; out, bubbles below 200 Hz, as
// loud; each breath as long and as loud as that deviation lets it be; water noise.
struct MadeBreath {
  const char* name;
  double in, out, pause, in_size, out_size;
  bool alike = false;  // in and out are the same white noise
};
const std::vector<double>& white_noise(std::uint64_t which) {
  static std::map<std::uint64_t, std::vector<double>> all;
  std::vector<double>& noise = all[which];
  for (std::size_t i = noise.size(); i < 240000; ++i) noise.push_back(test::gauss({16 + which}, i));
  return noise;
}
Recording made_breath(const MadeBreath& kind, double rate_bpm, double deviation, double noise,
                      double seconds, std::uint64_t seed = 0) {
  constexpr double kRate_hz = 2000.0;
  auto hiss = SecondOrderFilter::high_pass(400.0, kRate_hz), sharper = hiss;
  auto bubbles = SecondOrderFilter::low_pass(200.0, kRate_hz), duller = bubbles;
  Recording sound{"", kRate_hz};
  const std::vector<double>&whites = white_noise(2 * seed), &others = white_noise(2 * seed + 1);
  std::uint64_t draw = 0;
  const auto varied = [&] {
    return std::clamp(deviation * test::gauss({15 + 100 * seed}, draw++), -0.6, 0.6);
  };
  double began_s = 0.0, lasts_s = 0.0, in_size = 0.0, out_size = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(seconds * kRate_hz); ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    if (t >= began_s + lasts_s) {
      began_s += lasts_s;
      lasts_s = 60.0 / rate_bpm * (1.0 + varied());
      in_size = kind.in_size * std::exp(varied());
      out_size = kind.out_size * std::exp(varied());
    }
    const double share = (t - began_s) / lasts_s, after = share - kind.in - kind.pause;
    const double in = share < kind.in ? std::sin(kPi * share / kind.in) : 0.0;
    const double out = after > 0.0 && after < kind.out ? std::sin(kPi * after / kind.out) : 0.0;
    const double white = whites[i];
    const double high = kind.alike ? white : 1.3 * sharper.step(hiss.step(white));
    const double low = kind.alike ? white : 2.3 * duller.step(bubbles.step(white));
    sound.samples.push_back(0.1 * (in * in_size * high + out * out_size * low + noise * others[i]));
  }
  return sound;
}

struct RatesHeard {
  int right = 0, halved = 0, doubled = 0, refused = 0;
};
void hear(const Recording& sound, double rate_bpm, double window_s, RatesHeard& out,
          BreathEstimator estimator = BreathEstimator::kMultiBand) {
  for (const BreathState& state :
       analyse_breath(sound, {.estimator = estimator, .window_s = window_s})) {
    const double share = state.estimate.rate_bpm / rate_bpm;
    if (quality_of(state.estimate, estimator) != BreathQuality::kGood)
      ++out.refused;
    else if (share < 0.65)
      ++out.halved;
    else if (share > 1.55)
      ++out.doubled;
    else
      out.right += std::abs(share - 1.0) < 0.2;
  }
}

constexpr MadeBreath kEven{"1:1", 0.4, 0.4, 0.1, 1.0, 1.0},
    kPaused{"1:2", 0.25, 0.5, 0.03, 1.0, 1.5}, kLongOut{"1:3", 0.18, 0.54, 0.06, 1.5, 1.0},
    kInAlone{"in", 0.35, 0.0, 0.0, 1.0, 0.0}, kAlike{"alike", 0.4, 0.4, 0.1, 1.0, 1.0, true},
    kNearlyAlike{"nearly alike", 0.4, 0.4, 0.1, 1.0, 0.8, true};

TEST(BreathSound, NoRateIsHalvedOrDoubled) {
  RatesHeard all;
  int blocks = 0;
  for (const MadeBreath& kind : {kEven, kPaused, kLongOut, kInAlone})
    for (const double rate_bpm : {3.0, 6.0, 12.0, 25.0})
      for (const double deviation : {0.05, 0.15})
        for (const double noise : {0.1, 0.5}) {
          const Recording sound = made_breath(kind, rate_bpm, deviation, noise, 60.0);
          for (const double window_s : {20.0, 45.0}) {
            RatesHeard heard;
            hear(sound, rate_bpm, window_s, heard);
            EXPECT_EQ(heard.halved + heard.doubled, 0)
                << kind.name << ", " << rate_bpm << " a minute, deviation " << deviation
                << ", noise " << noise << ", window " << window_s << ": " << heard.halved
                << " halved, " << heard.doubled << " doubled";
            all.right += heard.right;
            blocks += 6;
          }
        }
  EXPECT_GT(all.right, 0.5 * blocks) << all.right << " of " << blocks;
}

// In and out that are alike, in water that is as loud: noise hides the flanks of their bursts,
// which then look like those of one short sound a breath.
TEST(BreathSound, HalvesThatAreAlikeInNoiseAreNoRate) {
  RatesHeard all;
  for (const MadeBreath& kind : {kAlike, kNearlyAlike})
    for (const double rate_bpm : {4.0, 8.0, 12.0})
      for (const std::uint64_t seed : {1, 2})
        hear(made_breath(kind, rate_bpm, 0.1, 0.5, 60.0, seed), rate_bpm, 20.0, all);
  EXPECT_EQ(all.halved + all.doubled, 0) << all.halved << " halved, " << all.doubled << " doubled";
}

// The envelope alone finds twice the rate of breaths whose halves are as loud, and half of it where
// breaths differ.
TEST(BreathSound, TheAutocorrelationRefusesWhatItCannotTellApart) {
  constexpr BreathEstimator kEstimator = BreathEstimator::kAutocorrelation;
  RatesHeard all;
  int blocks = 0;
  for (const MadeBreath& kind : {kEven, kPaused, kLongOut, kInAlone, kAlike, kNearlyAlike})
    for (const double rate_bpm : {3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 20.0, 30.0, 40.0})
      for (const double noise : {0.1, 0.5})
        for (std::uint64_t seed = 1; seed <= (test::is_thorough() ? 2u : 1u); ++seed) {
          RatesHeard heard;
          hear(made_breath(kind, rate_bpm, 0.1, noise, 60.0, seed), rate_bpm, 20.0, heard,
               kEstimator);
          EXPECT_EQ(heard.halved + heard.doubled, 0)
              << kind.name << ", " << rate_bpm << " a minute, noise " << noise << ", seed " << seed
              << ": " << heard.halved << " halved, " << heard.doubled << " doubled";
          all.right += heard.right;
          blocks += 6;
        }
  EXPECT_GT(all.right, 0.3 * blocks) << all.right << " of " << blocks;
}

// Faster than any rate that is given: the first windows took every second breath for one.
TEST(BreathSound, PantingIsNoRate) {
  for (const MadeBreath& kind : {kEven, kPaused, kLongOut, kInAlone, kAlike})
    for (const double rate_bpm : {55.0, 60.0, 65.0, 70.0, 75.0})
      for (const double deviation : {0.0, 0.1}) {
        RatesHeard heard;
        hear(made_breath(kind, rate_bpm, deviation, 0.1, 40.0, 1), rate_bpm, 20.0, heard);
        EXPECT_EQ(heard.refused, 4) << kind.name << ", " << rate_bpm << " a minute";
      }
}

TEST(BreathSound, TheQualityIsGoodOfASureRateAlone) {
  const BreathState sure = analysed(bursts(1.0, 0.6, 60.0), BreathEstimator::kMultiBand);
  EXPECT_EQ(quality_of(sure.estimate, BreathEstimator::kMultiBand), BreathQuality::kGood);
  const BreathState doubled = analysed(bursts(1.0, 1.0, 60.0), BreathEstimator::kSpectrum);
  EXPECT_EQ(quality_of(doubled.estimate, BreathEstimator::kSpectrum), BreathQuality::kPoor);
  const BreathState alike = analysed(bursts(1.0, 1.0, 60.0), BreathEstimator::kAutocorrelation);
  EXPECT_EQ(quality_of(alike.estimate, BreathEstimator::kAutocorrelation), BreathQuality::kPoor);
  EXPECT_EQ(alike.estimate.rate_bpm, 0.0);
  const BreathState steady = analysed(bursts(1.0, 1.0, 0.0), BreathEstimator::kMultiBand);
  EXPECT_EQ(quality_of(steady.estimate, BreathEstimator::kMultiBand), BreathQuality::kNone);
}

TEST(BreathSound, TwelveAMinuteAreHeardInShortAndLongWindows) {
  for (const MadeBreath& kind : {kEven, kPaused, kLongOut, kInAlone})
    for (const double window_s : {20.0, 45.0, 60.0, 120.0}) {
      RatesHeard heard;
      hear(made_breath(kind, 12.0, 0.05, 0.1, 120.0), 12.0, window_s, heard);
      EXPECT_EQ(heard.halved + heard.doubled, 0) << kind.name << ", " << window_s;
      EXPECT_GE(heard.right, 9) << kind.name << ", " << window_s;
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
  const std::vector<float> sound = bursts(1.0, 0.4, 101.1, 1000.0);  // half a block is left over
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
  EXPECT_EQ(seen + 1, expected.size());
  monitor.finish();
  EXPECT_EQ(monitor.state().blocks, expected.size());
  EXPECT_EQ(monitor.state().time_s, expected.back().time_s);
  EXPECT_EQ(monitor.state().estimate.rate_bpm, expected.back().estimate.rate_bpm);
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

}  // namespace
}  // namespace neritic::diver
