// Divers from files: given values arrive, absent ones have their defaults, mistakes are reported.
#include "diver/diver_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

using testing::HasSubstr;

DiverFile diver_of(const std::string& text) {
  auto file = parse_diver(text, "d.toml", test::source_dir() / "assets/divers", 1025.0);
  EXPECT_TRUE(file.ok()) << file.error().message;
  return file.ok() ? std::move(file).value() : DiverFile();
}
std::string diver_fault(const std::string& text) {
  const auto file = parse_diver(text, "d.toml", test::source_dir() / "assets/divers", 1025.0);
  return file.ok() ? "" : file.error().message;
}

TEST(DiverFile, NothingSaidIsTheDefaultDiver) {
  const DiverFile file = diver_of("");
  const BodyParameters& p = file.parameters;
  EXPECT_EQ(p.build.height_m, 1.78);
  EXPECT_EQ(p.strips_a_segment, BodyParameters{}.strips_a_segment);
  ASSERT_TRUE(p.gear.suit && p.gear.fins && p.gear.jacket);
  EXPECT_NEAR(p.gear.suit->thickness_m, 0.005, 1e-15);
  ASSERT_EQ(p.gear.tanks.size(), 1u);
  EXPECT_NEAR(p.gear.tanks[0].pressure_pa, 200e5, 1e-6);
  EXPECT_FALSE(p.gear.lead_kg.has_value());
  ASSERT_EQ(file.computer.gases.size(), 1u);
  EXPECT_EQ(file.computer.gases[0].mix, kAir);
}

TEST(DiverFile, FitnessArrivesAndNobodyNeedTire) {
  const Fitness given =
      diver_of("fitness = { most_oxygen_l_min = 2.6, critical_share = 0.7, reserve_kj = 12 }")
          .parameters.fitness;
  EXPECT_EQ(given.most_oxygen_l_min, 2.6);
  EXPECT_EQ(given.critical_share, 0.7);
  EXPECT_EQ(given.reserve_j, 12e3);
  EXPECT_TRUE(given.tires);
  EXPECT_FALSE(diver_of("fitness = false").parameters.fitness.tires);
  EXPECT_THAT(diver_fault("[fitness]\nreserve_kj = 500\n"),
              HasSubstr("fitness.reserve_kj: found 500; accepted: a number in [1, 100]"));
  EXPECT_THAT(diver_fault("[fitness]\ncritical_share = 1.0\n"), HasSubstr("critical_share"));
}

TEST(DiverFile, WhatIsSaidArrives) {
  const DiverFile file = diver_of(R"(
name = "Ada"
sex = "female"
height_m = 1.67
mass_kg = 62
model = "planar"
strips_a_segment = 6
suit_mm = 7
fins = false
lead_kg = 4.5
jacket = { capacity_l = 15 }
tanks = [ { volume_l = 12, pressure_bar = 232, oxygen = 0.32 }, { oxygen = 0.5, volume_l = 7 } ]
kick = { amplitude_m = 0.2, most_hz = 1.1 }
computer = { gf_low = 0.4, gf_high = 0.8 }
)");
  const BodyParameters& p = file.parameters;
  EXPECT_EQ(file.name, "Ada");
  EXPECT_EQ(p.build.sex, Sex::kFemale);
  EXPECT_EQ(p.model, Model::kPlanar);
  EXPECT_EQ(p.strips_a_segment, 6);
  EXPECT_NEAR(p.gear.suit->thickness_m, 0.007, 1e-15);
  EXPECT_FALSE(p.gear.fins.has_value());
  EXPECT_EQ(p.gear.lead_kg, 4.5);
  EXPECT_NEAR(p.gear.jacket->capacity_m3, 0.015, 1e-15);
  ASSERT_EQ(p.gear.tanks.size(), 2u);
  EXPECT_NEAR(p.gear.tanks[0].pressure_pa, 232e5, 1e-3);
  // As heavy for its size as that of 11.1 litres, in proportion.
  EXPECT_NEAR(p.gear.tanks[0].empty_mass_kg, 15.8 * 12.0 / 11.1, 1e-9);
  EXPECT_NEAR(p.gear.tanks[0].outer_volume_m3, 16.6e-3 * 12.0 / 11.1, 1e-12);
  EXPECT_NEAR(std::pow(p.gear.tanks[0].radius_m / 0.092, 3), 12.0 / 11.1, 1e-9);
  EXPECT_EQ(file.swimmer.kick.amplitude_m, 0.2);
  EXPECT_EQ(file.swimmer.most_frequency_hz, 1.1);
  EXPECT_EQ(file.computer.gf_high, 0.8);
  ASSERT_EQ(file.computer.gases.size(), 2u);
  EXPECT_EQ(file.computer.gases[1].mix.oxygen, 0.5);
  EXPECT_EQ(file.computer.gases[1].switch_depth_m, 21.0);  // 1.6 bar
}

TEST(DiverFile, TheShippedOneReads) {
  const auto file = read_diver(test::source_dir() / "assets/divers/recreational.toml", 1028.0);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->parameters.water_kg_m3, 1028.0);
  EXPECT_EQ(diver_of("include = \"recreational.toml\"\nmass_kg = 90").parameters.build.mass_kg, 90);
}

// The air over a lake at 1500 m is the body's and the computer's, which has been there for long.
TEST(DiverFile, TheAirOverTheWaterIsTheScenes) {
  const double surface_pa = 1e5 * surface_bar_at(1500.0);
  EXPECT_NEAR(surface_pa, 84556.0, 0.1);
  const auto file = parse_diver("", "d.toml", ".", 1000.0, surface_pa);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->parameters.surface_pa, surface_pa);
  const DecoEnvironment& where = file->computer.conventions.environment;
  EXPECT_NEAR(where.surface_bar, 0.84556, 1e-6);
  EXPECT_NEAR(where.pressure_bar(10.0),
              1e-5 * pressure_at(make_body(file->parameters).value(), 10.0), 1e-12);
  const DiveComputer computer = DiveComputer::create(file->computer).value();
  EXPECT_NEAR(computer.start().tissues.n2_bar[0], 0.7902 * (0.84556 - 0.0627), 1e-6);
  // Less air over the same water: less time without stops.
  const auto at_sea = DiveComputer::create(parse_diver("", "d.toml", ".", 1000.0)->computer);
  const auto left_min = [](const DiveComputer& c) {
    return c.view(c.step(c.start(), {24.0, 0}, 0.0)).no_stop_min;
  };
  EXPECT_LT(left_min(computer), 0.9 * left_min(*at_sea));
}

TEST(DiverFile, MistakesNameTheFileAndTheKey) {
  EXPECT_THAT(diver_fault("hight_m = 1.8"), HasSubstr("height_m"));
  EXPECT_THAT(diver_fault("sex = \"other\""), HasSubstr("male or female"));
  EXPECT_THAT(diver_fault("height_m = 9"), HasSubstr("d.toml:1: height_m: found 9"));
  EXPECT_THAT(diver_fault("suit_mm = 90"), HasSubstr("suit"));
  EXPECT_THAT(diver_fault("[[tanks]]\noxygen = 2"), HasSubstr("oxygen"));
  EXPECT_THAT(diver_fault("[computer]\ngf_low = 0.9\ngf_high = 0.2"), HasSubstr("computer"));
  EXPECT_THAT(diver_fault("[computer]\nconventions = \"mine\""), HasSubstr("mine"));
  EXPECT_THAT(diver_fault("fins = 3"), HasSubstr("fins"));
  EXPECT_THAT(diver_fault("height_m = nan"), HasSubstr("height_m"));
}

// In the file's own units, by its own keys, and where it is.
TEST(DiverFile, MistakesAreSaidInTheFilesUnitsAndWithTheirLine) {
  EXPECT_EQ(diver_fault("height_m = 1.8\n[[tanks]]\n[[tanks]]\nvolume_l = 7\npressure_bar = 351\n"),
            "d.toml:5: tanks[1].pressure_bar: found 351; accepted: a number in [0, 350]");
  EXPECT_EQ(diver_fault("\nsuit_mm = -1"),
            "d.toml:2: suit_mm: found -1; accepted: a number in [0, 12]");
  EXPECT_EQ(diver_fault("suit_mm = 0.005"),
            "d.toml:1: suit_mm: found 0.005; accepted: 0 or 0.5 to 12 millimetres");
  EXPECT_EQ(diver_fault("strips_a_segment = 4.5"),
            "d.toml:1: strips_a_segment: found 4.5; accepted: a whole number from 1 to 64");
  EXPECT_EQ(diver_fault("# a comment\nfins = { length_m = 0.4, width_m = 3 }"),
            "d.toml:2: fins.width_m: found 3; accepted: a number in [0.02, 1]");
  EXPECT_EQ(diver_fault("jacket = { capacity_l = 0.2 }"),
            "d.toml:1: jacket.capacity_l: found 0.2; accepted: a number in [1, 60]");
  for (const char* litres : {"-50", "1000", "21"})
    EXPECT_EQ(diver_fault(std::string("jacket = { volume_l = ") + litres + " }"),
              fmt::format("d.toml:1: jacket.volume_l: found {:g}; accepted: a number in [0, 20]",
                          std::stod(litres)));
  EXPECT_EQ(diver_fault("[[tanks]]\noxygen = 0.6\nhelium = 0.5"),
            "d.toml:3: tanks[0].helium: found 0.5 beside 0.6 of oxygen; accepted: shares of 1");
  EXPECT_EQ(diver_fault("\n\nheigth_m = 1.8"),
            "d.toml:3: heigth_m: not known; the nearest is height_m");
  EXPECT_THAT(diver_fault("height_m = 1.8\nmass_kg = 31"),
              HasSubstr("d.toml:2: mass_kg: found 31 at a height of 1.8 m"));
  EXPECT_THAT(diver_fault("[computer]\ngf_high = 3"),
              HasSubstr("d.toml:2: computer.gf_high: found 3; accepted: a number in [0.01, 1.5]"));
  EXPECT_THAT(diver_fault("\n[computer]\ngf_low = 0.9\ngf_high = 0.2"),
              HasSubstr("d.toml:2: computer: "));
}

}  // namespace
}  // namespace neritic::diver
