// `neritic physio`: tables, JSON and pictures of recordings, and what it says of files that are
// none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "diver/gaze_csv.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/physio_report.hpp"
#include "tools/tradeoff/physiology_signals.hpp"
#include "tools/tradeoff/physiology_tradeoff.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;

nlohmann::json json_in(const std::filesystem::path& path) {
  return parse_json(read_text(path).value()).value();
}

// As numpy, spreadsheets and data frames take it: the heading is the first line, all else is rows.
void expect_plain_table(const std::filesystem::path& path, const std::string& heading,
                        std::size_t rows) {
  const std::string table = read_text(path).value();
  EXPECT_TRUE(table.starts_with(heading)) << table.substr(0, 200);
  EXPECT_EQ(table.find('#'), table.npos);
  EXPECT_EQ(std::ranges::count(table, '\n'), static_cast<std::ptrdiff_t>(rows) + 1);
  EXPECT_EQ(std::ranges::count(table, ','),
            std::ranges::count(heading, ',') * (static_cast<std::ptrdiff_t>(rows) + 1));
}

TEST(PhysioCommand, AnEcgBecomesBeatsAsTableJsonAndPicture) {
  const test::ScratchFolder folder;
  std::vector<double> beats_s;
  for (double t = 0.5; t < 29.5; t += 0.75) beats_s.push_back(t);
  const auto ecg = make_ecg(beats_s, 250.0, 30.0, 20.0, 1);
  std::string text = "t_s,ecg_mv\n";
  for (std::size_t i = 0; i < ecg.size(); ++i)
    text += fmt::format("{:.4f},{:.4f}\n", static_cast<double>(i) / 250.0, ecg[i]);
  ASSERT_TRUE(write_text(folder / "heart.csv", text).ok());
  PhysioFlags flags;
  flags.what = "ecg";
  flags.file = (folder / "heart.csv").string();
  flags.out = folder / "out";
  flags.plot = folder / "heart.png";
  const auto said = run_physio(flags);
  ASSERT_TRUE(said.ok()) << said.error().message;
  EXPECT_THAT(*said, HasSubstr("ecg.csv, ecg.json"));
  const nlohmann::json json = json_in(folder / "out/ecg.json");
  EXPECT_EQ(json["beats"].size(), beats_s.size());
  EXPECT_NEAR(json["variability"]["mean_rate_bpm"].get<double>(), 80.0, 0.1);
  EXPECT_TRUE(json["variability"]["sdnn_ms"].is_null());  // of even beats all of it is noise
  EXPECT_GT(json["jitter_ms"].get<double>(), 0.1);
  EXPECT_TRUE(json["spectrum"].is_null());  // half a minute is too short
  expect_plain_table(folder / "out/ecg.csv", "time_s,rr_ms,kind,amplitude\n", beats_s.size());
  EXPECT_EQ(scene::read_image8(folder / "heart.png")->width, 1600u);
}

TEST(PhysioCommand, ARecordIsScoredAgainstItsOwnMarks) {
  NERITIC_REQUIRE_SHARED(shared);
  const test::ScratchFolder folder;
  PhysioFlags flags;
  flags.what = "ecg";
  flags.file = (shared / "data/recordings/ecg_mitbih_100/100.hea").string();
  flags.out = folder.path();
  ASSERT_TRUE(run_physio(flags).ok());
  const nlohmann::json score = json_in(folder / "ecg.json")["score"];
  EXPECT_EQ(score["found"], 2273);
  EXPECT_EQ(score["extra"], 0);
  EXPECT_EQ(score["missed"], 0);
  flags.channel = "V5";
  ASSERT_TRUE(run_physio(flags).ok());
  EXPECT_EQ(json_in(folder / "ecg.json")["signal"], "V5");
  flags.channel = "V6";
  EXPECT_THAT(run_physio(flags).error().message,
              HasSubstr("found 'V6'; accepted: MLII, V5 or a number from 0"));
}

TEST(PhysioCommand, GazeBecomesFixationsWithTheirPixels) {
  const test::ScratchFolder folder;
  std::string text = "# fs_hz=500\nx_deg,y_deg\n";
  for (int i = 0; i < 400; ++i) text += i < 200 ? "0,0\n" : "45,0\n";
  ASSERT_TRUE(write_text(folder / "gaze.csv", text).ok());
  PhysioFlags flags;
  flags.what = "gaze";
  flags.file = (folder / "gaze.csv").string();
  flags.out = folder.path();  // where gaze.csv is
  EXPECT_THAT(run_physio(flags).error().message,
              HasSubstr("the recording's folder, where the table would replace it"));
  flags.out = folder / "out";
  flags.intrinsics = "100,100,50,50";
  flags.plot = folder / "gaze.png";
  for (const char* method : {"ivt", "idt"}) {
    flags.method = method;
    const auto said = run_physio(flags);
    ASSERT_TRUE(said.ok()) << said.error().message;
    const nlohmann::json json = json_in(folder / "out/gaze.json");
    EXPECT_THAT(json["note"].get<std::string>(), HasSubstr("pursuit"));
    ASSERT_EQ(json["fixations"].size(), 2u) << method;
    expect_plain_table(folder / "out/gaze.csv",
                       "kind,start_s,end_s,duration_ms,x_deg,y_deg,spread_deg,amplitude_deg,"
                       "peak_deg_s,pursuit,u_px,v_px\n",
                       json["fixations"].size() + json["saccades"].size() + json["blinks"].size());
    EXPECT_NEAR(json["fixations"][0]["pixel"][0].get<double>(), 50.0, 1e-6);
    EXPECT_NEAR(json["fixations"][1]["pixel"][0].get<double>(), 150.0, 1.5);
  }
}

// The score is that of the saccades that are told: from the table and the marks it comes out anew.
TEST(PhysioCommand, GazeTooSlowForSaccadesIsRefused) {
  const test::ScratchFolder folder;
  PhysioFlags flags;
  flags.what = "gaze";
  flags.out = folder / "out";
  flags.file = (folder / "slow.csv").string();
  for (const double hz : {10.0, 20.0}) {
    std::string text = "t_s,x_deg,y_deg\n";
    for (int i = 0; i < 200; ++i) text += fmt::format("{},{},0\n", i / hz, i / int(hz) % 2 * 5);
    ASSERT_TRUE(write_text(flags.file, text).ok());
    const auto done = run_physio(flags);
    EXPECT_EQ(done.ok(), hz == 20.0);
    if (!done.ok()) {
      EXPECT_EQ(done.error().message,
                flags.file + ": found gaze at 10 Hz; accepted: 20 Hz or more");
    }
  }
}

TEST(PhysioCommand, TheScoreOfGazeIsThatOfItsTable) {
  NERITIC_REQUIRE_SHARED(shared);
  const test::ScratchFolder folder;
  PhysioFlags flags;
  flags.what = "gaze";
  flags.file = (shared / "data/recordings/eye_fixations/lookAtPoint_EL_S1_30s.csv").string();
  flags.out = folder.path();
  ASSERT_TRUE(run_physio(flags).ok());
  std::vector<std::pair<double, double>> saccades;
  std::istringstream rows(read_text(folder / "gaze.csv").value());
  for (std::string row; std::getline(rows, row);) {
    double start_s = 0.0, end_s = 0.0;
    if (std::sscanf(row.c_str(), "saccade,%lf,%lf", &start_s, &end_s) == 2)
      saccades.emplace_back(start_s, end_s);
  }
  const auto recording =
      diver::parse_gaze_csv(read_text(flags.file).value(), "eye.csv", 0.0).value();
  double both = 0.0, marked = 0.0, found = 0.0, agreed = 0.0;
  const double all = static_cast<double>(recording.samples.size());
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const double t = recording.samples[i].time_s;
    const bool mark = recording.marks[i] == 2;
    const bool told = std::ranges::any_of(
        saccades, [&](const auto& s) { return t > s.first - 1e-4 && t < s.second + 1e-4; });
    both += mark && told, marked += mark, found += told, agreed += mark == told;
  }
  EXPECT_GT(both, 0.0);
  const double chance = (marked * found + (all - marked) * (all - found)) / (all * all);
  const double kappa = (agreed / all - chance) / (1.0 - chance);
  const nlohmann::json score = json_in(folder / "gaze.json")["score"];
  EXPECT_NEAR(score["kappa"].get<double>(), kappa, 1e-3);
  EXPECT_GT(kappa, 0.87);
  EXPECT_NEAR(score["plain_kappa"].get<double>(), 0.712, 1e-3);
}

// A column of words is no recording; beside one of numbers it is passed over.
TEST(PhysioCommand, AColumnOfWordsIsNoSignal) {
  const test::ScratchFolder folder;
  std::string words = "t_s,mark,ecg\n", alone = "t_s,ecg\n";
  for (int i = 0; i < 2500; ++i) {
    words += fmt::format("{},abc,{}\n", i / 250.0, i % 250 == 100 ? 1.0 : 0.0);
    alone += fmt::format("{},abc\n", i / 250.0);
  }
  ASSERT_TRUE(write_text(folder / "words.csv", words).ok());
  ASSERT_TRUE(write_text(folder / "alone.csv", alone).ok());
  PhysioFlags flags;
  flags.what = "ecg";
  flags.out = folder / "out";
  flags.file = (folder / "words.csv").string();
  ASSERT_TRUE(run_physio(flags).ok());
  EXPECT_EQ(json_in(folder / "out/ecg.json")["signal"], "ecg");
  flags.channel = "mark";
  EXPECT_THAT(run_physio(flags).error().message,
              HasSubstr("words.csv: found column 'mark' of words; accepted: numbers"));
  flags.channel.clear();
  flags.file = (folder / "alone.csv").string();
  EXPECT_THAT(run_physio(flags).error().message, HasSubstr("found column 'ecg' of words"));
}

// The rest at the end is analysed, too.
TEST(PhysioCommand, SoundIsHeardUpToItsEnd) {
  const test::ScratchFolder folder;
  const auto times = [&](int seconds) {
    std::string sound = "# fs_hz=1000\nsound\n";
    for (int i = 0; i < 1000 * seconds; ++i) sound += fmt::format("{:.4f}\n", std::sin(0.7 * i));
    EXPECT_TRUE(write_text(folder / "s.csv", sound).ok());
    PhysioFlags flags;
    flags.what = "breath";
    flags.file = (folder / "s.csv").string();
    flags.out = folder / "out";
    const auto said = run_physio(flags);
    std::vector<double> out;
    if (!said.ok()) {
      EXPECT_THAT(said.error().message, HasSubstr("found 3.0 s of sound; accepted: 4 s or more"));
      return out;
    }
    const nlohmann::json json = json_in(folder / "out/breath.json");
    for (const auto& one : json["estimates"]) out.push_back(one["time_s"]);
    return out;
  };
  EXPECT_EQ(times(3), std::vector<double>());
  EXPECT_EQ(times(5), (std::vector{5.0}));
  EXPECT_EQ(times(19), (std::vector{10.0, 19.0}));
  EXPECT_EQ(times(20), (std::vector{10.0, 20.0}));
}

// At the recording's own pace the same files come as without, of the same numbers.
TEST(PhysioCommand, PlayedInRealTimeItWritesWhatWasAskedFor) {
  const test::ScratchFolder folder;
  std::string sound = "# fs_hz=1000\nsound\n";
  // One block, and a tenth of a second that is none.
  for (int i = 0; i < 5100; ++i)
    sound += fmt::format("{:.4f}\n", std::sin(0.7 * i) * std::sin(2.0 * kPi * 0.4e-3 * i));
  ASSERT_TRUE(write_text(folder / "s_24bpm.csv", sound).ok());
  PhysioFlags flags;
  flags.what = "breath";
  flags.file = (folder / "s_24bpm.csv").string();
  flags.window_s = 5.0;
  flags.out = folder / "whole";
  ASSERT_TRUE(run_physio(flags).ok());
  flags.realtime = true;
  flags.out = folder / "played";
  flags.plot = folder / "played.png";
  testing::internal::CaptureStdout();
  const auto said = run_physio(flags);
  const std::string rows = testing::internal::GetCapturedStdout();
  ASSERT_TRUE(said.ok()) << said.error().message;
  EXPECT_THAT(*said, HasSubstr("breath.csv, breath.json"));
  EXPECT_EQ(scene::read_image8(folder / "played.png")->width, 1600u);
  EXPECT_EQ(read_text(folder / "played/breath.csv").value(), rows);
  EXPECT_EQ(rows, read_text(folder / "whole/breath.csv").value());
  EXPECT_EQ(std::ranges::count(rows, '\n'), 3);
  EXPECT_THAT(rows, HasSubstr("\n5.10,"));
  const auto whole = json_in(folder / "whole/breath.json");
  const auto played = json_in(folder / "played/breath.json");
  EXPECT_EQ(played["estimates"], whole["estimates"]);
  EXPECT_EQ(played["score"], whole["score"]);
  EXPECT_TRUE(played["us_a_second"].is_null());
  // JSON alone on standard output.
  flags.out.clear();
  flags.plot.clear();
  flags.json = true;
  testing::internal::CaptureStdout();
  ASSERT_TRUE(run_physio(flags).ok());
  const auto printed = parse_json(testing::internal::GetCapturedStdout());
  ASSERT_TRUE(printed.ok()) << printed.error().message;
  EXPECT_EQ((*printed)["estimates"], whole["estimates"]);
  flags.window_s.reset();
  const auto short_one = run_physio(flags);
  ASSERT_FALSE(short_one.ok());
  EXPECT_THAT(short_one.error().message,
              HasSubstr("found 5.1 s of sound; accepted: 10 s or more with --realtime"));
}

TEST(PhysioCommand, FlagsThatSayNothingAreErrorsInWords) {
  const test::ScratchFolder folder;
  std::string gaze = "# fs_hz=500\nx_deg,y_deg\n", sound = "# fs_hz=1000\nsound\n";
  for (int i = 0; i < 400; ++i) gaze += i < 200 ? "0,0\n" : "10,0\n";
  for (int i = 0; i < 20000; ++i)
    sound += fmt::format("{:.4f}\n", std::sin(0.7 * i) * (1.0 + std::sin(0.002 * i)));
  ASSERT_TRUE(write_text(folder / "g.csv", gaze).ok());
  ASSERT_TRUE(write_text(folder / "s.csv", sound).ok());
  PhysioFlags flags;
  flags.what = "breath";
  flags.file = (folder / "s.csv").string();
  flags.out = folder / "out";
  EXPECT_TRUE(run_physio(flags).ok());
  expect_plain_table(folder / "out/breath.csv",
                     "time_s,rate_bpm,breathing,confidence,depth_db,quiet_s,refused,quality\n", 2);
  for (const double window_s : {0.0, -1.0, 2.0, std::nan(""), 301.0}) {
    flags.window_s = window_s;
    EXPECT_THAT(run_physio(flags).error().message, HasSubstr("--window: ")) << window_s;
  }
  flags.window_s.reset();
  for (const double rate : {0.0, -5.0, std::nan("")}) {
    flags.reference_bpm = rate;
    EXPECT_THAT(run_physio(flags).error().message, HasSubstr("--reference: ")) << rate;
  }
  // A headset's durations are those of I-DT.
  PhysioFlags eyes;
  eyes.what = "gaze";
  eyes.file = (folder / "g.csv").string();
  eyes.out = folder / "eyes";
  eyes.headset = true;
  ASSERT_TRUE(run_physio(eyes).ok());
  EXPECT_EQ(json_in(folder / "eyes/gaze.json")["method"], "idt");
  eyes.method = "ivt";
  EXPECT_THAT(run_physio(eyes).error().message, HasSubstr("--headset: found --method ivt"));
}

// A figure beside a quality that denies it is no figure: refused in words, null as JSON.
TEST(PhysioCommand, APoorSignalHasNoVariability) {
  const test::ScratchFolder folder;
  std::vector<double> beats_s;
  for (double t = 0.5; t < 149.0; t += 0.8 + 0.04 * std::sin(1.7 * t)) beats_s.push_back(t);
  PhysioFlags flags;
  flags.what = "ecg";
  flags.file = (folder / "heart.csv").string();
  flags.out = folder / "out";
  for (const bool noisy : {false, true}) {
    const auto ecg = make_ecg(beats_s, 250.0, 150.0, noisy ? -6.0 : 20.0, 1);
    std::string text = "t_s,ecg_mv\n";
    for (std::size_t i = 0; i < ecg.size(); ++i)
      text += fmt::format("{:.4f},{:.4f}\n", static_cast<double>(i) / 250.0, ecg[i]);
    ASSERT_TRUE(write_text(folder / "heart.csv", text).ok());
    ASSERT_TRUE(run_physio(flags).ok());
    const nlohmann::json json = json_in(folder / "out/ecg.json");
    const auto report = analyse_ecg(flags);
    ASSERT_TRUE(report.ok());
    const std::string summary = report_text(flags, *report).summary;
    EXPECT_EQ(json["quality"], noisy ? "poor" : "good");
    for (const char* key : {"rate_bpm", "variability", "last_five_minutes", "spectrum"})
      EXPECT_EQ(json[key].is_null(), noisy) << key;
    EXPECT_EQ(summary.find("SDNN") == std::string::npos, noisy);
    EXPECT_EQ(summary.find("no rate, variability or spectrum is given") != std::string::npos,
              noisy);
  }
}

// Saccades that noise hides, and fixations that it breaks up, are told in one line.
TEST(PhysioCommand, NoiseOfGazeIsToldWhereItHidesSaccades) {
  const test::ScratchFolder folder;
  PhysioFlags flags;
  flags.what = "gaze";
  flags.file = (folder / "gaze.csv").string();
  flags.out = folder / "out";
  for (const double noise_deg : {0.0, 0.3}) {
    std::string text = "t_s,x_deg,y_deg\n";
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 4000; ++i)
      text += fmt::format("{:.4f},{:.4f},{:.4f}\n", i / 200.0,
                          (i / 100 % 2 ? 8.0 : 0.0) + noise_deg * normal(random),
                          noise_deg * normal(random));
    ASSERT_TRUE(write_text(folder / "gaze.csv", text).ok());
    for (const char* method : {"ivt", "idt"}) {
      flags.method = method;
      ASSERT_TRUE(run_physio(flags).ok());
      const nlohmann::json json = json_in(folder / "out/gaze.json");
      EXPECT_EQ(json["warning"].is_null(), noise_deg == 0.0) << method;
      if (json["warning"].is_null()) continue;
      EXPECT_THAT(json["warning"].get<std::string>(), HasSubstr("noise of 0.3"));
      const auto report = analyse_gaze(flags);
      ASSERT_TRUE(report.ok());
      EXPECT_THAT(report_text(flags, *report).summary, HasSubstr("# noise of 0.3"));
    }
  }
}

// Unknown values are null: a heart of no beats has no rate of 0.
TEST(PhysioCommand, WhatIsNotKnownIsNull) {
  const test::ScratchFolder folder;
  std::string still = "# fs_hz=1000\necg\n";
  for (int i = 0; i < 12000; ++i) still += "0\n";
  ASSERT_TRUE(write_text(folder / "e.CSV", still).ok());
  PhysioFlags flags;
  flags.what = "ecg";
  flags.file = (folder / "e.CSV").string();
  flags.out = folder / "out";
  ASSERT_TRUE(run_physio(flags).ok());
  const auto json = json_in(folder / "out/ecg.json");
  EXPECT_TRUE(json["rate_bpm"].is_null());
  for (const char* key : {"sdnn_ms", "rmssd_ms", "mean_rate_bpm", "pnn50_percent"})
    EXPECT_TRUE(json["variability"][key].is_null()) << key;
  flags.what = "breath";
  flags.reference_bpm = 12.0;
  ASSERT_TRUE(run_physio(flags).ok());
  const auto breath = json_in(folder / "out/breath.json");
  EXPECT_TRUE(breath["estimates"][0]["rate_bpm"].is_null());
  EXPECT_EQ(breath["score"]["errors"]["answered"], 0);
  EXPECT_TRUE(breath["score"]["errors"]["median_error_bpm"].is_null());
}

TEST(PhysioCommand, FilesThatAreNoneAreErrorsInWords) {
  const test::ScratchFolder folder;
  const auto message = [&](const char* what, const char* name, const std::string& text) {
    EXPECT_TRUE(write_text(folder / name, text).ok());
    PhysioFlags flags;
    flags.what = what;
    flags.file = (folder / name).string();
    const auto said = run_physio(flags);
    EXPECT_FALSE(said.ok());
    return said.ok() ? std::string() : said.error().message;
  };
  EXPECT_THAT(message("ecg", "empty.csv", ""), HasSubstr("found no row"));
  EXPECT_THAT(message("ecg", "slow.csv", "t_s,ecg\n0,1\n0.1,2\n0.2,1\n"),
              HasSubstr("found a rate of 10 Hz; accepted: 50 to 1e+06"));
  EXPECT_THAT(message("ecg", "one.csv", "t_s,ecg\n0,1\n"), HasSubstr("no rate"));
  EXPECT_THAT(message("breath", "cut.wav", "RIFF"), HasSubstr("no RIFF and WAVE"));
  EXPECT_THAT(message("gaze", "gaze.wav", "x"), HasSubstr("gaze as .csv"));
  EXPECT_THAT(message("ecg", "a.mp3", "x"), HasSubstr("accepted: .csv, .wav, .hea or .dat"));
  EXPECT_THAT(message("pulse", "a.csv", "x"), HasSubstr("accepted: ecg, breath or gaze"));
  PhysioFlags flags;
  flags.what = "ecg";
  flags.file = folder.path().string();
  EXPECT_THAT(run_physio(flags).error().message, HasSubstr("found a folder"));
}

TEST(PhysiologyTradeoff, TheDefaultsAreTheChoiceOfTheCurves) {
  const auto measured = run_physiology_tradeoff({.quick = true});
  ASSERT_TRUE(measured.ok());
  const HeartPoint* heart = heart_choice(*measured);
  ASSERT_NE(heart, nullptr);
  EXPECT_EQ(heart->intervals, 4);
  for (const DetectorPoint& p : measured->detector) EXPECT_EQ(p.missed, 0) << p.rate_hz;
  // The plain spectrum doubles; bands do so less than half as often, at any window that answers.
  for (const BreathPoint& p : measured->breath) {
    if (p.estimator != diver::BreathEstimator::kSpectrum || p.window_s < 10.0) continue;
    for (const BreathPoint& q : measured->breath)
      if (q.estimator == diver::BreathEstimator::kMultiBand && q.window_s == p.window_s) {
        EXPECT_LT(q.doubled, 0.7 * p.doubled) << p.window_s;
        EXPECT_GT(q.right, 2.0 * p.right) << p.window_s;
      }
  }
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_physiology_tradeoff(folder.path(), *measured).ok());
  EXPECT_TRUE(json_in(folder / "physiology.json")["knees"].contains("heart_median"));
  EXPECT_GT(scene::read_image8(folder / "physiology.png")->height, 900u);
}

TEST(PhysiologyTradeoff, TheKneeIsFarthestBelowTheChord) {
  EXPECT_EQ(knee_of({1, 2, 3, 4, 5}, {10, 4, 1, 0.9, 0.8}), 2u);
  EXPECT_EQ(knee_of({1, 2}, {3, 1}), 1u);
}

// Breath paced by a metronome: two blocks of ten seconds lie on the knee.
TEST(PhysiologyTradeoff, TheWindowOfBreathLiesOnTheKnee) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto measured = run_physiology_tradeoff(
      {.quick = true, .recordings = shared / "data/recordings/breath_paced"});
  ASSERT_TRUE(measured.ok());
  const BreathPoint* knee = breath_knee(*measured, "recorded");
  ASSERT_NE(knee, nullptr);
  EXPECT_EQ(knee->window_s, 20.0);
}

}  // namespace
}  // namespace neritic::tools
