// `neritic plan` and `neritic check deco`: what they print, write and refuse. The program itself is
// run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "diver/tanks.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/undrawn.hpp"
#include "tools/neritic/plan_gas_curves.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;

struct PlanSaid {
  int status = -1;
  std::string out, error;
};

PlanSaid said_by(const std::string& arguments, const char* before = "") {
  const test::ScratchFolder folder;
  const std::string command =
      fmt::format("{} " NERITIC_BINARY_DIR "/tools/neritic {} > {} 2> {}", before, arguments,
                  (folder / "out").string(), (folder / "error").string());
  PlanSaid said;
  const int raw = std::system(command.c_str());
  said.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  said.out = read_text(folder / "out").value();
  said.error = read_text(folder / "error").value();
  return said;
}

std::string deco_file(const char* name) {
  return (test::source_dir() / "tests/diver/data" / name).string();
}

TEST(PlanCommand, APlanIsPrintedAsADiverExpectsIt) {
  const PlanSaid said = said_by("plan --gas 18/45 ean50 o2 --depth 60 --time 25 --gf 30/80");
  EXPECT_EQ(said.status, 0) << said.error;
  EXPECT_THAT(said.out, HasSubstr("60 m until 25 min on 18/45, EAN50 from 21 m, O2 from 6 m\n"));
  EXPECT_THAT(said.out, HasSubstr("stop        33 m    1:00   28:42  18/45    0.78"));
  EXPECT_THAT(said.out, HasSubstr("stop         3 m   14:00   73:42  O2       1.31"));
  EXPECT_THAT(said.out, HasSubstr("stops 43:00 min, ascent 49:00 min, run time 74:00 min"));
  EXPECT_THAT(said.out, HasSubstr("CNS 51 %, OTU 97, highest pO2 1.61 bar"));
  EXPECT_THAT(said.out, HasSubstr("MOD of EAN50: 21.9 m at 1.6 bar"));
  EXPECT_THAT(said.out, HasSubstr("WARNING: gas density 5.6 g/L on 18/45 at 60 m"));
  EXPECT_THAT(said_by("plan --depth 18 --time 40").out,
              HasSubstr("no stops are needed\nno-stop limit: 47 min"));
}

// The picture shows each warning too, as a red line above the panels.
TEST(PlanCommand, TheFirstLineNamesTheTableAndTheFlagForTheOther) {
  const auto first_line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  EXPECT_EQ(first_line(said_by("plan --depth 30 --time 25").out),
            "ZH-L16B (--table c: ZH-L16C): 30 m until 25 min on air");
  EXPECT_EQ(first_line(said_by("plan --depth 30 --time 25 --table c").out),
            "ZH-L16C (--table b: ZH-L16B): 30 m until 25 min on air");
  EXPECT_EQ(first_line(said_by("plan --depth 30 --time 25 --convention run-minutes").out),
            "ZH-L16C (--table b: ZH-L16B): 30 m until 25 min on air");
}

TEST(PlanCommand, WarningsStandOnThePicture) {
  const test::ScratchFolder folder;
  struct Drawn {
    std::uint32_t height = 0, red_rows = 0;
    std::ptrdiff_t warnings = 0;
  };
  const auto drawn = [&](const std::string& tank) {
    const std::string file = (folder / "p.png").string();
    const PlanSaid said =
        said_by("plan --depth 18 --time 40 --tank air=" + tank + " --altitude 1500 --plot " + file);
    EXPECT_EQ(said.status, 0) << said.error;
    const auto image = scene::read_image8(file, 3);
    EXPECT_TRUE(image.ok());
    Drawn out;
    out.height = image->height;
    std::size_t at = 0;
    while ((at = said.out.find("WARNING: ", at) + 1) != 0) ++out.warnings;
    for (std::uint32_t y = 0; y < 100; ++y) {
      bool red = false;
      for (std::uint32_t x = 24; x < 300; ++x) {
        const std::uint8_t* rgb = &image->data[3 * (std::size_t{y} * image->width + x)];
        red = red || (rgb[0] > 150 && rgb[1] < 90 && rgb[2] < 90);
      }
      out.red_rows += red ? 1 : 0;
    }
    return out;
  };
  const Drawn much = drawn("24,232"), little = drawn("12,200");
  EXPECT_EQ(much.warnings, 0);
  EXPECT_EQ(much.red_rows, 0u);
  EXPECT_EQ(little.warnings, 1);
  EXPECT_EQ(little.height, much.height + 19u);
  EXPECT_GE(little.red_rows, 7u);
  EXPECT_LE(little.red_rows, 20u);
}

TEST(PlanCommand, FlagsChangeWhatTheyName) {
  const auto stop_min = [](const std::string& with) {
    const PlanSaid said = said_by("plan --depth 45 --time 25 --json " + with);
    EXPECT_EQ(said.status, 0) << with << said.error;
    const auto json = parse_json(said.out);
    return json.ok() ? (*json)["total_stop_time_min"].get<double>() : -1.0;
  };
  EXPECT_EQ(stop_min(""), 37.0);
  EXPECT_EQ(stop_min("--water salt"), 38.0);
  EXPECT_EQ(stop_min("--water fresh"), 34.0);
  EXPECT_EQ(stop_min("--water 1019.716"), 37.0);
  EXPECT_EQ(stop_min("--surface 1.0"), 37.0);
  EXPECT_EQ(stop_min("--table c"), 42.0);
  EXPECT_EQ(stop_min("--last-stop 6"), 45.0);
  EXPECT_EQ(stop_min("--descent-rate 18"), 36.0);
  EXPECT_EQ(stop_min("--ascent-rate 9"), 37.0);
  EXPECT_EQ(stop_min("--gf 100/100"), 20.0);
  EXPECT_EQ(stop_min("--gf 30/70"), 56.0);
  EXPECT_EQ(stop_min("--gas air ean50@24 --last-stop 6"), 22.0);
  EXPECT_GT(stop_min("--altitude 2500"), 37.0);
  // The sea's own air is 1.01325 bar, which is not what every convention has over it.
  EXPECT_EQ(stop_min("--convention msw --altitude 0"),
            stop_min("--convention msw --surface 1.01325"));
  EXPECT_GT(stop_min("--saturation 110/90"), 40.0);
  EXPECT_GT(stop_min("--after 30,25,60"), 37.0);
  EXPECT_GT(stop_min("--after 30,25,60 --after 30,25,60,ean32"),
            stop_min("--after 30,25,60,ean32"));
  EXPECT_GT(stop_min("--level 20,60"), 37.0);
  EXPECT_NEAR(stop_min("--convention run-minutes"), 44.0, 4.0);
}

// Sea level is not what this set takes for it.
TEST(PlanCommand, AnAltitudeOfNothingIsSeaLevel) {
  EXPECT_THAT(said_by("plan --depth 30 --time 20 --convention msw").out,
              HasSubstr("surface 1.0000 bar"));
  EXPECT_THAT(said_by("plan --depth 30 --time 20 --convention msw --altitude 0").out,
              HasSubstr("surface 1.0132 bar"));
}

// Each earlier dive is the same as this one: what it left halves in 90 min.
TEST(PlanCommand, OxygenOfEarlierDivesCounts) {
  const auto planned = [](const std::string& after) {
    return parse_json(said_by("plan --gas ean36 --depth 30 --time 60 --json " + after).out).value();
  };
  const nlohmann::json fresh = planned(""), later = planned("--after 30,60,90,ean36"),
                       third = planned("--after 30,60,90,ean36 --after 30,60,0,ean36");
  const double cns = fresh["cns_percent"], otu = fresh["otu"];
  EXPECT_GT(cns, 40.0);
  EXPECT_EQ(fresh["cns_percent_before"], 0.0);
  EXPECT_NEAR(later["cns_percent_before"].get<double>(), 0.5 * cns, 1e-9);
  EXPECT_NEAR(later["otu_before"].get<double>(), otu, 1e-9);
  EXPECT_NEAR(later["cns_percent"].get<double>(), 1.5 * cns, 3.0);  // its stops are longer
  EXPECT_NEAR(third["cns_percent_before"].get<double>(), later["cns_percent"].get<double>(), 1e-9);
  EXPECT_NEAR(third["otu_before"].get<double>(), later["otu"].get<double>(), 1e-9);
  EXPECT_EQ(planned("--after 30,60,1500,ean36")["otu_before"], 0.0);
  const std::string said =
      said_by("plan --gas ean36 --depth 30 --time 60 --after 30,60,10,ean36").out;
  EXPECT_THAT(said, HasSubstr(" (of earlier dives 42 %"));
  EXPECT_THAT(said, HasSubstr("WARNING: CNS "));
}

TEST(PlanCommand, JsonAndPicturesAreWritten) {
  const test::ScratchFolder folder;
  const PlanSaid said =
      said_by("plan --gas 21/35 ean50 --depth 50 --time 25 --out " + (folder / "plan").string() +
              " --plot " + (folder / "p.png").string());
  EXPECT_EQ(said.status, 0) << said.error;
  EXPECT_GT(std::filesystem::file_size(folder / "plan/plan.png"), 20000u);
  EXPECT_EQ(read_file(folder / "p.png").value(), read_file(folder / "plan/plan.png").value());
  EXPECT_EQ(read_text(folder / "p.plot.json").value(),
            read_text(folder / "plan/plan.plot.json").value());
  const auto json = parse_json(read_text(folder / "plan/plan.json").value()).value();
  EXPECT_EQ(json["stops"].size(), 8u);
  EXPECT_EQ(json["stops"][1]["gas"], "EAN50");
  EXPECT_EQ(json["end_of_bottom"]["tissues_n2_he_bar"].size(), 16u);
  EXPECT_NEAR(json["ndl_runtime_min"].get<double>(), 5.56838, 1e-5);
}

TEST(PlanCommand, GasIsReckonedForEachTank) {
  const PlanSaid said =
      said_by("plan --depth 30 --time 20 --rmv 18,15 --minimum-gas 2,1.5,1 --tank air=15,230");
  EXPECT_EQ(said.status, 0) << said.error;
  EXPECT_THAT(said.out, HasSubstr("END  litres\n"));
  EXPECT_THAT(said.out,
              HasSubstr("bottom      30 m   18:30   20:00  air      0.84   5.2  30 m    1335\n"));
  EXPECT_THAT(said.out, HasSubstr("gas at 18 L/min, 15 from the ascent on"));
  EXPECT_THAT(said.out, HasSubstr("L; a tank of 15 L at 230 bar ends at "));
  EXPECT_THAT(said.out, HasSubstr("; minimum gas at 30 m, 20 min: "));
  EXPECT_THAT(said.out, testing::Not(HasSubstr("WARNING: tank")));
  const auto gas = [](const std::string& with) {
    return parse_json(said_by("plan --depth 30 --time 20 --json " + with).out).value()["gas"];
  };
  const auto json = gas("--tank air=24,230");
  EXPECT_EQ(json["rmv_l_min"], 20.0);
  EXPECT_EQ(json["gases"][0]["tank"]["enough"], true);
  EXPECT_GT(json["gases"][0]["tank"]["then_bar"].get<double>(),
            json["gases"][0]["tank"]["minimum_bar"].get<double>());
  EXPECT_EQ(gas("--tank air=7,200")["gases"][0]["tank"]["enough"], false);
  EXPECT_TRUE(gas("--tank air=7,200")["gases"][0]["tank"].contains("used_up_at"));
  EXPECT_NEAR(gas("--sac 40")["gases"][0]["used_l"].get<double>() /
                  gas("--sac 20")["gases"][0]["used_l"].get<double>(),
              2.0, 1e-9);
  EXPECT_THAT(said_by("plan --depth 30 --time 20 --tank air=7,200").out,
              HasSubstr("WARNING: tank of air, 7 L at 200 bar: used up at 30 m, "));
}

// One bottle, whatever it is breathed for; and a first level on the travel gas is a dive like
// others.
// The line of a tank ends where the text says that it is used up, with what gives no full breath.
TEST(PlanCommand, ATanksLineEndsWhereItIsUsedUp) {
  diver::DivePlanRequest request;
  request.conventions = diver::conventions_of("stop-minutes").value();
  request.gases = {{diver::kAir, 0.0, diver::GasRole::kBottom}};
  request.levels = {{40.0, 30.0}};
  const auto report = make_plan_report("stop-minutes", request, {}, {{0, 12.0, 200.0}});
  ASSERT_TRUE(report.ok()) << report.error().message;
  const diver::PlanTankUse& tank = *report->gas.at(0).tank;
  ASSERT_TRUE(tank.empty_min.has_value());
  const GasCurve curve = gas_curves(*report).at(0);
  EXPECT_TRUE(curve.used_up);
  EXPECT_DOUBLE_EQ(curve.run_min.back(), *tank.empty_min);
  const double least_bar =
      request.conventions.environment.pressure_bar(40.0) + 1e-5 * diver::kWeakTank_pa;
  EXPECT_NEAR(curve.value.back(), least_bar, 1e-6);
  EXPECT_TRUE(std::ranges::is_sorted(curve.run_min));
  EXPECT_TRUE(std::ranges::is_sorted(curve.value, std::greater<>()));
  const PlanSaid said = said_by("plan --gas air --depth 40 --time 30 --tank air=12,200");
  EXPECT_THAT(said.out,
              HasSubstr(fmt::format("used up at 40 m, {:.0f} min", curve.run_min.back())));
  // One that lasts is drawn to the end.
  const auto lasts = make_plan_report("stop-minutes", request, {}, {{0, 40.0, 200.0}});
  const GasCurve whole = gas_curves(*lasts).at(0);
  EXPECT_FALSE(whole.used_up);
  EXPECT_NEAR(whole.run_min.back(), lasts->plan.run_min(), 1e-9);
  EXPECT_NEAR(whole.value.back(), lasts->gas[0].tank->end_bar, 1e-6);
}

TEST(PlanCommand, ATravelGasThatIsTheDecoGasIsOneTank) {
  const std::string dive = "plan --depth 60 --time 20 --gas 15/55@30 ean50@21 --travel ean50 ";
  const auto gas =
      parse_json(said_by(dive + "--json --tank ean50=11,200").out).value()["gas"]["gases"];
  ASSERT_EQ(gas.size(), 2u);
  EXPECT_EQ(gas[1]["name"], "EAN50");
  EXPECT_TRUE(gas[1].contains("tank"));
  const std::string said = said_by(dive + "--tank ean50=11,200").out;
  const std::size_t at = said.find("  EAN50: ");
  ASSERT_NE(at, said.npos);
  EXPECT_EQ(said.find("  EAN50: ", at + 1), said.npos);
  EXPECT_EQ(said_by("plan --gas 15/55@30 --travel ean32 --depth 20 --time 5 --level 60,25").status,
            0);
}

// Plans of several levels, and of depths between whole metres.
TEST(PlanCommand, DepthsAndLevelsAreSaidAsTheyAre) {
  const std::string said = said_by("plan --depth 30 --time 20 --level 18,45").out;
  EXPECT_THAT(said, HasSubstr("min of run time at 30 m alone\n"));
  EXPECT_THAT(said_by("plan --depth 22.5 --time 40").out, HasSubstr("bottom    22.5 m   "));
}

TEST(PlanCommand, ALogOfNegativeDepthsIsRefusedOrTurnedOver) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "up.csv", "time_s,depth_m\n0,0.3\n60,-18\n1200,-18\n").ok());
  const std::string log = "plan --log " + (folder / "up.csv").string();
  const PlanSaid refused = said_by(log);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("up.csv: line 3: found depth '-18'; accepted: from -1"));
  EXPECT_EQ(refused.out, "");
  const PlanSaid turned = said_by(log + " --depths-up");
  EXPECT_EQ(turned.status, 0) << turned.error;
  EXPECT_THAT(turned.out, HasSubstr("deepest 18.0 m; ZH-L16B (--table c: ZH-L16C)\n"));
  EXPECT_EQ(said_by("plan --depth 30 --time 25 --depths-up").status, 2);
}

TEST(PlanCommand, ALogWithoutAnyDepthIsRefused) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "none.csv", "time_s,depth_m\n0,nan\n1,nan\n2,nan\n").ok());
  const PlanSaid refused = said_by("plan --log " + (folder / "none.csv").string() + " --out " +
                                   (folder / "out").string());
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("none.csv: found no depth that a dive has in 3 samples"));
  EXPECT_EQ(refused.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(PlanCommand, ALogThatHidesItsDiveIsRefusedAndOneBadSampleIsNamed) {
  const test::ScratchFolder folder;
  const auto replayed = [&](const std::string& rows, const std::string& with = "") {
    EXPECT_TRUE(write_text(folder / "d.csv", "time_s,depth_m\n" + rows).ok());
    return said_by("plan --log " + (folder / "d.csv").string() + with, test::kUndrawn);
  };
  const PlanSaid hidden = replayed("0,0\n120,nan\n1200,30\n1800,0\n");
  EXPECT_EQ(hidden.status, 2);
  EXPECT_THAT(hidden.error, HasSubstr("d.csv: line 3: found depth 'nan', and no depth for 1200 s"));
  EXPECT_EQ(hidden.out, "");
  EXPECT_EQ(replayed("0,1013\n60,2013\n1200,4013\n1800,1013\n").status, 2);
  const PlanSaid one =
      replayed("0,0\n40,20\n50,nan\n60,30\n1200,30\n", " --out " + (folder / "out").string());
  EXPECT_EQ(one.status, 0) << one.error;
  EXPECT_THAT(one.out, HasSubstr("5 samples, 1 refused"));
  EXPECT_THAT(one.out,
              HasSubstr("\nNOTE: a sample was refused, first in line 4: found depth 'nan'"));
  EXPECT_THAT(one.out, HasSubstr("\nNOTE: from line 5 to 6, 1140 s pass without a sample"));
  const std::string rows = read_text(folder / "out/log.csv").value();
  EXPECT_THAT(rows, HasSubstr("\n50,25,air,"));
  EXPECT_THAT(rows, HasSubstr(",1\n60,30,air,"));
  // After a short visit below the tissues hold less than the air at the surface presses.
  const PlanSaid spike = replayed("0,0\n1,60\n2,0\n600,0\n");
  EXPECT_THAT(spike.out, HasSubstr("ceiling 0.0 m, 0 % of the M-value at the surface"));
}

TEST(PlanCommand, ALogIsReplayedSampleBySample) {
  const test::ScratchFolder folder;
  std::string log = "time_s,depth_m,gas\n";
  for (int s = 0; s <= 1800; s += 10)
    log += fmt::format("{},{},ean32\n", s,
                       s == 600 ? "nan"
                       : s < 90 ? fmt::format("{}", s / 3)
                                : "30");
  ASSERT_TRUE(write_text(folder / "dive.csv", log).ok());
  const PlanSaid said = said_by("plan --json --log " + (folder / "dive.csv").string() + " --out " +
                                (folder / "out").string());
  EXPECT_EQ(said.status, 0) << said.error;
  const auto json = parse_json(said.out).value();
  EXPECT_EQ(json["samples"], 181);
  EXPECT_EQ(json["refused"], 1);
  EXPECT_EQ(json["deepest_m"], 30.0);
  EXPECT_GT(json["ceiling_m"].get<double>(), 0.0);
  EXPECT_EQ(std::ranges::count(read_text(folder / "out/log.csv").value(), '\n'), 182);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/log.png"));
}

// The depth of a flag holds whether the diver has switched by then or not; and a log that begins on
// the travel gas has the bottom gas that is named.
TEST(PlanCommand, FlagsSayFromWhereAGasOfTheLogIsBreathed) {
  const test::ScratchFolder folder;
  const auto log_of = [&](const char* name, const char* first) {
    std::string log = "time_s,depth_m,gas\n";
    for (int s = 0; s <= 1800; s += 10)
      log += fmt::format("{},{},{}\n", s, std::min(s / 3.0, 50.0), s < 60 ? first : "18/45");
    EXPECT_TRUE(write_text(folder / name, log).ok());
  };
  const auto up_min = [&](const char* name, const std::string& flags) {
    const PlanSaid said =
        said_by("plan --json --log " + (folder / name).string() + " --gas " + flags);
    EXPECT_EQ(said.status, 0) << said.error;
    return parse_json(said.out).value()["time_to_surface_min"].get<double>();
  };
  log_of("before.csv", "18/45");
  log_of("travel.csv", "ean50");
  double last = 0.0;
  for (const std::string at : {"21", "12", "6"}) {
    const double before = up_min("before.csv", "18/45 ean50@" + at);
    EXPECT_GT(before, last + 2.0) << at;
    EXPECT_NEAR(up_min("travel.csv", "18/45 ean50@" + at), before, 1.5) << at;
    last = before;
  }
}

TEST(PlanCommand, ALogOfSeveralVehiclesIsOneOfThem) {
  const test::ScratchFolder folder;
  std::string log = "time_s,vehicle,depth_m\n";
  for (int s = 0; s <= 600; s += 10) log += fmt::format("{0},rov,15\n{0},diver,3\n", s);
  ASSERT_TRUE(write_text(folder / "dive.csv", log).ok());
  const std::string of_log = "plan --json --log " + (folder / "dive.csv").string();
  const PlanSaid both = said_by(of_log);
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.error, HasSubstr("found rows of rov, diver; accepted: one, choose by --vehi"));
  EXPECT_EQ(std::ranges::count(both.error, '\n'), 1);
  EXPECT_THAT(said_by(of_log + " --vehicle cat").error,
              HasSubstr("found 'cat'; accepted: rov, diver"));
  const PlanSaid one = said_by(of_log + " --vehicle diver");
  EXPECT_EQ(one.status, 0) << one.error;
  const auto json = parse_json(one.out).value();
  EXPECT_EQ(json["samples"], 61);
  EXPECT_EQ(json["deepest_m"], 3.0);
  EXPECT_TRUE(json["no_stop_min"].is_null());  // no limit at 3 m
  const std::string out = " --out " + (folder / "out").string();
  ASSERT_EQ(said_by(of_log + " --vehicle diver" + out, test::kUndrawn).status, 0);
  const std::string rows = read_text(folder / "out/log.csv").value();
  EXPECT_THAT(rows, HasSubstr("600,3,air,0,,0,0,0.3,"));
  EXPECT_THAT(rows, testing::Not(HasSubstr("inf")));
  EXPECT_THAT(rows, testing::Not(HasSubstr(",-0,")));
}

TEST(PlanCommand, Status2AndOneLineWhereTheFlagsAreWrong) {
  for (const auto& [arguments, error] :
       {std::pair{"plan", "plan: found no --depth and --time; accepted: depth (m) and time"},
        {"plan --depth 30", "plan: found no --time; accepted: depth"},
        {"plan --time 30", "plan: found no --depth; accepted: depth"},
        {"plan --depth 30 --time 20 --gf 0/85", "--gf: found '0/85'; accepted: 1 to 150 percent"},
        {"plan --depth 30 --time 1", "found 30 m until 1 min, though it is reached after 1.5 min"},
        {"plan --depth nan --time 20", "--depth: found nan; accepted: a number"},
        {"plan --depth 20 --time inf", "--time: found inf; accepted: a number"},
        {"plan --depth 30 --time 20 --gas water",
         "--gas: found gas 'water'; accepted: air, o2, ean32"},
        {"plan --depth 30 --time 20 --tank water=12,200", "--tank: found gas 'water'"},
        {"plan --depth 30 --time 20 --gas air ean50@deep",
         "--gas: found 'deep'; accepted: a number"},
        {"plan --depth 30 --time 20 --gf 30", "--gf: found '30'; accepted: two percentages"},
        {"plan --depth 30 --time 20 --gf 90/30",
         "--gf: found '90/30'; accepted: 1 to 150 percent, the first not above"},
        {"plan --depth 30 --time 20 --convention best",
         "found convention 'best'; accepted: stop-minutes"},
        {"plan --depth 30 --time 20 --water beer", "--water: found 'beer'; accepted: fresh, salt"},
        {"plan --depth 30 --time 20 --altitude 90000", "--altitude: found 90000"},
        {"plan --depth 30 --time 20 --last-stop 4",
         "found last stop 4 m; accepted: a multiple of 3 m"},
        {"plan --depth 30 --time 20 --after 30,25", "--after: found 2 numbers in '30,25'"},
        {"plan --depth 30 --time 20 --table z", "--table: found 'z'; accepted: b or c"},
        {"plan --depth 30 --time 20 --ascent-rate 0", "0 up; accepted: 0.1 to 1000 m/min"},
        {"plan --depth 30 --time 20 --descent-rate 0", "rates of 0 down"},
        {"plan --depth 30 --time 20 --last-stop 0", "found last stop 0 m"},
        {"plan --depth 30 --time 20 --surface 0", "found surface pressure 0 bar"},
        {"plan --depth 0 --time 20", "found 0 m until 20 min"},
        {"plan --gas 10/70 --depth 100 --time 15 --travel ean32",
         "found bottom gas 10/70 and travel gas EAN32 both from 0 m"},
        {"plan --gas 10/70 --depth 100 --time 15 --travel ean32@0 21/35@30",
         "found bottom gas 10/70 and travel gas EAN32 both from 0 m"},
        {"plan --gas 10/70@40 --depth 30 --time 15 --travel ean32",
         "found bottom gas 10/70 from 40 m while EAN32 is breathed at 30 m"},
        {"plan --gas 10/70@20 --depth 60 --time 15 --travel ean32 21/35@30",
         "found bottom gas 10/70 from 20 m while 21/35 is breathed at 60 m"},
        {"plan --depth 30 --time 20 --gas ean32@50",
         "--gas: found EAN32 from 50 m, with nothing to breathe above; accepted: a bottom"},
        {"plan --depth 60 --time 30 --level 3,60",
         "found 3 m until 60 min, above the ceiling, which is at 29.39 m on the way there; "
         "accepted: 29.4"},
        {"plan --depth 30 --time 20 --tank air=12", "--tank: found 1 number in '12'; accepted: 2"},
        {"plan --depth 30 --time 20 --tank 12,200",
         "--tank: found '12,200'; accepted: GAS=LITRES,BAR"},
        {"plan --depth 30 --time 20 --tank o2=12,200", "found a tank of O2; accepted: gases of"},
        {"plan --depth 30 --time 20 --rmv 0", "litres a minute: found 0; accepted: 1 to 200"},
        {"plan --log nowhere.csv --depth 40", "--log: found with --depth, --time or --level"},
        {"plan --depth 30 --time 20 --altitude 2000 --surface 1.0",
         "--altitude, --surface: found both; accepted: one of them"},
        {"plan --depth 30 --time 20 --vehicle diver", "--vehicle: found without --log"},
        {"plan --log nowhere.csv", "nowhere.csv: found no such file"}}) {
    const PlanSaid said = said_by(arguments);
    EXPECT_EQ(said.status, 2) << arguments;
    EXPECT_THAT(said.error, HasSubstr(error)) << arguments;
    EXPECT_EQ(std::ranges::count(said.error, '\n'), 1) << arguments;
    EXPECT_EQ(said.out, "") << arguments;
  }
}

TEST(CheckDeco, ALineACaseAndItsStatus) {
  const PlanSaid all = said_by("check deco " + deco_file("deco_vectors.json"));
  EXPECT_EQ(all.status, 0) << all.error;
  EXPECT_EQ(std::ranges::count(all.out, '\n'), 50);
  EXPECT_EQ(said_by("check deco " + deco_file("deco_more.json")).status, 0);

  const test::ScratchFolder folder;
  nlohmann::json json = parse_json(read_text(deco_file("deco_vectors.json")).value()).value();
  json["profiles"][3]["reference"]["stops"][5]["minutes"] = 23;
  json["ndl_tables"] = {json["ndl_tables"][0]};
  ASSERT_TRUE(write_json(folder / "wrong.json", json).ok());
  const PlanSaid wrong = said_by("check deco --json " + (folder / "wrong.json").string());
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.error, HasSubstr("wrong.json: 1 of 27 cases do not hold"));
  const auto result = parse_json(wrong.out).value();
  EXPECT_EQ(result["failed"], 1);
  EXPECT_EQ(result["cases"][3]["ok"], false);
  EXPECT_EQ(result["cases"][3]["worst"]["what"], "stops");
  EXPECT_NEAR(result["cases"][3]["worst"]["error"].get<double>(), 1.0, 1e-9);

  ASSERT_TRUE(write_text(folder / "bad.json", "{\"profiles\": 3}").ok());
  const PlanSaid bad = said_by("check deco " + (folder / "bad.json").string());
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.error, HasSubstr("bad.json: profiles: found 3; accepted: a list\n"));
}

}  // namespace
}  // namespace neritic::tools
