// The tank that a diver breathes from by the plan of the gases.
#include "diver/gas_switch.hpp"

#include <gtest/gtest.h>

#include "diver/diver_file.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

// A diver of some tanks, of a file's text.
struct Carries {
  DiverFile file;
  Body body;
  TankState tanks;

  explicit Carries(const std::string& text)
      : file(parse_diver(text, "d.toml", test::source_dir(), 1025.0).value()),
        body(make_body(file.parameters).value()),
        tanks(full_tanks(body)) {}
  std::span<const PlanGas> gases() const { return file.computer.gases; }
  std::size_t at(std::size_t breathed, double depth_m, double deepest_m,
                 bool makes_stops = false) const {
    return tank_to_breathe(gases(), body, tanks,
                           {breathed, depth_m, depth_m, deepest_m, makes_stops});
  }
  void leave(std::size_t tank, double bar) {
    const TankPlace& place = body.tanks[tank];
    tanks.moles[tank] = moles_in(place.mix, place.water_volume_m3, 1e5 * bar);
  }
};

// Trimix for 60 m, nitrox from 21 m on, oxygen from 6 m on.
constexpr const char* kThree =
    "tanks = [ { oxygen = 0.18, helium = 0.45 }, { oxygen = 0.5 }, { oxygen = 1.0 } ]\n";

TEST(GasSwitch, EachGasIsBreathedFromItsDepthOnTheWayUp) {
  const Carries diver(kThree);
  EXPECT_EQ(diver.gases()[1].switch_depth_m, 21.0);
  EXPECT_EQ(diver.gases()[2].switch_depth_m, 6.0);
  for (const double down : {8.0, 15.0, 20.0, 40.0, 60.0}) EXPECT_EQ(diver.at(0, down, down), 0u);
  EXPECT_EQ(diver.at(0, 21.1, 60.0), 0u);
  EXPECT_EQ(diver.at(0, 21.0, 60.0), 1u);
  EXPECT_EQ(diver.at(1, 6.1, 60.0), 1u);
  EXPECT_EQ(diver.at(1, 6.0, 60.0), 2u);
  EXPECT_EQ(diver.at(0, 5.0, 60.0), 2u);
  EXPECT_EQ(diver.at(2, 0.0, 60.0), 2u);
  // Never as deep as the nitrox's depth, but stops to make.
  EXPECT_EQ(diver.at(0, 9.0, 20.0), 0u);
  EXPECT_EQ(diver.at(0, 9.0, 20.0, true), 1u);
  // Its stops done it stays on it, until it goes down anew.
  EXPECT_EQ(diver.at(1, 7.0, 20.0), 1u);
  EXPECT_EQ(diver.at(1, 9.0, 9.0), 0u);
}

TEST(GasSwitch, BelowItsDepthNoGasIsBreathedAndNobodyChangesToAndFro) {
  const Carries diver(kThree);
  EXPECT_EQ(diver.at(1, 21.9, 60.0), 1u);
  EXPECT_EQ(diver.at(1, 22.1, 60.0), 0u);
  EXPECT_EQ(diver.at(2, 6.4, 60.0), 2u);
  EXPECT_EQ(diver.at(2, 6.6, 60.0), 1u);
  // Where he will be when he has changed counts too.
  EXPECT_EQ(tank_to_breathe(diver.gases(), diver.body, diver.tanks, {1, 20.0, 22.1, 60.0, false}),
            0u);
  EXPECT_EQ(tank_to_breathe(diver.gases(), diver.body, diver.tanks, {0, 20.9, 21.2, 60.0, false}),
            0u);
  // A file's depth that is too deep for the gas counts as deep as that gas may be breathed.
  const Carries rash("tanks = [ {}, { oxygen = 1.0, switch_depth_m = 12 } ]\n");
  EXPECT_EQ(rash.at(0, 9.0, 40.0, true), 0u);
  EXPECT_EQ(rash.at(0, 6.0, 40.0, true), 1u);
}

TEST(GasSwitch, NeverToAGasWithTooLittleOrTooMuchOxygen) {
  // 10/70 has 0.18 bar of oxygen from 8 m on, and 0.20 from 9.9 m on.
  const Carries deep("tanks = [ { oxygen = 0.1, helium = 0.7 }, { oxygen = 0.5 } ]\n");
  EXPECT_EQ(deep.at(0, 0.0, 0.0), 1u);
  EXPECT_EQ(deep.at(1, 9.0, 9.0), 1u);
  EXPECT_EQ(deep.at(1, 10.5, 10.5), 0u);
  EXPECT_EQ(deep.at(0, 9.0, 9.0), 0u);
  EXPECT_EQ(deep.at(0, 7.0, 9.0), 1u);
  // Air at 90 m has 2.1 bar: trimix, where there is some, and else what there is.
  const Carries narced("tanks = [ {}, { oxygen = 0.1, helium = 0.7 } ]\n");
  EXPECT_EQ(narced.at(0, 90.0, 90.0), 1u);
  EXPECT_EQ(Carries("tanks = [ {}, { oxygen = 0.5 } ]\n").at(0, 90.0, 90.0), 0u);
  for (double depth = 0.0; depth <= 120.0; depth += 0.5)
    for (std::size_t breathed = 0; breathed < 3; ++breathed) {
      Carries diver(kThree);
      diver.leave(0, depth < 60.0 ? 3.0 : 200.0);
      const std::size_t to = diver.at(breathed, depth, 120.0);
      if (to == breathed) continue;
      const double bar = diver.gases()[to].mix.oxygen * (1.0 + depth / 10.0);
      EXPECT_GE(bar, 0.18) << depth;
      if (breathed == 0 && depth < 60.0) continue;  // who gets nothing there takes what there is
      EXPECT_LE(bar, 1.6 + 1e-9) << depth;
    }
}

// On the way down too: what is breathed is left half a metre below the depth of 1.6 bar.
TEST(GasSwitch, WhatIsBreathedHasAtMost1650MillibarOfOxygen) {
  const Carries plan(kThree);
  const Carries at_limits(
      "tanks = [ { oxygen = 0.18, helium = 0.45 }, { oxygen = 0.5, switch_depth_m = 22 }, "
      "{ oxygen = 1.0, switch_depth_m = 6 } ]\n");
  double most_bar = 0.0;
  for (const Carries* diver : {&plan, &at_limits})
    for (double depth = 0.0; depth <= 78.8; depth += 0.05)
      for (std::size_t breathed = 0; breathed < 3; ++breathed)
        for (const bool stops : {false, true}) {
          const std::size_t to = diver->at(breathed, depth, std::max(60.0, depth), stops);
          const double bar = diver->gases()[to].mix.oxygen * (1.0 + depth / 10.0);
          most_bar = std::max(most_bar, bar);
          ASSERT_LE(bar, to == breathed ? 1.65 + 1e-9 : 1.6 + 1e-9) << depth << " " << breathed;
        }
  EXPECT_GT(most_bar, 1.64);
}

// Where the air itself has 0.167 bar, air is no gas to flee from.
TEST(GasSwitch, AirIsBreathedInTheMountains) {
  Carries lake("tanks = [ {}, { oxygen = 0.5 } ]\n");
  EXPECT_EQ(lake.at(0, 0.0, 0.0), 0u);
  lake.body.surface_pa = 79.5e3;
  EXPECT_EQ(lake.at(0, 0.0, 0.0), 0u);
  // A tank that the diver has not got is left.
  EXPECT_EQ(lake.at(3, 5.0, 5.0), 0u);
}

TEST(GasSwitch, AnEmptyTankIsLeftForOneThatCanBeBreathedThere) {
  Carries diver("tanks = [ { volume_l = 3 }, { oxygen = 0.32 }, { oxygen = 0.5 } ]\n");
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 0u);
  diver.leave(0, 13.7);
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 0u);
  diver.leave(0, 13.4);  // a full breath takes 5 bar more than the 3.5 there, and 5 are to spare
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 1u);
  diver.leave(0, 8.4);
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 1u);
  EXPECT_EQ(diver.at(1, 25.0, 25.0), 1u);
  EXPECT_EQ(diver.at(0, 15.0, 25.0), 2u);  // the plan's, and the richer one
  EXPECT_EQ(diver.at(0, 45.0, 45.0), 1u);  // too deep for both, but nothing else gives a breath
  diver.leave(0, 10.6);
  EXPECT_EQ(diver.at(0, 45.0, 45.0), 0u);
  diver.leave(0, 8.4);
  // On the way up the empty one gives a breath again; it is not gone back to.
  EXPECT_EQ(diver.at(1, 22.0, 25.0), 1u);
  // A nearly empty tank is used only if no other is left.
  diver.leave(1, 10.0);
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 1u);
  diver.leave(0, 9.0);
  EXPECT_EQ(diver.at(0, 25.0, 25.0), 0u);
  for (std::size_t tank = 0; tank < 3; ++tank) diver.leave(tank, 1.0);
  for (std::size_t tank = 0; tank < 3; ++tank) EXPECT_EQ(diver.at(tank, 5.0, 25.0), tank);
}

// Too much oxygen is breathed rather than nothing: the least of it.
TEST(GasSwitch, WhoGetsNothingElseTakesTheLeastOxygenAtAnyDepth) {
  Carries twin("tanks = [ {}, {}, { oxygen = 0.5 } ]\n");
  EXPECT_EQ(twin.at(0, 70.0, 70.0), 0u);
  twin.leave(0, 5.0);
  for (const double depth : {60.0, 66.0, 70.0, 90.0}) {
    EXPECT_EQ(twin.at(0, depth, depth), 1u) << depth;
    EXPECT_EQ(twin.at(1, depth, depth), 1u) << depth;
  }
  twin.leave(1, 5.0);
  EXPECT_EQ(twin.at(0, 70.0, 70.0), 2u);
  // 10/70 has 0.14 bar at 4 m: no help; at 7 m 0.17 is.
  Carries shallow("tanks = [ {}, { oxygen = 0.1, helium = 0.7 } ]\n");
  shallow.leave(0, 1.0);
  EXPECT_EQ(shallow.at(0, 4.0, 40.0), 0u);
  EXPECT_EQ(shallow.at(0, 7.0, 40.0), 1u);
}

TEST(GasSwitch, AReactionGoesBeforeTheChangeAndSettingsTurnItOff) {
  const Carries diver("tanks = [ {}, { oxygen = 0.5 } ]\ngas_switches = { reaction_s = 3 }\n");
  DiveComputerState computer;
  computer.deepest_m = 30.0;
  const auto seconds_until_changed = [&](const GasSwitching& settings) {
    GasSwitchState state;
    for (int i = 1; i <= 60; ++i)
      if (step_gas_switch(settings, diver.gases(), diver.body, diver.tanks, computer, 0, 20.0, 0.0,
                          1.0, state) == 1)
        return i;
    return 0;
  };
  EXPECT_EQ(seconds_until_changed(diver.file.gas_switching), 4);  // seen within a second
  EXPECT_EQ(seconds_until_changed({}), 6);
  EXPECT_EQ(seconds_until_changed({.by_plan = false}), 0);
  // A sinking diver will be too deep by then.
  GasSwitchState state;
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(step_gas_switch({}, diver.gases(), diver.body, diver.tanks, computer, 0, 20.0, 0.5,
                              1.0, state),
              0u);
}

TEST(GasSwitch, FilesSayWhetherAndHowFast) {
  const auto read = [](const std::string& text) {
    return parse_diver(text, "d.toml", test::source_dir(), 1025.0);
  };
  EXPECT_TRUE(read("")->gas_switching.by_plan);
  EXPECT_FALSE(read("gas_switches = false\n")->gas_switching.by_plan);
  EXPECT_EQ(read("[gas_switches]\nreaction_s = 20\n")->gas_switching.reaction_s, 20.0);
  for (const char* bad : {"gas_switches = 3\n", "[gas_switches]\nreaction_s = -1\n",
                          "[gas_switches]\nreaction_s = 20.1\n", "[gas_switches]\nafter_s = 1\n"}) {
    const auto file = read(bad);
    ASSERT_FALSE(file.ok()) << bad;
    EXPECT_EQ(file.error().message.rfind("d.toml", 0), 0u) << file.error().message;
  }
  const std::string slow = read("[gas_switches]\nreaction_s = 60\n").error().message;
  EXPECT_NE(slow.find("gas_switches.reaction_s"), std::string::npos) << slow;
  EXPECT_NE(slow.find("20"), std::string::npos) << slow;
}

}  // namespace
}  // namespace neritic::diver
