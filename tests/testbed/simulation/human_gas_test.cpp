// The tank that a scene's diver breathes from: by the plan of the gases, another if one is empty,
// and what is told of it.
#include "testbed/record/dive_record.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

struct GasDive {
  test::ScratchFolder folder;
  TestDive dive;
  std::unique_ptr<DiveRecorder> recorder;

  GasDive(const std::string& diver, const std::string& keys)
      : dive([&] {
          const std::string file = (folder / "d.toml").string();
          EXPECT_TRUE(write_text(file, diver).ok());
          return dive_of(kStillWater + diver_text(keys + kProne, file));
        }()),
        recorder(std::make_unique<DiveRecorder>(*dive.world, RecordOptions{.rows = true})) {
    recorder->add(dive.simulation->newest());
  }
  const HumanPhysics& human() const { return dive.state().humans()[0]; }
  const HumanFigures& figures() const { return recorder->humans().figures()[0]; }
  void run(double seconds) {
    dive.run(seconds, [&] { recorder->add(dive.simulation->newest()); });
  }
};

constexpr const char* kNitroxFor21m =
    "tanks = [ {}, { oxygen = 0.5, switch_depth_m = 21 } ]\ngas_switches = { reaction_s = 2 }\n";

// From 24 m up to 18 m and down to 26 m again.
TEST(HumanGas, NitroxFromItsDepthOnAndBottomGasBelow) {
  GasDive d(kNitroxFor21m,
            "position_m = [0, -24, 0]\nswim = { speed_m_s = 0.45, waypoints_m = [[0, -18, -24], "
            "[0, -26, -50]] }\n");
  d.run(140.0);
  const auto& changes = d.figures().tank_changes;
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].from, 0u);
  EXPECT_EQ(changes[0].to, 1u);
  EXPECT_LE(changes[0].depth_m, 21.0);
  EXPECT_GT(changes[0].depth_m, 19.5);  // some three seconds later
  EXPECT_NEAR(changes[0].po2_bar, 0.5 * (1.01325 + 0.10081 * changes[0].depth_m), 2e-3);
  EXPECT_EQ(changes[1].to, 0u);
  EXPECT_GT(changes[1].depth_m, 21.0);
  EXPECT_LT(changes[1].depth_m, 22.3);
  EXPECT_LT(changes[1].po2_bar, 0.72);
  EXPECT_EQ(d.human().human.life.computer.last.gas, 0u);
  // Rows, tanks and computer say the same at every time.
  const auto& rows = d.recorder->rows().humans;
  for (const HumanRow& row : rows) {
    const bool nitrox = row.time_s >= changes[0].time_s && row.time_s < changes[1].time_s;
    ASSERT_EQ(row.tank, nitrox ? 1u : 0u) << row.time_s;
    ASSERT_EQ(row.gas.tank_pa, row.tank_pa[row.tank]);
    const double settled_s = std::min(std::abs(row.time_s - changes[0].time_s),
                                      std::abs(row.time_s - changes[1].time_s));
    if (settled_s > 1.5) {
      ASSERT_NEAR(row.ascent.view.po2_bar, (nitrox ? 0.5 : 0.21) * 1e-5 * row.gas.ambient_pa, 0.02);
    }
  }
  EXPECT_LT(rows.back().tank_pa[0], rows.front().tank_pa[0] - 1e5);
  EXPECT_LT(rows.back().tank_pa[1], rows.front().tank_pa[1] - 1e5);
}

// The slowest hands that a file may ask for: the same way, the nitrox taken and left all the same.
TEST(HumanGas, TheLongestReactionStillSwitches) {
  GasDive d(
      "tanks = [ {}, { oxygen = 0.5, switch_depth_m = 21 } ]\n"
      "gas_switches = { reaction_s = 20 }\n",
      "position_m = [0, -24, 0]\nswim = { speed_m_s = 0.45, waypoints_m = [[0, -18, -24], "
      "[0, -18, -44], [0, -26, -70]] }\n");
  d.run(200.0);
  const auto& changes = d.figures().tank_changes;
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].to, 1u);
  EXPECT_LT(changes[0].depth_m, 21.0);
  EXPECT_EQ(changes[1].to, 0u);
  EXPECT_LT(changes[1].depth_m, 24.5);  // late: each kick stirs where he will be
}

TEST(HumanGas, OnAskingNobodySwitches) {
  GasDive d("tanks = [ {}, { oxygen = 0.5 } ]\ngas_switches = false\n",
            "position_m = [0, -24, 0]\nswim = { speed_m_s = 0.45, waypoints_m = [[0, -18, -24]] "
            "}\n");
  d.run(65.0);
  EXPECT_LT(d.human().human.root.position_ned_m.z, 20.0);
  EXPECT_TRUE(d.figures().tank_changes.empty());
  EXPECT_EQ(d.human().human.held.tank, 0u);
}

// A small tank almost empty, a full one beside: nobody goes without gas, at any speed.
TEST(HumanGas, AnEmptyTankBesideAFullOneIsLeft) {
  for (const char* swim : {"", "swim = { speed_m_s = 0.6, waypoints_m = [[0, -15, -90]] }\n"}) {
    GasDive d("tanks = [ { volume_l = 3, pressure_bar = 20 }, { oxygen = 0.32 } ]\n",
              std::string("position_m = [0, -15, 0]\n") + swim);
    d.run(120.0);
    ASSERT_EQ(d.figures().tank_changes.size(), 1u);
    EXPECT_EQ(d.figures().tank_changes[0].to, 1u);
    EXPECT_EQ(d.figures().out_of_gas_s, 0.0);
    EXPECT_LT(d.human().human.root.position_ned_m.z, 18.0);
  }
}

// Nothing else that can be breathed there, for it has too little oxygen: as before, and it is told.
TEST(HumanGas, NothingThatFitsLeavesTheDiverWhereHeIs) {
  GasDive d("tanks = [ { volume_l = 1, pressure_bar = 10 }, { oxygen = 0.1, helium = 0.7 } ]\n",
            "position_m = [0, -4, 0]\n");
  d.run(50.0);  // in a minute he sinks to where it can be breathed
  EXPECT_TRUE(d.figures().tank_changes.empty());
  EXPECT_GT(d.figures().out_of_gas_s, 5.0);
}

// Too much oxygen is better than nothing to breathe, and it is told.
TEST(HumanGas, WhoHasNothingElseBreathesTooMuchOxygen) {
  GasDive d("tanks = [ { volume_l = 1, pressure_bar = 30 }, { oxygen = 1.0 } ]\n",
            "position_m = [0, -25, 0]\n");
  d.run(60.0);
  ASSERT_EQ(d.figures().tank_changes.size(), 1u);
  EXPECT_EQ(d.figures().tank_changes[0].to, 1u);
  EXPECT_EQ(d.figures().out_of_gas_s, 0.0);
  EXPECT_EQ(d.figures().oxygen, diver::RiskLevel::kSevere);
}

// Trimix that nobody can live on at the surface is not what a dive begins with there.
TEST(HumanGas, ADiveBeginsOnAGasThatCanBeBreathed) {
  const char* const file = "tanks = [ { oxygen = 0.1, helium = 0.7 }, { oxygen = 0.4 } ]\n";
  EXPECT_EQ(GasDive(file, "position_m = [0, -1, 0]\n").human().human.held.tank, 1u);
  EXPECT_EQ(GasDive(file, "position_m = [0, -30, 0]\n").human().human.held.tank, 0u);
}

// A person in the suit has hands.
TEST(HumanGas, WhoWearsTheSuitSaysWhatIsBreathed) {
  GasDive d(kNitroxFor21m, "position_m = [0, -15, 0]\n");
  Suit steering;
  steering.worn = 1;
  steering.human.tank = 1;
  ASSERT_TRUE(wear(d.dive, 0, steering));
  d.run(5.0);
  EXPECT_EQ(d.human().human.held.tank, 1u);
}

}  // namespace
}  // namespace neritic::testbed
