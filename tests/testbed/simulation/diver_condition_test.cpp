// Divers of a scene who do not notice what gas and cold do, who share gas, and whose regulator
// blows off.
#include "testbed/simulation/diver_condition.hpp"

#include "diver/condition.hpp"
#include "engine/core/files.hpp"
#include "testbed/simulation/output_samples.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

std::string named(std::string text, const std::string& name) {
  return text.replace(text.find("name = \"diver\""), 14, "name = \"" + name + "\"");
}

// A diver with these tanks, hovering; keys of the object follow.
struct Files {
  test::ScratchFolder folder;
  std::string file(const std::string& name, const std::string& text) {
    const std::string path = (folder / name).string();
    EXPECT_TRUE(write_text(path, text).ok());
    return path;
  }
};

double all_moles(const HumanPhysics& human) {
  double sum = 0.0;
  for (const double moles : human.human.life.tanks.moles) sum += moles;
  return sum;
}

TEST(SceneCondition, OneThatDoesNotActLeavesEveryBitOfTheDiver) {
  const std::string keys =
      std::string(kProne) + "position_m = [0, -30, 0]\nswim = { waypoints_m = [[0, -30, -20]] }\n";
  TestDive without = dive_of(kStillWater + diver_text(keys));
  TestDive with = dive_of(kStillWater + diver_text(keys + "condition = { acts = false }\n"));
  without.run(5.0), with.run(5.0);
  EXPECT_TRUE(without.state().conditions().empty());
  ASSERT_EQ(with.state().conditions().size(), 1u);
  EXPECT_EQ(
      std::memcmp(&without.state().humans()[0], &with.state().humans()[0], sizeof(HumanPhysics)),
      0);
  // Air at 30 m: as Kiessling and Maag measured.
  EXPECT_NEAR(with.state().conditions()[0].slowing,
              1.0 + diver::narcosis_slowing(
                        with.state().humans()[0].human.life.vitals.risk.narcotic_depth_m),
              1e-12);
  EXPECT_NEAR(with.state().conditions()[0].slowing, 1.209, 0.01);
}

TEST(SceneCondition, AGasWithoutOxygenEndsTheSwim) {
  Files files;
  const std::string thin = files.file(
      "thin.toml", "tanks = [ { oxygen = 0.03, helium = 0.5 } ]\ngas_switches = false\n");
  const auto text = [&](const std::string& keys) {
    return kStillWater + diver_text(std::string(kProne) +
                                        "position_m = [0, -3, 0]\nswim = { speed_m_s = 0.4, "
                                        "waypoints_m = [[0, -3, -200]] }\n" +
                                        keys,
                                    thin);
  };
  TestDive unaware = dive_of(text("")),
           aware = dive_of(text("condition = { effects = [\"hypoxia\"] }\n"));
  double lost_s = 0.0;
  aware.run(120.0, [&] {
    if (lost_s == 0.0 && aware.state().conditions()[0].lost != 0) lost_s = aware.time_s();
  });
  unaware.run(120.0);
  EXPECT_GT(lost_s, 15.0);
  EXPECT_LT(lost_s, 100.0);
  EXPECT_EQ(aware.state().conditions()[0].lost, diver::kHypoxia);
  EXPECT_EQ(aware.state().humans()[0].swimmer.effort, 0.0);
  EXPECT_GT(unaware.state().humans()[0].human.root.position_ned_m.x, 35.0);
  EXPECT_LT(aware.state().humans()[0].human.root.position_ned_m.x,
            unaware.state().humans()[0].human.root.position_ned_m.x - 5.0);
}

// A diver who faints in the middle of a kick goes limp from there, and does no work by it; the
// state of that moment goes on alike elsewhere.
TEST(SceneCondition, WhoFaintsGoesLimpByAndBy) {
  Files files;
  const std::string thin = files.file(
      "thin.toml", "tanks = [ { oxygen = 0.03, helium = 0.5 } ]\ngas_switches = false\n");
  const std::string text =
      kStillWater + diver_text(std::string(kProne) +
                                   "position_m = [0, -3, 0]\nswim = { speed_m_s = 0.4, "
                                   "waypoints_m = [[0, -3, -200]] }\n"
                                   "condition = { effects = [\"hypoxia\"] }\n",
                               thin);
  TestDive dive = dive_of(text);
  while (dive.state().conditions()[0].lost == 0 && dive.time_s() < 100.0) dive.run(1.0 / 240.0);
  ASSERT_NE(dive.state().conditions()[0].lost, 0u);
  const auto before = dive.state().humans()[0].human.limbs.rotation;
  double bent_rad = 0.0;
  for (const Quat& q : before)
    bent_rad = std::max(bent_rad, 2.0 * std::acos(std::min(std::abs(q.w), 1.0)));
  ASSERT_GT(bent_rad, 0.2);
  const double work_j = dive.state().humans()[0].human.life.limb_work_j;
  const Vec3 at = dive.state().humans()[0].human.root.velocity.linear();
  double fastest_rad_s = 0.0, fastest_m_s = 0.0;
  const auto see = [&] {
    const diver::HumanState& human = dive.state().humans()[0].human;
    for (const Vec3& rate : human.limbs.rate)
      fastest_rad_s = std::max(fastest_rad_s, glm::length(rate));
    fastest_m_s = std::max(fastest_m_s, glm::length(human.root.velocity.linear()));
  };
  dive.run(0.3);  // what the kick was about
  const auto bytes = encode_state(dive.world->state_format(),
                                  saved_state(*dive.simulation, dive.world->state_format()));
  dive.run(3.0, see);
  EXPECT_LT(fastest_rad_s, radians(90.0));
  EXPECT_LT(fastest_m_s, glm::length(at) + 0.1);
  EXPECT_LT(dive.state().humans()[0].human.life.limb_work_j - work_j, 15.0);
  for (const Quat& q : dive.state().humans()[0].human.limbs.rotation)
    EXPECT_GT(std::abs(q.w), std::cos(radians(2.0)));
  const auto saved = parse_state(dive.world->state_format(), bytes, "fainting");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  TestDive other = dive_of(text);
  restore_state(*other.simulation, *saved);
  other.run(3.0);
  EXPECT_EQ(dive.simulation->newest().hash, other.simulation->newest().hash);
}

TEST(SceneCondition, IsSavedSampledAndTheSameOnAnyNumberOfThreads) {
  const std::string text =
      kStillWater +
      named(diver_text(std::string(kProne) + "position_m = [0, -20, 0]\ncondition = { water_c = 4 "
                                             "}\nregulator = { free_flow = [ { at_s = 1 } ] }\n"),
            "a") +
      named(diver_text(std::string(kProne) + "position_m = [2, -20, 0]\ncondition = {}\n"), "b");
  TestDive dive = dive_of(text);
  const auto threaded = dive.world->simulation({}, 3);
  threaded->advance(240 * 3);
  OutputSamples outputs(*dive.world, {dive.world->streams().find("a/condition").value(),
                                      dive.world->streams().find("a/supply").value()});
  std::size_t told = 0;
  ConditionReading newest;
  dive.run(3.0, [&] {
    for (const Sample& sample : outputs.of(dive.simulation->newest())) {
      ++told;
      if (const auto* reading = std::get_if<ConditionReading>(&sample.payload)) newest = *reading;
    }
  });
  EXPECT_EQ(threaded->newest().hash, dive.simulation->newest().hash);
  EXPECT_GE(told, 6u);
  EXPECT_LT(newest.skin_c, 34.0);
  EXPECT_GT(newest.shiver_w, 20.0);
  EXPECT_EQ(newest.lost, 0u);
  // Saved, restored elsewhere, and on.
  const auto bytes = encode_state(dive.world->state_format(),
                                  saved_state(*dive.simulation, dive.world->state_format()));
  const auto saved = parse_state(dive.world->state_format(), bytes, "a");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  TestDive other = dive_of(text);
  restore_state(*other.simulation, *saved);
  dive.run(2.0), other.run(2.0);
  EXPECT_EQ(dive.simulation->newest().hash, other.simulation->newest().hash);
}

TEST(SceneCondition, TolerancesOfOxygenAreNormalAndOfTheSeed) {
  double sum = 0.0, squares = 0.0;
  constexpr int kMany = 4000;
  for (int i = 0; i < kMany; ++i) {
    const double z = drawn_tolerance(7, static_cast<std::size_t>(i));
    sum += z, squares += z * z;
  }
  EXPECT_NEAR(sum / kMany, 0.0, 0.05);
  EXPECT_NEAR(squares / kMany, 1.0, 0.07);
  EXPECT_EQ(drawn_tolerance(7, 3), drawn_tolerance(7, 3));
  EXPECT_NE(drawn_tolerance(7, 3), drawn_tolerance(8, 3));
}

// Two who hover beside each other; the one runs out.
struct Buddies {
  Files files;
  TestDive dive;
  explicit Buddies(double apart_m,
                   const std::string& regulator =
                       "regulator = { donor = \"buddy\", hose_m = 1.2, reaction_s = 3 }\n")
      : dive(
            dive_of(kStillWater +
                    named(diver_text(std::string(kProne) + "position_m = [0, -12, 0]\n" + regulator,
                                     files.file("low.toml",
                                                "tanks = [ { volume_l = 1, pressure_bar = 9, "
                                                "oxygen = 0.32 } ]\ngas_switches = false\n")),
                          "low") +
                    named(diver_text(std::string(kProne) + "position_m = [" +
                                     std::to_string(apart_m) + ", -12, 0]\n"),
                          "buddy"))) {}
  const HumanPhysics& low() const { return dive.state().humans()[0]; }
  const HumanPhysics& buddy() const { return dive.state().humans()[1]; }
};

TEST(SceneRegulator, OneOutOfGasBreathesTheDonorsTankAndTheCountsAgree) {
  Buddies two(0.9);
  const double before = all_moles(two.low()) + all_moles(two.buddy());
  const double buddy_before = all_moles(two.buddy());
  double shared_s = 0.0, longest_unfed_s = 0.0;
  two.dive.run(20.0, [&] {
    if (shared_s == 0.0 && two.dive.state().regulators()[0].donor == 2)
      shared_s = two.dive.time_s();
    longest_unfed_s = std::max(longest_unfed_s, two.low().human.life.lungs.unfed_s);
  });
  const RegulatorState& regulator = two.dive.state().regulators()[0];
  EXPECT_GE(shared_s, 3.0);
  EXPECT_EQ(regulator.donor, 2u);
  EXPECT_GT(regulator.taken_moles, 0.1);
  EXPECT_EQ(two.low().human.life.lungs.unfed_s, 0.0);  // fed again
  EXPECT_LT(longest_unfed_s, 20.0);
  const double breathed =
      two.low().human.life.lungs.breathed_moles + two.buddy().human.life.lungs.breathed_moles;
  // The jackets may take of each's first tank as well.
  const double jackets = two.low().human.life.jacket_moles + two.buddy().human.life.jacket_moles;
  EXPECT_NEAR(before - all_moles(two.low()) - all_moles(two.buddy()), breathed, jackets + 1e-6);
  EXPECT_NEAR(buddy_before - all_moles(two.buddy()) - two.buddy().human.life.lungs.breathed_moles,
              regulator.taken_moles, jackets + 1e-6);
  const SupplyReading told = supply_reading(two.dive.world->humans(), 0, two.dive.state());
  EXPECT_EQ(told.donor, 2u);
  EXPECT_EQ(told.fed, 1u);
  EXPECT_NEAR(
      told.breathed_pa,
      diver::tank_pressure(two.dive.world->humans()[1].body, two.buddy().human.life.tanks, 0), 1.0);
  // His own gas has 0.32 of oxygen, the donor's 0.21.
  EXPECT_NEAR(two.low().human.life.vitals.risk.oxygen_bar,
              0.21e-5 * diver::pressure_at(two.dive.world->humans()[0].body,
                                           two.low().human.root.position_ned_m.z),
              0.01);
}

TEST(SceneRegulator, OneRegulatorFeedsOneDiver) {
  const auto lows = [](const char* name, double x_m) {
    return named(diver_text(std::string(kProne) + "position_m = [" + std::to_string(x_m) +
                            ", -12, 0]\nregulator = { donor = \"buddy\", hose_m = 3, "
                            "reaction_s = 0 }\n"),
                 name);
  };
  TestDive dive =
      dive_of(kStillWater + lows("left", -0.9) + lows("right", 0.9) +
              named(diver_text(std::string(kProne) + "position_m = [0, -12, 0.5]\n"), "buddy"));
  const auto ask = [&](const char* stream, SupplyChoice choice) {
    EXPECT_TRUE(send(*dive.simulation, dive.world->streams().find(stream).value(),
                     RegulatorUse{choice, FlowChoice::kHolds}));
  };
  const auto donors = [&] {
    return std::pair(dive.state().regulators()[0].donor, dive.state().regulators()[1].donor);
  };
  // Both in one step: the first has it.
  ask("left/regulator", SupplyChoice::kDonor);
  ask("right/regulator", SupplyChoice::kDonor);
  dive.run(5.0);
  EXPECT_EQ(donors(), std::pair(std::uint64_t{3}, std::uint64_t{0}));
  const double taken = dive.state().regulators()[1].taken_moles;
  dive.run(5.0);
  EXPECT_EQ(dive.state().regulators()[1].taken_moles, taken);
  // Let go, it goes to the other, who keeps it.
  ask("left/regulator", SupplyChoice::kOwn);
  dive.run(1.0);
  ask("left/regulator", SupplyChoice::kDonor);
  dive.run(5.0);
  EXPECT_EQ(donors(), std::pair(std::uint64_t{0}, std::uint64_t{3}));
}

TEST(SceneRegulator, BeyondTheHoseNothingIsShared) {
  Buddies two(4.0);
  two.dive.run(30.0);
  EXPECT_EQ(two.dive.state().regulators()[0].donor, 0u);
  EXPECT_EQ(two.dive.state().regulators()[0].taken_moles, 0.0);
  EXPECT_GT(two.low().human.life.lungs.unfed_s, 5.0);
}

TEST(SceneRegulator, ClientsGiveAndTakeIt) {
  Buddies two(0.9);
  const StreamId stream = two.dive.world->streams().find("low/regulator").value();
  EXPECT_TRUE(
      send(*two.dive.simulation, stream, RegulatorUse{SupplyChoice::kDonor, FlowChoice::kFlows}));
  two.dive.run(2.0);
  EXPECT_EQ(two.dive.state().regulators()[0].donor, 2u);
  EXPECT_GT(two.dive.state().regulators()[0].blown_moles, 0.0);
  EXPECT_TRUE(
      send(*two.dive.simulation, stream, RegulatorUse{SupplyChoice::kOwn, FlowChoice::kHolds}));
  two.dive.run(0.1);
  EXPECT_EQ(two.dive.state().regulators()[0].donor, 0u);
  EXPECT_EQ(two.dive.state().regulators()[0].flow_moles_s, 0.0);
}

TEST(SceneRegulator, AFreeFlowLosesWhatItsOpeningLetsThrough) {
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string(kProne) +
                                       "position_m = [0, -10, 0]\nregulator = { free_flow = [ { "
                                       "at_s = 1, until_s = 21, area_mm2 = 8 } ] }\n"));
  dive.run(11.0);
  const HumanPhysics& human = dive.state().humans()[0];
  const double ambient_pa =
      diver::pressure_at(dive.world->humans()[0].body, human.human.root.position_ned_m.z);
  // Choked behind a first stage at 9.5 bar over ambient: A p sqrt(gamma / (M R T)) (2 / (gamma +
  // 1))^3.
  const double moles_s = 8e-6 * (ambient_pa + 9.5e5) *
                         std::sqrt(1.4 / (diver::molar_mass(diver::kAir) * 8.314462618 * 293.15)) *
                         std::pow(2.0 / 2.4, 3.0);
  EXPECT_NEAR(dive.state().regulators()[0].flow_moles_s, moles_s, 0.002 * moles_s);
  EXPECT_NEAR(dive.state().regulators()[0].blown_moles, 10.0 * moles_s, 0.02 * 10.0 * moles_s);
  const double before = all_moles(human);
  dive.run(20.0);
  EXPECT_EQ(dive.state().regulators()[0].flow_moles_s, 0.0);
  EXPECT_NEAR(dive.state().regulators()[0].blown_moles, 20.0 * moles_s, 0.02 * 20.0 * moles_s);
  EXPECT_LT(all_moles(dive.state().humans()[0]), before - 9.5 * moles_s);
}

TEST(SceneRegulator, AnEmptyTankStopsBlowingAtAmbientPressure) {
  Files files;
  const std::string small =
      files.file("s.toml", "tanks = [ { volume_l = 1, pressure_bar = 50 } ]\n");
  TestDive dive = dive_of(
      kStillWater +
      diver_text(
          std::string(kProne) +
              "position_m = [0, -10, 0]\nregulator = { free_flow = [ { area_mm2 = 100 } ] }\n",
          small));
  dive.run(10.0);
  const HumanPhysics& human = dive.state().humans()[0];
  const diver::Body& body = dive.world->humans()[0].body;
  EXPECT_NEAR(diver::tank_pressure(body, human.human.life.tanks, 0),
              diver::pressure_at(body, human.human.root.position_ned_m.z), 2e4);
  EXPECT_GT(human.human.life.lungs.unfed_s, 0.0);
}

void expect_refused(const std::string& text, const std::string& words) {
  const auto scene = load_text(text);
  std::string message = scene.ok() ? "" : scene.error().message;
  if (scene.ok()) {
    const auto world = PhysicsWorld::create(*scene);
    ASSERT_FALSE(world.ok());
    message = world.error().message;
  }
  EXPECT_NE(message.find(words), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(SceneRegulator, FaultsOfTheScenePointToTheirKey) {
  const auto one = [](const std::string& keys) {
    return kStillWater + diver_text(std::string(kProne) + "position_m = [0, -10, 0]\n" + keys);
  };
  expect_refused(one("regulator = { donor = \"ghost\" }\n"),
                 "regulator.donor: found 'ghost'; accepted: another diver");
  expect_refused(one("regulator = { free_flow = [ { tank = 2 } ] }\n"),
                 "regulator.free_flow[0].tank: found 2; accepted: below 1");
  expect_refused(one("regulator = { free_flow = [ { at_s = 9, until_s = 3 } ] }\n"), "until_s");
  expect_refused(one("regulator = { hose_m = 2 }\n"), "no such key without donor");
  expect_refused(one("condition = { effects = [\"thirst\"] }\n"), "condition.effects");
  expect_refused(one("condition = { water_c = 90 }\n"), "condition.water_c");
  expect_refused(std::string(kStillWater) + rov_text("condition = {}\n"), "condition");
}

}  // namespace
}  // namespace neritic::testbed
