// Beats, intervals and their variability, against published figures, hand-made series and a record
// that two cardiologists marked.
#include <gtest/gtest.h>

#include "diver/heart_monitor.hpp"
#include "diver/heart_score.hpp"
#include "diver/physio_wfdb.hpp"
#include "engine/core/files.hpp"
#include "tests/diver/physio_signals.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

std::vector<Interval> normal_intervals(const std::vector<double>& rr_ms) {
  std::vector<Interval> out;
  double t = 0.0;
  for (const double rr : rr_ms) {
    t += 1e-3 * rr;
    out.push_back({t, 1e-3 * rr, IntervalKind::kNormal});
  }
  return out;
}

TEST(Variability, IsThatOfAHandMadeSeries) {
  const auto v = variability(normal_intervals({800, 810, 790, 860, 780, 805, 795, 850}));
  EXPECT_EQ(v.intervals, 8);
  EXPECT_NEAR(v.mean_rr_ms, 811.25, 1e-9);
  EXPECT_NEAR(v.mean_rate_bpm, 73.95993836671803, 1e-9);
  EXPECT_NEAR(v.sdnn_ms, 28.62940546261583, 1e-9);
  EXPECT_NEAR(v.rmssd_ms, 47.13203338949606, 1e-9);
  EXPECT_EQ(v.nn50, 3);
  EXPECT_NEAR(v.pnn50_percent, 42.857142857142854, 1e-9);
  EXPECT_NEAR(v.sd1_ms, 35.5818974841341, 1e-9);
  EXPECT_NEAR(v.sd2_ms, 18.338743790388826, 1e-9);
}

TEST(Variability, ADifferenceOfExactlyFiftyDoesNotCount) {
  const auto v = variability(normal_intervals({1000, 1050, 1000, 1051, 1000}));
  EXPECT_EQ(v.nn50, 2);
  EXPECT_NEAR(v.pnn50_percent, 50.0, 1e-12);
  EXPECT_NEAR(v.rmssd_ms, 50.502475186865844, 1e-9);
  EXPECT_NEAR(v.sd1_ms, 41.23509831846328, 1e-9);
  EXPECT_NEAR(v.sd2_ms, 0.40824829046393196, 1e-9);
}

// RR(t) = 0.9 + 0.03 sin(2 pi 0.1 t) + 0.02 sin(2 pi 0.25 t) s, each stamped at its end: A^2/2 of
// each line is 450 and 200 ms^2.
TEST(HeartSpectrum, TwoLinesHaveThePowerOfTheirAmplitudes) {
  std::vector<Interval> intervals;
  for (double t = 0.0; t < 600.0;) {
    const double rr =
        0.9 + 0.03 * std::sin(2.0 * kPi * 0.1 * t) + 0.02 * std::sin(2.0 * kPi * 0.25 * t);
    t += rr;
    intervals.push_back({t, rr, IntervalKind::kNormal});
  }
  ASSERT_NEAR(static_cast<double>(intervals.size()), 668.0, 1.0);
  EXPECT_NEAR(1e3 * intervals[1].length_s, 935.8286, 1e-3);
  const HeartSpectrum s = heart_spectrum(intervals);
  ASSERT_TRUE(s.valid);
  EXPECT_NEAR(s.lf_ms2, 450.0, 0.03 * 450.0);
  EXPECT_NEAR(s.hf_ms2, 200.0, 0.03 * 200.0);
  EXPECT_NEAR(s.lf_over_hf, 2.25, 0.03 * 2.25);
  EXPECT_LT(s.vlf_ms2, 5.0);
}

TEST(HeartSpectrum, IsNotGivenForLessThanTwoMinutes) {
  std::vector<double> rr(100, 800.0);
  EXPECT_FALSE(heart_spectrum(normal_intervals(rr)).valid);
  EXPECT_FALSE(heart_spectrum({}).valid);
}

struct MarkedRecord {
  Recording ecg;
  std::vector<BeatAnnotation> marks;
};
MarkedRecord record_100(const std::filesystem::path& shared) {
  const auto folder = shared / "data" / "recordings" / "ecg_mitbih_100";
  const auto header = parse_wfdb_header(*read_text(folder / "100.hea"), "100.hea");
  EXPECT_TRUE(header.ok());
  auto ecg = parse_wfdb_signal(*header, 0, *read_file(folder / "100.dat"), "100.dat");
  auto marks = parse_wfdb_beats(*read_file(folder / "100.atr"), header->rate_hz, "100.atr");
  EXPECT_TRUE(ecg.ok() && marks.ok());
  return {std::move(*ecg), std::move(*marks)};
}

HeartScore score_of(double rate_hz, const std::vector<double>& samples,
                    const std::vector<BeatAnnotation>& marks) {
  return score_beats(marks, intervals_of(find_beats(rate_hz, samples)));
}

TEST(MitBih100, TheAnnotationsHaveTheBeatsOfTheirDescription) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  ASSERT_EQ(r.marks.size(), 2273u);
  const auto count = [&](int code) {
    return std::ranges::count_if(r.marks, [&](const BeatAnnotation& b) { return b.code == code; });
  };
  EXPECT_EQ(count(1), 2239);
  EXPECT_EQ(count(8), 33);
  EXPECT_EQ(count(5), 1);
  EXPECT_EQ(r.ecg.samples.size(), 650000u);
  EXPECT_NEAR(r.ecg.samples[0], (995 - 1024) / 200.0, 1e-12);
}

// A textbook Pan and Tompkins finds 2273 of 2273, with none beside; half of them at the very
// sample, 95 % within one.
TEST(MitBih100, EveryBeatIsFoundAndNothingElse) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  const HeartScore s = score_of(360.0, r.ecg.samples, r.marks);
  EXPECT_EQ(s.found, 2273);
  EXPECT_EQ(s.extra, 0);
  EXPECT_EQ(s.missed, 0);
  EXPECT_LE(std::abs(s.median_offset_ms), 2.0);  // marks are whole samples of 2.8 ms
  EXPECT_LE(s.p95_offset_ms, 4.2);
  EXPECT_EQ(s.ectopic_marked, 34);
  EXPECT_GE(s.ectopic_both, 33);
  EXPECT_LE(s.ectopic_flagged, 36);
}

// One sample in 28 s of 20 mV and more: none of the beats is lost, none is made up.
TEST(MitBih100, SpikesCostNoBeat) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  for (const double size_mv : {20.0, 100.0, 1e6}) {
    std::vector<double> spiked = r.ecg.samples;
    std::uint64_t spikes = 0;
    for (std::size_t i = 28 * 360; i < spiked.size(); i += 28 * 360, ++spikes) spiked[i] = size_mv;
    const HeartScore s = score_of(360.0, spiked, r.marks);
    EXPECT_EQ(s.found, 2273) << size_mv;
    EXPECT_EQ(s.extra, 0) << size_mv;
    EcgCounts counts;
    find_beats(360.0, spiked, &counts);
    EXPECT_EQ(counts.leaps, spikes);
  }
}

// By the annotations alone: intervals between two normal beats.
TEST(MitBih100, VariabilityOfTheMarkedBeatsIsThePublishedOne) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  std::vector<Interval> marked;
  for (std::size_t i = 1; i < r.marks.size(); ++i) {
    const bool normal = r.marks[i].code == 1 && r.marks[i - 1].code == 1;
    marked.push_back({r.marks[i].time_s, r.marks[i].time_s - r.marks[i - 1].time_s,
                      normal ? IntervalKind::kNormal : IntervalKind::kEctopic});
  }
  const Variability all = variability(marked, true), strict = variability(marked);
  EXPECT_EQ(all.intervals, 2204);
  EXPECT_NEAR(all.mean_rr_ms, 795.0115950796531, 1e-6);
  EXPECT_NEAR(all.sdnn_ms, 35.96090217597539, 1e-6);
  EXPECT_NEAR(all.rmssd_ms, 27.791140176359796, 1e-6);
  // Published: 132, of which nine differ by exactly 18 samples, 50 ms, and count by rounding alone.
  EXPECT_EQ(all.nn50, 132 - 9);
  EXPECT_NEAR(all.sd1_ms, 19.655739098859748, 1e-6);
  // Published by 2 var(RR) - var(difference) / 2, which agrees in the limit of a long series.
  EXPECT_NEAR(all.sd2_ms, 46.9044229374768, 0.05);
  EXPECT_NEAR(strict.rmssd_ms, 27.48054436562743, 1e-6);
  EXPECT_NEAR(strict.pnn50_percent, 5.348086675887505, 1e-6);
  EXPECT_EQ(strict.pairs, 2169);
}

TEST(MitBih100, VariabilityOfTheFoundBeatsIsCloseToThatOfTheMarkedOnes) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  const auto found = intervals_of(find_beats(360.0, r.ecg.samples));
  const Variability v = variability(found);
  EXPECT_NEAR(v.mean_rr_ms, 795.01, 2.0);
  EXPECT_NEAR(v.sdnn_ms, 35.96, 1.0);
  EXPECT_NEAR(v.rmssd_ms, 27.48, 1.0);
}

// At a heart strap's 130.16 Hz, by linear interpolation of a low-passed copy (means of neighbours).
TEST(MitBih100, AHeartStrapsRateFindsThemToo) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  std::vector<double> slow;
  const double step = 360.0 / 130.16;
  for (double at = 1.0; at < static_cast<double>(r.ecg.samples.size()) - 3.0; at += step) {
    const auto i = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(i);
    const auto mean = [&](std::size_t k) {
      return (r.ecg.samples[k - 1] + r.ecg.samples[k] + r.ecg.samples[k + 1]) / 3.0;
    };
    slow.push_back((1.0 - share) * mean(i) + share * mean(i + 1));
  }
  const HeartScore s = score_of(130.16, slow, r.marks);
  EXPECT_EQ(s.missed, 0);
  EXPECT_LE(s.extra, 1);
}

// White noise against the whole signal's power: a textbook detector gives 2273/0/0 at 0 dB and
// 2257/211/16 at -6 dB.
TEST(MitBih100, NoiseAsStrongAsTheSignalHidesNoBeat) {
  NERITIC_REQUIRE_SHARED(shared);
  const MarkedRecord r = record_100(shared);
  double mean = 0.0, power = 0.0;
  for (const double x : r.ecg.samples) mean += x / static_cast<double>(r.ecg.samples.size());
  for (const double x : r.ecg.samples)
    power += (x - mean) * (x - mean) / static_cast<double>(r.ecg.samples.size());
  for (const double decibels : {12.0, 6.0, 0.0, -6.0}) {
    const double sigma = std::sqrt(power * std::pow(10.0, -decibels / 10.0));
    std::vector<double> noisy = r.ecg.samples;
    for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i] += sigma * test::gauss({7}, i);
    const HeartScore s = score_of(360.0, noisy, r.marks);
    if (decibels >= 0.0) {
      EXPECT_EQ(s.missed, 0) << decibels;
      EXPECT_EQ(s.extra, 0) << decibels;
    } else {
      EXPECT_LE(s.missed + s.extra, 211 + 16 + 20);  // the noise is another draw
      EXPECT_GE(s.sensitivity, 0.98);
    }
  }
}

}  // namespace
}  // namespace neritic::diver
