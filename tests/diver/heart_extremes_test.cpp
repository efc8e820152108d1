// ECG that is none, or nearly none: no number that is not one, no endless work, and recovery.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "diver/heart_monitor.hpp"
#include "tests/diver/physio_signals.hpp"

namespace neritic::diver {
namespace {

constexpr double kNoEcg = std::numeric_limits<double>::quiet_NaN();

void expect_finite(const HeartState& s) {
  for (const double v : {s.time_s, s.last_beat_s, s.rate_bpm, s.over_five_minutes.mean_rr_ms,
                         s.over_five_minutes.mean_rate_bpm, s.over_five_minutes.sdnn_ms,
                         s.over_five_minutes.rmssd_ms, s.over_five_minutes.pnn50_percent,
                         s.over_five_minutes.sd1_ms, s.over_five_minutes.sd2_ms, s.spectrum.vlf_ms2,
                         s.spectrum.lf_ms2, s.spectrum.hf_ms2, s.spectrum.lf_over_hf})
    EXPECT_TRUE(std::isfinite(v));
}

HeartState monitored(double rate_hz, const std::vector<double>& ecg) {
  HeartMonitor monitor(rate_hz);
  monitor.push(ecg);
  expect_finite(monitor.state());
  return monitor.state();
}

TEST(HeartRate, IsThatOfTheBeatsAtAnySamplingRate) {
  for (const double rate_hz : {50.0, 100.0, 130.16, 250.0, 360.0, 499.0, 1000.0, 2000.0, 48000.0}) {
    const double seconds = rate_hz > 10000.0 ? 20.0 : 60.0;
    const auto beats = test::even_beats(0.75, seconds);
    const HeartState s = monitored(rate_hz, test::ecg_of(beats, rate_hz, seconds));
    EXPECT_NEAR(s.rate_bpm, 80.0, 0.3) << rate_hz;
    EXPECT_NEAR(static_cast<double>(s.beats), static_cast<double>(beats.size()), 1.0) << rate_hz;
    EXPECT_EQ(s.ectopic, 0u) << rate_hz;
    EXPECT_LT(s.over_five_minutes.rmssd_ms, rate_hz < 200.0 ? 4.0 : 1.0) << rate_hz;
    EXPECT_EQ(s.quality, SignalQuality::kGood);
  }
}

TEST(HeartRate, FromThirtyToTwoHundredBeatsAMinute) {
  for (const double bpm : {30.0, 45.0, 60.0, 120.0, 180.0, 200.0}) {
    const auto beats = test::even_beats(60.0 / bpm, 60.0);
    std::vector<Beat> found = find_beats(250.0, test::ecg_of(beats, 250.0, 60.0));
    ASSERT_EQ(found.size(), beats.size()) << bpm;
    for (std::size_t i = 0; i < beats.size(); ++i) EXPECT_NEAR(found[i].time_s, beats[i], 0.003);
  }
}

// Beats in quick succession leave no peak of noise between them: that is no noise.
TEST(HeartRate, AFastHeartIsAGoodSignalFromTheFirstSeconds) {
  for (const double rate_hz : {130.16, 250.0})
    for (const double noise : {0.0, 0.005, 0.05, 0.1})
      for (const double bpm :
           {30.0, 60.0, 100.0, 140.0, 160.0, 180.0, 190.0, 200.0, 210.0, 220.0}) {
        SCOPED_TRACE(fmt::format("{} a minute at {} Hz, noise {}", bpm, rate_hz, noise));
        std::vector<double> ecg = test::ecg_of(test::even_beats(60.0 / bpm, 30.0), rate_hz, 30.0);
        for (std::size_t i = 0; i < ecg.size(); ++i) ecg[i] += noise * test::gauss(RandomKey{9}, i);
        HeartMonitor monitor(rate_hz);
        std::size_t unknown = 0;
        for (std::size_t i = 0; i < ecg.size(); ++i) {
          monitor.push({&ecg[i], 1});
          if (i % 50 != 0 || i < 200) continue;
          const double found_bpm = monitor.state().rate_bpm;
          if (found_bpm > 0.0) {
            ASSERT_NEAR(found_bpm, bpm, 0.03 * bpm) << i;
          } else if (static_cast<double>(i) > 4.0 * rate_hz) {
            ++unknown;
          }
        }
        EXPECT_LE(unknown, 2u);
        EXPECT_EQ(monitor.state().quality, SignalQuality::kGood);
        EXPECT_LT(monitor.doubtful_share(), 0.1);
      }
}

TEST(HeartExtremes, ZerosAndAnAmplifierAtItsLimitAreNoHeart) {
  for (const double level : {0.0, 5.0, -2047.0, 1e6, 0.1}) {
    const HeartState s = monitored(360.0, std::vector<double>(360 * 60, level));
    EXPECT_EQ(s.beats, 0u) << level;
    EXPECT_EQ(s.rate_bpm, 0.0);
    EXPECT_EQ(s.quality, SignalQuality::kNone);
  }
}

// Other instruments' signals, taken for an ECG: an eye that leaps from point to point each second
// and a half, as regularly as a heart, either way; noise that swells with each breath; a few steps.
TEST(HeartExtremes, AnEyeAndABreathAreNoGoodSignal) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise;
  std::vector<double> gaze, breath;
  double at = 0.0, wanted = 0.0;
  for (int i = 0; i < 500 * 60; ++i) {
    if (i % 750 == 749) wanted = 10.0 * noise(random);
    at += 0.06 * (wanted - at);
    gaze.push_back(at + 0.01 * noise(random));
  }
  double low = 0.0;
  for (int i = 0; i < 1000 * 60; ++i) {
    const double swell = std::max(0.0, std::sin(2.0 * kPi * 0.25 * 1e-3 * i));
    low += 0.05 * (noise(random) - low);
    breath.push_back(swell * swell * low);
  }
  EXPECT_NE(monitored(500.0, gaze).quality, SignalQuality::kGood);
  EXPECT_NE(monitored(1000.0, breath).quality, SignalQuality::kGood);
  gaze.resize(500 * 6);
  EXPECT_NE(monitored(500.0, gaze).quality, SignalQuality::kGood);
}

TEST(HeartExtremes, ClippedAndUpsideDownBeatsAreStillBeats) {
  const auto beats = test::even_beats(0.8, 60.0);
  for (const int form : {0, 1, 2}) {
    std::vector<double> ecg = test::ecg_of(beats, 250.0, 60.0);
    for (double& x : ecg) x = form == 0 ? -x : form == 1 ? std::min(x, 0.4) : 1000.0 * x + 5e4;
    const auto found = find_beats(250.0, ecg);
    EXPECT_EQ(found.size(), beats.size()) << form;
    if (form == 0) {
      for (const Beat& beat : found) EXPECT_LT(beat.amplitude, 0.0);
    }
  }
}

TEST(HeartExtremes, TooSlowARateIsRefusedInWords) {
  for (const double rate_hz : {10.0, 0.0, -5.0, 1e9, kNoEcg}) {
    const Status status = check_ecg_rate(rate_hz);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("accepted: "), std::string::npos);
  }
}

TEST(HeartExtremes, NoSampleAndOneSampleGiveNothing) {
  EXPECT_TRUE(find_beats(360.0, {}).empty());
  EXPECT_TRUE(find_beats(360.0, {1.0}).empty());
  EXPECT_EQ(monitored(360.0, {}).beats, 0u);
  EXPECT_EQ(monitored(360.0, {kNoEcg}).refused, 1u);
}

TEST(HeartExtremes, ASecondOfBeatsIsFoundAtTheEnd) {
  const auto ecg = test::ecg_of({0.3, 1.0}, 360.0, 1.4);
  EXPECT_EQ(find_beats(360.0, ecg).size(), 2u);
}

TEST(HeartExtremes, SamplesThatAreNoNumbersAreHeldAndCounted) {
  const auto beats = test::even_beats(0.8, 60.0);
  std::vector<double> ecg = test::ecg_of(beats, 360.0, 60.0);
  std::uint64_t bad = 0;
  for (std::size_t i = 100; i < ecg.size(); i += 53) {
    ecg[i] = i % 3 == 0 ? kNoEcg : i % 3 == 1 ? HUGE_VAL : -1e300;
    ++bad;
  }
  EcgCounts counts;
  const auto found = find_beats(360.0, ecg, &counts);
  EXPECT_EQ(counts.refused, bad);
  EXPECT_EQ(counts.gaps, 0u);
  ASSERT_EQ(found.size(), beats.size());
  for (std::size_t i = 0; i < beats.size(); ++i) EXPECT_NEAR(found[i].time_s, beats[i], 0.012);
}

// A lost contact: no interval across it, and beats again after it.
TEST(HeartExtremes, AGapPartsTheBeats) {
  const auto beats = test::even_beats(0.8, 120.0);
  std::vector<double> ecg = test::ecg_of(beats, 250.0, 120.0);
  for (std::size_t i = 250 * 40; i < 250 * 55; ++i) ecg[i] = kNoEcg;
  for (std::size_t i = 250 * 55; i < ecg.size(); ++i) ecg[i] += 3.0;  // another contact
  EcgCounts counts;
  const auto found = find_beats(250.0, ecg, &counts);
  EXPECT_EQ(counts.gaps, 1u);
  const auto intervals = intervals_of(found);
  int parted = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(found[i].time_s < 40.5 || found[i].time_s > 55.0) << found[i].time_s;
    parted += intervals[i].kind == IntervalKind::kNone;
    if (intervals[i].kind == IntervalKind::kNormal) {
      EXPECT_NEAR(intervals[i].length_s, 0.8, 0.01);
    }
  }
  EXPECT_EQ(parted, 2);  // the first beat, and the first after the gap
  EXPECT_GT(std::ranges::count_if(found, [](const Beat& b) { return b.time_s > 55.0; }), 75);
}

// A knock a thousand times as large as a beat: beats again within a few seconds.
TEST(HeartExtremes, RecoversFromAKnock) {
  const auto beats = test::even_beats(0.8, 60.0);
  std::vector<double> ecg = test::ecg_of(beats, 250.0, 60.0);
  for (std::size_t i = 250 * 20; i < 250 * 20 + 30; ++i) ecg[i] += 1000.0;
  EcgCounts counts;
  const auto found = find_beats(250.0, ecg, &counts);
  EXPECT_GE(counts.relearned, 1u);
  const auto late = std::ranges::count_if(found, [](const Beat& b) { return b.time_s > 30.3; });
  const auto marked = std::ranges::count_if(beats, [](double b) { return b > 30.3; });
  EXPECT_EQ(late, marked);
}

// Single samples that no electrode gives, however large, before and between beats: not a beat is
// lost, none is made up, and each is counted.
TEST(HeartExtremes, LeapsOfASampleCostNoBeat) {
  for (const double rate_hz : {50.0, 130.0, 360.0, 1000.0})
    for (const double size : {20.0, 100.0, -1e4, 1e6, 1e11}) {
      const auto beats = test::even_beats(0.8, 120.0);
      std::vector<double> ecg = test::ecg_of(beats, rate_hz, 120.0);
      std::uint64_t leaps = 0;
      for (double t = 9.3; t < 119.0; t += 14.0, ++leaps)
        ecg[static_cast<std::size_t>(t * rate_hz)] += size;
      EcgCounts counts;
      const auto found = find_beats(rate_hz, ecg, &counts);
      EXPECT_EQ(counts.refused, leaps) << rate_hz << " " << size;
      EXPECT_EQ(counts.leaps, leaps);
      EXPECT_EQ(counts.relearned, 0u);
      ASSERT_EQ(found.size(), beats.size()) << rate_hz << " " << size;
      for (std::size_t i = 0; i < beats.size(); ++i) EXPECT_NEAR(found[i].time_s, beats[i], 0.02);
      EXPECT_EQ(monitored(rate_hz, ecg).quality, SignalQuality::kGood);
    }
}

// A heart that begins, or goes on, after nothing but noise: its first beats are no leaps.
TEST(HeartExtremes, BeatsAfterARestAreNoLeaps) {
  for (const double rate_hz : {250.0, 360.0, 1000.0}) {
    const double amplitude =
        find_beats(rate_hz, test::ecg_of(test::even_beats(0.8, 10.0), rate_hz, 10.0))[5].amplitude;
    for (const double noise_mv : {0.0002, 0.0025, 0.02})
      for (const double quiet_s : {6.5, 8.0, 12.0, 60.0})
        for (const bool before : {false, true}) {
          const double from_s = before ? 20.0 : 0.0, seconds = from_s + quiet_s + 40.0;
          std::vector<double> beats;
          for (double t = 0.4; t < seconds - 0.5; t += 0.8)
            if (t < from_s - 0.5 || t > from_s + quiet_s) beats.push_back(t);
          std::vector<double> ecg = test::ecg_of(beats, rate_hz, seconds);
          for (std::size_t i = 0; i < ecg.size(); ++i) ecg[i] += noise_mv * test::gauss({7, 1}, i);
          EcgCounts counts;
          const auto found = find_beats(rate_hz, ecg, &counts);
          SCOPED_TRACE(testing::Message() << rate_hz << " Hz, noise of " << noise_mv << " mV for "
                                          << quiet_s << " s, beats before: " << before);
          EXPECT_EQ(counts.leaps, 0u);
          for (const double beat : beats) {
            const auto at = std::ranges::find_if(
                found, [&](const Beat& b) { return std::abs(b.time_s - beat) < 0.02; });
            ASSERT_NE(at, found.end()) << beat;
            EXPECT_NEAR(at->amplitude, amplitude, 0.005 + 4.0 * noise_mv) << beat;
          }
        }
  }
}

// Spikes in most seconds, or in each, from the first on: some twelve seconds are lost, not the
// recording, and they are never taken for beats for good.
TEST(HeartExtremes, SpikesUpToTwoASecondAreNotTakenForBeats) {
  const auto beats = test::even_beats(0.8, 120.0);
  for (const double rate_hz : {130.0, 250.0, 360.0, 1000.0})
    for (const double every_s : {2.0, 1.3, 1.0, 0.5}) {
      if (rate_hz < 250.0 && every_s < 1.0) continue;
      std::vector<double> ecg = test::ecg_of(beats, rate_hz, 120.0);
      for (double t = 0.93; t < 119.9; t += every_s)
        ecg[static_cast<std::size_t>(t * rate_hz)] += 30.0;
      const auto found = find_beats(rate_hz, ecg);
      std::ptrdiff_t late = 0;
      for (const Beat& b : found) late += b.time_s > 16.0;
      EXPECT_EQ(late, std::ranges::count_if(beats, [](double b) { return b > 16.0; }))
          << rate_hz << " Hz, each " << every_s << " s";
    }
}

// A leap before eight seconds are known costs seconds, not the recording.
TEST(HeartExtremes, ALeapInTheFirstSecondsIsOvercome) {
  const auto beats = test::even_beats(0.8, 60.0);
  for (const double at_s : {0.1, 1.0, 1.9, 3.5, 7.0}) {
    std::vector<double> ecg = test::ecg_of(beats, 360.0, 60.0);
    ecg[static_cast<std::size_t>(at_s * 360.0)] += 1e6;
    const auto found = find_beats(360.0, ecg);
    const auto late = std::ranges::count_if(found, [](const Beat& b) { return b.time_s > 14.3; });
    const auto marked = std::ranges::count_if(beats, [](double b) { return b > 14.3; });
    EXPECT_EQ(late, marked) << at_s;
  }
}

// A change that lasts is the signal: another offset, or beats a hundred times as large.
TEST(HeartExtremes, AChangeThatLastsIsNoLeap) {
  const auto beats = test::even_beats(0.8, 60.0);
  for (const bool offset : {true, false}) {
    std::vector<double> ecg = test::ecg_of(beats, 360.0, 60.0);
    for (std::size_t i = 360 * 30; i < ecg.size(); ++i)
      ecg[i] = offset ? ecg[i] + 50.0 : 100.0 * ecg[i];
    EcgCounts counts;
    const auto found = find_beats(360.0, ecg, &counts);
    const auto late = std::ranges::count_if(found, [](const Beat& b) { return b.time_s > 40.0; });
    const auto marked = std::ranges::count_if(beats, [](double b) { return b > 40.0; });
    EXPECT_EQ(late, marked) << offset;
    EXPECT_LT(counts.leaps, 100u);
  }
}

TEST(HeartExtremes, AnExtraBeatIsFlaggedAndKeptOutOfTheFigures) {
  std::vector<double> beats = test::even_beats(0.8, 60.0);
  beats[30] -= 0.3;  // and the pause after it
  const auto intervals = intervals_of(find_beats(360.0, test::ecg_of(beats, 360.0, 60.0)));
  const auto count = [&](IntervalKind kind) {
    return std::ranges::count_if(intervals, [&](const Interval& i) { return i.kind == kind; });
  };
  EXPECT_EQ(count(IntervalKind::kEctopic), 1);
  EXPECT_EQ(count(IntervalKind::kAfter), 1);
  EXPECT_EQ(intervals[30].kind, IntervalKind::kEctopic);
  const Variability v = variability(intervals);
  EXPECT_LT(v.sdnn_ms, 2.0);
  EXPECT_NEAR(v.mean_rate_bpm, 75.0, 0.1);
}

// The levels of Pan and Tompkins part noise into beats and noise, too. A heart is not as flat, or
// it keeps time.
TEST(HeartMonitor, NoiseAloneIsNoGoodSignalAndAHeartIs) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RandomKey key = RandomKey{seed};
    HeartMonitor monitor(360.0);
    int good = 0, asked = 0;
    for (std::uint64_t i = 0; i < 360 * 120; ++i) {
      const double sample = 0.3 * test::gauss(key, i);
      monitor.push({&sample, 1});
      if (i % 360 != 0 || i < 360 * 5) continue;
      ++asked;
      good += monitor.state().quality == SignalQuality::kGood;
    }
    EXPECT_LE(good, asked / 50) << seed;
  }
  for (const double bpm : {40.0, 75.0, 120.0, 180.0, 200.0})
    for (const double noise : {0.0, 0.1, 0.2}) {
      std::vector<double> ecg = test::ecg_of(test::even_beats(60.0 / bpm, 30.0), 250.0, 30.0);
      for (std::size_t i = 0; i < ecg.size(); ++i) ecg[i] += noise * test::gauss(RandomKey{9}, i);
      EXPECT_EQ(monitored(250.0, ecg).quality, SignalQuality::kGood) << bpm << " " << noise;
    }
}

TEST(HeartMonitor, WhereMuchIsMissingTheSignalIsPoor) {
  std::vector<double> ecg = test::ecg_of(test::even_beats(0.75, 30.0), 250.0, 30.0);
  const HeartState whole = monitored(250.0, ecg);
  EXPECT_EQ(whole.quality, SignalQuality::kGood);
  for (std::size_t i = 0; i < ecg.size(); i += 3) ecg[i] = ecg[i + 1] = kNoEcg;
  EXPECT_EQ(monitored(250.0, ecg).quality, SignalQuality::kPoor);
}

// Noise adds beats and shifts others: without it the deviation is 28 ms, with it up to 211.
TEST(HeartMonitor, FiguresAreGivenOfNoPoorSignal) {
  constexpr double kSeconds = 180.0;
  std::vector<double> beats;
  double t = 0.5;
  for (std::uint64_t i = 0; t < kSeconds - 1.0; ++i) {
    beats.push_back(t);
    t += 0.8 + 0.026 * test::gauss(RandomKey{4}, i);
  }
  int given = 0, refused = 0;
  for (const double from_s : {0.0, 60.0})
    for (const double noise : {0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
      SCOPED_TRACE(fmt::format("noise {} from {} s", noise, from_s));
      std::vector<double> ecg = test::ecg_of(beats, 250.0, kSeconds);
      const auto first = static_cast<std::size_t>(250.0 * from_s);
      const std::size_t last = from_s > 0.0 ? 2 * first : ecg.size();
      for (std::size_t i = first; i < last; ++i) ecg[i] += noise * test::gauss(RandomKey{9}, i);
      HeartMonitor monitor(250.0);
      monitor.push(ecg);
      const HeartState s = monitor.state();
      if (s.quality == SignalQuality::kPoor) {
        EXPECT_EQ(s.rate_bpm, 0.0);
        EXPECT_EQ(s.over_five_minutes.intervals, 0);
        EXPECT_FALSE(s.spectrum.valid);
      }
      if (s.over_five_minutes.intervals > 0) {
        EXPECT_LE(monitor.doubtful_share(), kMostDoubtful);
        EXPECT_NEAR(s.over_five_minutes.sdnn_ms, 28.0, 7.0);
        ++given;
      } else {
        EXPECT_GT(noise, 0.2);
        ++refused;
      }
    }
  EXPECT_GE(given, 6);
  EXPECT_GE(refused, 5);
}

// Beats whose intervals vary by that deviation: independently, or as slow waves over some thirty
// beats with half of it from beat to beat.
std::vector<double> varied_beats(double deviation_s, bool slowly, std::uint64_t seed) {
  constexpr double kOld = 0.97;
  std::vector<double> beats;
  double t = 0.5, slow = 0.0;
  for (std::uint64_t i = 0; t < 179.0; ++i) {
    beats.push_back(t);
    slow = kOld * slow + std::sqrt(1.0 - kOld * kOld) * test::gauss(RandomKey{40 + seed}, i);
    const double quick = test::gauss(RandomKey{60 + seed}, i);
    t += 0.9 + deviation_s * (slowly ? 0.9 * slow + 0.2 * quick : quick);
  }
  return beats;
}

Variability without_noise(const std::vector<double>& beats_s) {
  std::vector<Beat> beats;
  for (const double t : beats_s) beats.push_back({.time_s = t, .amplitude = 1.0});
  return variability(intervals_of(beats));
}

// Noise moves the beats, and makes SDNN and RMSSD larger. What is given is within 15 % of the
// truth; a quiet signal's figures are given.
TEST(HeartMonitor, VariabilityIsGivenOnlyWhereNoiseDoesNotMakeIt) {
  std::vector<double> noises_mv{0.0, 0.1, 0.2, 0.3, 0.5};
  if (test::is_thorough()) noises_mv.insert(noises_mv.end(), {0.05, 0.15, 0.25, 0.4});
  int given = 0, all = 0;
  for (const double rate_hz : {130.0, 250.0, 500.0})
    for (const double deviation_ms : {3.0, 5.0, 10.0, 20.0, 50.0, 100.0})
      for (const double noise_mv : noises_mv)
        for (const bool slowly : {false, true}) {
          // Independent intervals so far apart are ectopic ones.
          if (!slowly && deviation_ms > 20.0) continue;
          const auto beats = varied_beats(1e-3 * deviation_ms, slowly, slowly ? 2 : 1);
          std::vector<double> ecg = test::ecg_of(beats, rate_hz, 180.0);
          for (std::size_t i = 0; i < ecg.size(); ++i)
            ecg[i] += noise_mv * test::gauss(RandomKey{9}, i);
          const HeartState s = monitored(rate_hz, ecg);
          const Variability truth = without_noise(beats), &found = s.over_five_minutes;
          SCOPED_TRACE(fmt::format("{} Hz, SDNN {:.1f} ms, noise {} mV, slowly {}", rate_hz,
                                   truth.sdnn_ms, noise_mv, slowly));
          ++all;
          if (found.intervals == 0) {
            EXPECT_FALSE(s.spectrum.valid);
            EXPECT_GE(noise_mv, deviation_ms >= 20.0 && rate_hz >= 250.0 ? 0.1 : 0.0);
            continue;
          }
          ++given;
          EXPECT_NEAR(found.sdnn_ms, truth.sdnn_ms, 0.15 * truth.sdnn_ms);
          EXPECT_NEAR(found.rmssd_ms, truth.rmssd_ms, 0.15 * truth.rmssd_ms);
        }
  EXPECT_GT(given, 0.4 * all) << given << " of " << all;
}

// The law of the beats' jitter, against how far found beats lie from the true ones.
TEST(HeartExtremes, TheNoiseOfABeatsTimeIsWhatItIsSaidToBe) {
  for (const double rate_hz : {130.0, 250.0, 500.0, 1000.0})
    for (const double noise_mv : {0.02, 0.05, 0.1, 0.15}) {
      const auto beats = varied_beats(0.02, false, 3);
      std::vector<double> ecg = test::ecg_of(beats, rate_hz, 180.0);
      for (std::size_t i = 0; i < ecg.size(); ++i)
        ecg[i] += noise_mv * test::gauss(RandomKey{9}, i);
      double mean = 0.0, squares = 0.0, said = 0.0;
      std::vector<double> off;
      for (const Beat& beat : find_beats(rate_hz, ecg)) {
        const double nearest = *std::ranges::min_element(
            beats, {}, [&](double t) { return std::abs(t - beat.time_s); });
        if (std::abs(beat.time_s - nearest) > 0.05) continue;  // an extra one
        off.push_back(beat.time_s - nearest);
        said += beat.jitter_s * beat.jitter_s;
      }
      const auto count = static_cast<double>(off.size());
      for (const double e : off) mean += e / count;
      for (const double e : off) squares += (e - mean) * (e - mean);
      EXPECT_NEAR(std::sqrt(squares / said), 1.0, 0.45) << rate_hz << " Hz, " << noise_mv << " mV";
    }
}

// Noise before the first beat: an interval that leads from it is none of the rhythm's.
TEST(HeartExtremes, AFirstIntervalThatDoesNotFitIsEctopic) {
  std::vector<Beat> beats;
  for (const double t : {0.262, 0.5, 1.4, 2.3, 3.2, 4.1})
    beats.push_back({.time_s = t, .amplitude = 1.0});
  const auto intervals = intervals_of(beats);
  EXPECT_EQ(intervals[1].kind, IntervalKind::kEctopic);
  for (std::size_t i = 2; i < intervals.size(); ++i)
    EXPECT_EQ(intervals[i].kind, IntervalKind::kNormal) << i;
  EXPECT_NEAR(variability(intervals).sdnn_ms, 0.0, 1e-9);
}

TEST(HeartMonitor, AStrapsIntervalsAreTakenAsTheyAre) {
  HeartMonitor monitor;
  for (const double rr_ms : {800, 810, 790, 860, 780, 805, 795, 850})
    monitor.push_interval(1e-3 * rr_ms);
  const HeartState s = monitor.state();
  EXPECT_NEAR(s.over_five_minutes.rmssd_ms, 47.13203338949606, 1e-9);
  EXPECT_EQ(s.beats, 8u);
  for (const double bad : {kNoEcg, 0.0, -1.0, 100.0}) monitor.push_interval(bad);
  EXPECT_EQ(monitor.state().refused, 4u);
  monitor.skip(10.0);
  EXPECT_EQ(monitor.state().rate_bpm, 0.0);
  EXPECT_EQ(monitor.state().quality, SignalQuality::kNone);
  monitor.push_interval(0.75);
  EXPECT_NEAR(monitor.state().rate_bpm, 80.0, 1e-9);
  expect_finite(monitor.state());
}

TEST(HeartMonitor, SampleBySampleIsTheSameAsAllAtOnce) {
  const auto ecg = test::ecg_of(test::even_beats(0.7, 30.0), 200.0, 30.0);
  HeartMonitor one(200.0), all(200.0);
  for (const double sample : ecg) one.push({&sample, 1});
  all.push(ecg);
  EXPECT_EQ(one.state().beats, all.state().beats);
  EXPECT_EQ(one.state().rate_bpm, all.state().rate_bpm);
  EXPECT_EQ(one.state().over_five_minutes.sdnn_ms, all.state().over_five_minutes.sdnn_ms);
}

}  // namespace
}  // namespace neritic::diver
