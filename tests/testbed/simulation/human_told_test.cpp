// The report of a diver's dive: rows of gas and tissues, what endangered the diver, the way up.
#include "testbed/record/dive_record.hpp"
#include "tests/testbed/csv_text.hpp"
#include "tests/testbed/simulation/devices.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

TEST(HumanDive, RowsSayGasAndTissues) {
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -18, 0]\n") + kProne) +
              rov_text("position_m = [3, -18, 0]\n"));
  DiveRecorder recorder(*dive.world, {.rows = true});
  recorder.add(dive.simulation->newest());
  dive.run(3.0, [&] { recorder.add(dive.simulation->newest()); });
  const auto& rows = recorder.rows().humans;
  ASSERT_NEAR(static_cast<double>(rows.size()), 31.0, 1.0);
  for (const HumanRow& row : rows) {
    EXPECT_NEAR(row.gas.ambient_pa, 101325.0 + 1028.0 * 9.80665 * 18.0, 3e3);
    EXPECT_GT(row.ascent.view.no_stop_min, 20.0);
    EXPECT_LT(row.ascent.view.no_stop_min, 120.0);
    // The computer sampled up to a second ago.
    EXPECT_NEAR(row.ascent.view.po2_bar, 0.21e-5 * row.gas.ambient_pa, 3e-3);
    EXPECT_NEAR(row.vitals.heart_bpm, 65.0, 5.0);
    EXPECT_NEAR(row.vitals.risk.narcotic_depth_m, 18.0, 1.0);
  }
  const std::string csv = csv_of(*dive.world, recorder.rows());
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_EQ(lines, static_cast<std::ptrdiff_t>(1 + rows.size() + recorder.rows().vehicles.size()));
  const auto commas =
      std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n')), ',');
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), commas * lines);
  for (const char* column :
       {",no_stop_min,", ",heart_bpm,", ",co2_proxy_mmhg,", ",tank_bar,", ",oxygen_risk,",
        ",out_of_gas_s,", ",ascent_gas_l,", ",ascent_gas_there_l,", ",tanks_too_small"})
    EXPECT_NE(csv.find(column), csv.npos) << column;
}

// A tank of a litre at 40 m, then a jacket that carries the diver up: what endangered the diver is
// told of the whole dive, not of its end.
TEST(HumanDive, FiguresSayWhatEndangeredTheDiver) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "small.toml").string();
  ASSERT_TRUE(
      write_text(file, "tanks = [ { volume_l = 1, pressure_bar = 60, oxygen = 0.5 } ]\n").ok());
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -40, 0]\n") + kProne, file));
  DiveRecorder recorder(*dive.world, {});
  recorder.add(dive.simulation->newest());
  double unfed_s = 0.0, first_s = 0.0, dark_s = 0.0;
  diver::TissueState unfed;
  dive.run(90.0, [&] {
    recorder.add(dive.simulation->newest());
    const diver::LifeState& life = dive.state().humans()[0].human.life;
    const double now_s = life.lungs.unfed_s;
    if (now_s > 0.0 && first_s == 0.0) first_s = dive.time_s();
    if (now_s > 0.0) dark_s += dive.world->step_s();
    if (now_s > 1.1 && unfed_s <= 1.1) unfed = life.computer.tissues;
    unfed_s = std::max(unfed_s, now_s);
    // Gas that is not breathed loads no tissue.
    if (now_s > 1.1) {
      ASSERT_TRUE(sim::same_bits(life.computer.tissues, unfed)) << now_s;
    }
  });
  const HumanFigures& f = recorder.humans().figures()[0];
  ASSERT_GT(unfed_s, 5.0);
  EXPECT_NEAR(f.out_of_gas_longest_s, unfed_s, 1.01);
  EXPECT_NEAR(f.out_of_gas_s, dark_s, 2.0);
  EXPECT_GE(f.out_of_gas_from_s, first_s - 0.1);
  EXPECT_EQ(f.out_of_gas_tank, 0u);
  EXPECT_EQ(f.oxygen, diver::RiskLevel::kSevere);  // 0.5 of 5 bar
  EXPECT_NEAR(f.most_po2_bar, 0.5 * 1e-5 * (101325.0 + 1028.0 * 9.80665 * f.deepest_m), 0.05);
  EXPECT_EQ(f.above_ceiling_m, 0.0);
}

// An hour at 30 m, then an inflator that freezes open: up at many times the rate allowed, through
// the ceiling, and nothing stops it. The report gives depth and ceiling second by second.
TEST(HumanDive, AnInflatorThatFreezesOpenIsAnUncontrolledAscentAndIsTold) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "frozen.csv").string();
  ASSERT_TRUE(write_text(file, "t_s,inflate\n8,1\n").ok());
  const TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -30, 0]\n") + kProne +
                                       "jacket_buttons = \"" + file + "\"\n"));
  const PhysicsHuman& human = dive.world->humans()[0];
  sim::Snapshot<PhysicsState> now = dive.simulation->newest();
  auto& computer = now.state.humans()[0].human.life.computer;
  for (int i = 0; i < 60; ++i) computer = human.computer->step(computer, {30.0, 0}, 60.0);
  DiveRecorder recorder(*dive.world, {});
  recorder.add(now);
  std::vector<double> depths_m;
  double above_m = 0.0, above_s = 0.0;
  const double dt_s = dive.world->step_s();
  for (int i = 1; i <= 75 * 240; ++i) {
    now.state = dive.world->step(now.state, dive.world->start_inputs(), {now.step, dt_s});
    now.step = static_cast<std::uint64_t>(i);
    now.time_s = i * dt_s;
    recorder.add(now);
    const HumanPhysics& state = now.state.humans()[0];
    const double depth_m = state.human.root.position_ned_m.z;
    EXPECT_EQ((state.human.held.buttons & diver::kInflate) != 0, i > 8 * 240) << now.time_s;
    if (i % 240 != 0) continue;
    depths_m.push_back(depth_m);
    const double over_m = human.computer->view(computer).ceiling_m - std::max(depth_m, 0.0);
    if (over_m > diver::kCeilingSlack_m && above_s == 0.0) above_s = now.time_s;
    above_m = std::max(above_m, over_m);
  }
  double fastest_m_min = 0.0;  // of ten seconds, the least that it can be
  for (std::size_t i = 10; i < depths_m.size(); ++i)
    fastest_m_min = std::max(fastest_m_min, 6.0 * (depths_m[i - 10] - depths_m[i]));
  const HumanFigures& f = recorder.humans().figures()[0];
  EXPECT_NEAR(depths_m[6], 30.0, 1.0);
  EXPECT_LT(depths_m.back(), 1.0);
  ASSERT_GT(fastest_m_min, 36.0);
  EXPECT_EQ(f.ascent_alarm, diver::AscentAlarm::kDangerous);
  EXPECT_GE(f.fastest_ascent_m_min, 0.98 * fastest_m_min);
  EXPECT_LT(f.fastest_ascent_m_min, 1.3 * fastest_m_min);
  EXPECT_GT(f.ascent_alarm_s, 10.0);
  ASSERT_GT(above_m, 3.0);
  EXPECT_NEAR(f.above_ceiling_m, above_m, 0.01);
  EXPECT_NEAR(f.above_ceiling_from_s, above_s, 1.01);
}

// Oxygen is carried for the stops: while its bottle is full it shortens the way up, and not when it
// is empty. Over a lake in the mountains the air is thinner, for the body and for its computer.
TEST(HumanDive, OnlyGasThatIsThereShortensTheWayUp) {
  const test::ScratchFolder folder;
  const auto row_of = [&](double oxygen_bar, const char* physics) {
    const std::string file = (folder / "deep.toml").string();
    EXPECT_TRUE(write_text(file, fmt::format("tanks = [ {{ volume_l = 24 }}, {{ oxygen = 1.0, "
                                             "volume_l = 7, pressure_bar = {} }} ]\n",
                                             oxygen_bar))
                    .ok());
    TestDive dive =
        dive_of(physics + ("[[objects]]\nname = \"diver\"\nclass = \"diver\"\nmodel = \"" +
                           (test::source_dir() / "assets/models/diver.glb").string() +
                           "\"\nhuman = \"" + file + "\"\nposition_m = [0, -45, 0]\n" + kProne));
    // As after half an hour at 45 m.
    const PhysicsHuman& human = dive.world->humans()[0];
    sim::Snapshot<PhysicsState> snapshot = dive.simulation->newest();
    auto& computer = snapshot.state.humans()[0].human.life.computer;
    for (int i = 0; i < 30; ++i) computer = human.computer->step(computer, {45.0, 0}, 60.0);
    DiveRecorder recorder(*dive.world, {.rows = true});
    recorder.add(snapshot);
    return recorder.rows().humans.front();
  };
  const HumanRow full = row_of(200.0, kStillWater), empty = row_of(3.0, kStillWater),
                 high = row_of(200.0, "title = \"a lake\"\n[physics]\naltitude_m = 2000\n");
  EXPECT_GT(full.ascent.view.stop_min, 0.0);
  EXPECT_GT(empty.ascent.view.to_surface_min, full.ascent.view.to_surface_min + 5.0);
  EXPECT_GT(high.ascent.view.to_surface_min, full.ascent.view.to_surface_min);
  EXPECT_NEAR(full.gas.ambient_pa - high.gas.ambient_pa, 101325.0 - 79495.0, 50.0);
  EXPECT_EQ(full.out_of_gas_s, 0.0);
  // A bottle that gives a full breath but not all its stops is not counted on either; and who has
  // too little to come up with is told how much is missing.
  const HumanRow little = row_of(30.0, kStillWater);
  EXPECT_EQ(full.ascent.too_small, 0u);
  EXPECT_EQ(little.ascent.too_small, 2u);
  EXPECT_EQ(little.ascent.view.to_surface_min, empty.ascent.view.to_surface_min);
  EXPECT_TRUE(full.ascent.enough());
  EXPECT_GT(little.ascent.needed_l, full.ascent.needed_l + 5.0 * 17.0);
  const double there_l = 24.0 * (200.0 / diver::compressibility(diver::kAir, 200e5) -
                                 6.01325 / diver::compressibility(diver::kAir, 6.01325e5));
  EXPECT_NEAR(full.ascent.there_l, there_l, 1.0);
}

TEST(HumanTold, AnEventAsksForARecordingThatTheSceneLacksAndIsRefused) {
  const TestDive dive = dive_of(hover_text("body = \"suit\""));
  Device operator_(dive, "operator", "diver/event");
  operator_.say(hand_over(static_cast<std::size_t>(DiverGroup::kBody), Authority::kRecording, 0));
  dive.simulation->advance(1);
  EXPECT_EQ(dive.simulation->inputs().humans()[0].refused_events, 1u);
  EXPECT_EQ(group(dive, DiverGroup::kBody).authority, Authority::kLive);
}

}  // namespace
}  // namespace neritic::testbed
