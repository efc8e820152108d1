// Each wrong or idle key of a sonar's kinds and terms, and of objects' acoustics, ends in its line.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

struct WrongKeys {
  const char* keys;
  const char* message;  // after "s.toml:2: sonars[0]", or, with a file in it, whole
};
void PrintTo(const WrongKeys& c, std::ostream* out) {
  *out << c.message;
}

class SonarError : public testing::TestWithParam<WrongKeys> {};

std::string wrong_keys_name(const testing::TestParamInfo<WrongKeys>& info) {
  return test::test_name(info.index, info.param.message);
}

TEST_P(SonarError, IsTheDocumentedLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "back.csv", "m,db\n1,0\n1,2").ok());
  ASSERT_TRUE(write_text(scratch / "loud.csv", "0,0\n1,3").ok());
  ASSERT_TRUE(write_text(scratch / "three.csv", "0,0,0").ok());
  ASSERT_TRUE(write_text(scratch / "s.toml", std::string("[[sonars]]\n") + GetParam().keys).ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  std::string message = scene.error().message;
  const std::string folder = scratch.path().string() + "/";
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder))
    message.erase(at, folder.size());
  EXPECT_EQ(message, std::string("s.toml:2: sonars[0]") + GetParam().message);
}

#define HZ "accepted: a number in [1, 10000000] hertz"
#define GAINS "rows [range_m, db] or a .csv file of them"
#define ANGLES "rows [angle_deg, db] or a .csv file of them"
#define SPEEDS "rows [depth_m, m/s] or a .csv file of them"

INSTANTIATE_TEST_SUITE_P(
    Keys, SonarError,
    testing::Values(
        WrongKeys{"semi_angle_deg = 4",
                  ".semi_angle_deg: found 4; accepted: no such key for kind \"imaging\""},
        WrongKeys{"step_deg = 4\nkind = 'sidescan'",
                  ".step_deg: found 4; accepted: no such key for kind \"sidescan\""},
        WrongKeys{"depression_deg = 91\nkind = 'sidescan'",
                  ".depression_deg: found 91; accepted: a number in [0, 90] degrees"},
        WrongKeys{
            "azimuth_deg = 90\nkind = 'echosounder'",
            ".azimuth_deg: found 90; accepted: none, or twice semi_angle_deg: 25 for a cone of "
            "12.5"},
        WrongKeys{"bins = [1, 3, 1]\nkind = 'mechanical'\nazimuth_deg = 360",
                  ".bins: found [1, 3, 1]; accepted: azimuth bins that make steps of at most 90 "
                  "degrees"},
        WrongKeys{"quality = 'best'",
                  ".quality: found \"best\"; accepted: one of draft, standard, reference"},
        WrongKeys{"max_error = 0", ".max_error: found 0; accepted: a number in (0, 1]"},
        WrongKeys{"max_error = 0.1\nquality = 'draft'",
                  ".max_error: found 0.1; accepted: no such key beside quality"},
        WrongKeys{"frequency_hz = 0.5", ".frequency_hz: found 0.5; " HZ},
        WrongKeys{"source_level_db = 200",
                  ".source_level_db: unknown key; nearest known key: level.source_level_db"},
        WrongKeys{"rang = [1, 5]", ".rang: unknown key; nearest known key: range_m"},
        WrongKeys{"bandwidth_hz = 0", ".bandwidth_hz: found 0; " HZ},
        WrongKeys{
            "frequency_hz = 750\nbandwidth_hz = 187500",
            ".frequency_hz: found 750; accepted: at least half of the bandwidth, 187500 Hz: in "
            "hertz"},
        WrongKeys{"water = {salinty_psu = 3}",
                  ".water.salinty_psu: unknown key; nearest known key: salinity_psu"},
        WrongKeys{"water = {ph = 5}", ".water.ph: found 5; accepted: a number in [6, 10]"},
        WrongKeys{"water = {temperature_c = 61}",
                  ".water.temperature_c: found 61; accepted: a number in [-4, 60] degrees Celsius"},
        WrongKeys{"level = 3", ".level: found 3; accepted: a table, under [level]"},
        WrongKeys{"level = {source_level_db = 261}",
                  ".level.source_level_db: found 261; accepted: a number in [0, 260] decibels"},
        WrongKeys{"level = {gain_db = 121}",
                  ".level.gain_db: found 121; accepted: a number in [-120, 120] decibels"},
        WrongKeys{
            "level = {absorption = 'thorp'}",
            ".level.absorption: found \"thorp\"; accepted: francois-garrison, ainslie-mccolm, "
            "none, or a number in [0, 1000] dB/m"},
        WrongKeys{
            "level = {tvg = 61}",
            ".level.tvg: found 61; accepted: none, a number in [0, 60] (times log10 of metres), "
            "or " GAINS},
        WrongKeys{"level = {tvg = []}", ".level.tvg: found []; accepted: " GAINS},
        WrongKeys{"level = {tvg = 'no.csv'}",
                  ".level.tvg: found \"no.csv\"; accepted: a file; no.csv is none"},
        WrongKeys{
            "level = {tvg = 'back.csv'}",
            ".level.tvg: back.csv:3: found 1 after 1; accepted: range_m, db, the first column "
            "rising"},
        WrongKeys{"level = {tvg = 'three.csv'}",
                  ".level.tvg: three.csv:1: found more than 2 numbers; accepted: range_m, db"},
        WrongKeys{
            "level = {tvg = [[0, 1]], tvg_absorption = true}",
            ".level.tvg_absorption: found true; accepted: no such key beside a table of gains"},
        WrongKeys{"beam = {azimuth = 'sync'}",
                  ".beam.azimuth: found \"sync\"; accepted: sinc, hamming, piston, or " ANGLES},
        WrongKeys{"beam = {azimuth = 'loud.csv'}",
                  ".beam.azimuth: loud.csv:2: found 1, 3; accepted: angle_deg, db in [-180, 180] "
                  "degrees and [-300, 0] decibels"},
        WrongKeys{
            "beam = {azimuth = [[0, 0], [181, -3]]}",
            ".beam.azimuth: row 2: found 181, -3; accepted: angle_deg, db in [-180, 180] degrees "
            "and [-300, 0] decibels"},
        WrongKeys{"beam = {azimuth_deg = 2}",
                  ".beam.azimuth_deg: found 2; accepted: no such key without azimuth, the beam's "
                  "shape"},
        WrongKeys{"beam = {elevation = [[0, 0]], elevation_deg = 2}",
                  ".beam.elevation_deg: found 2; accepted: no such key beside a table"},
        WrongKeys{"beam = {samples = 65}",
                  ".beam.samples: found 65; accepted: a whole number from 1 to 64"},
        WrongKeys{
            "beam = {steering = 'flat'}",
            ".beam.steering: found \"flat\"; accepted: no such key without azimuth, the beam's "
            "shape"},
        WrongKeys{
            "beam = {azimuth = 'sinc', steering = 'flat'}\nkind = 'mechanical'",
            ".beam: found a table; accepted: steering of kinds \"imaging\" and \"profiling\" only"},
        WrongKeys{"beam = {azimuth = 'sinc', steering = 'flat'}\nazimuth_deg = 180",
                  ".beam: found a table; accepted: steering = \"flat\" of at most 170 degrees of "
                  "azimuth"},
        WrongKeys{"beam = {elevation = 'piston'}",
                  ".beam: found a table; accepted: piston, a disc, of kind \"echosounder\" only"},
        WrongKeys{"beam = {elevation = 'piston', azimuth = 'sinc'}\nkind = 'echosounder'",
                  ".beam: found a table; accepted: azimuth or elevation, not both, of kind "
                  "\"echosounder\""},
        WrongKeys{
            "beam = {azimuth = 'piston', two_way = true}\nkind = 'echosounder'",
            ".beam: found a table; accepted: two_way of other kinds than \"echosounder\", which "
            "sends through it"},
        WrongKeys{
            "beam = {elevation = 'piston', samples = 3}\nkind = 'echosounder'",
            ".beam: found a table; accepted: samples of other kinds than \"echosounder\", whose "
            "bins sample it"},
        WrongKeys{
            "step_deg = 60\nazimuth_deg = 10\nkind = 'mechanical'",
            ".step_deg: found 60; accepted: at most azimuth_deg, 10: steps lie within the sector"},
        WrongKeys{
            "gather = 'nearest'\nlabels = {energy = true}",
            ".gather: found \"nearest\"; accepted: plane beside labels.energy: shadow needs a "
            "beam's footprint"},
        WrongKeys{"range_spread = {window = 'hamming'}",
                  ".range_spread.window: found \"hamming\"; accepted: one of none, hann"}),
    wrong_keys_name);

INSTANTIATE_TEST_SUITE_P(
    Terms, SonarError,
    testing::Values(
        WrongKeys{"speckle = {shape = 0.01}",
                  ".speckle.shape: found 0.01; accepted: 0, or in [0.05, 1000]"},
        WrongKeys{"speckle = {texture_m = 1}",
                  ".speckle.texture_m: found 1; accepted: no such key without shape"},
        WrongKeys{
            "noise = {level_db = 60}",
            ".noise: found a table; accepted: noise beside level: its decibels are the level's"},
        WrongKeys{
            "noise = {level_db = 60, wind_m_s = 3}\nlevel = {}",
            ".noise.wind_m_s: found 3; accepted: no such key beside level_db, which is all the "
            "noise"},
        WrongKeys{"noise = {wind_m_s = 61}\nlevel = {}",
                  ".noise.wind_m_s: found 61; accepted: a number in [0, 60] m/s"},
        WrongKeys{
            "noise = {}\nlevel = {}",
            ".noise: found a table; accepted: level_db, or bandwidth_hz of the sonar: ambient "
            "noise fills a band"},
        WrongKeys{"detection = {}",
                  ".detection: found a table; accepted: no such key for kind \"imaging\""},
        WrongKeys{"detection = {pings = 4}\nkind = 'sidescan'",
                  ".detection.pings: found 4; accepted: an odd number"},
        WrongKeys{"detection = {quality = 0.5}\nkind = 'sidescan'",
                  ".detection: found a table; accepted: quality of kind \"profiling\" only"},
        WrongKeys{"detection = {pings = 3}\nkind = 'profiling'",
                  ".detection: found a table; accepted: pings of kind \"sidescan\" only"},
        WrongKeys{
            "detection = {floor_db = 3}\nkind = 'profiling'",
            ".detection: found a table; accepted: floor_db beside noise: its decibels are above "
            "it"},
        WrongKeys{"ghosts = {}",
                  ".ghosts: found no mirror; accepted: surface = true, bottom_m, or both"},
        WrongKeys{"ghosts = {surface = true, bottom_reflection = 1}",
                  ".ghosts.bottom_reflection: found 1; accepted: no such key without bottom_m"},
        WrongKeys{"ghosts = {bottom_m = 0}",
                  ".ghosts.bottom_m: found 0; accepted: a number in (0, 12000] metres"},
        WrongKeys{"sound_speed = {}", ".sound_speed.profile: found nothing; accepted: " SPEEDS},
        WrongKeys{
            "sound_speed = {profile = [[0, 99]]}",
            ".sound_speed.profile: row 1: found 0, 99; accepted: depth_m, m/s in [-100, 12000] "
            "metres and [100, 10000] m/s"},
        WrongKeys{
            "motion = {}",
            ".motion: found no motion; accepted: within_ping = true, doppler = true, or both"},
        WrongKeys{"motion = {within_ping = true, pulse_s = 1}",
                  ".motion.pulse_s: found 1; accepted: no such key without doppler = true"},
        WrongKeys{
            "motion = {doppler = true}",
            ".motion: found a table; accepted: doppler beside range_spread or bandwidth_hz: it "
            "shifts the pulse"},
        WrongKeys{
            "labels = {coco = true}",
            ".labels.coco: found true; accepted: no such key without energy = true, whose masks it "
            "holds"},
        WrongKeys{"labels = {cocoa = true}", ".labels.cocoa: unknown key; nearest known key: coco"},
        WrongKeys{"output = {bits = 12}", ".output.bits: found 12; accepted: 0 (floats), 8 or 16"},
        WrongKeys{
            "output = {bits = 8}",
            ".output: found a table; accepted: output beside level: its floor is in decibels"},
        WrongKeys{
            "output = {span_db = 8}",
            ".output: found a table; accepted: output beside level: its floor is in decibels"}),
    wrong_keys_name);

TEST(SceneMaterial, AnUnknownMaterialIsToldWithTheNearest) {
  const test::ScratchFolder scratch;
  const auto message = [&](const char* keys) {
    EXPECT_TRUE(
        write_text(scratch / "s.toml", std::string("[[objects]]\nshape='sphere'\n") + keys).ok());
    const auto scene = load_scene(scratch / "s.toml");
    return scene.ok() ? std::string("loaded") : scene.error().message;
  };
  const std::string wrong = message("material = 'stel'");
  EXPECT_NE(wrong.find("s.toml:3: objects[0].material: found \"stel\"; accepted: one of water, "),
            std::string::npos)
      << wrong;
  EXPECT_NE(wrong.find("(nearest: steel)"), std::string::npos) << wrong;
  EXPECT_NE(
      message("material = 'steel'\nbackscatter_db = -20")
          .find("objects[0].backscatter_db: found -20; accepted: no such key beside material"),
      std::string::npos);
  EXPECT_NE(message("backscatter_db = 21").find("accepted: a number in [-100, 20] decibels"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::scene
