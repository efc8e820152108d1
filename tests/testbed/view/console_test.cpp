// The operator's console: numbers kept for graphs, the map's trails, gauges of a vehicle, words of
// what was clicked, and what a window remembers.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "testbed/instruments/instrument_data.hpp"
#include "testbed/view/dive_panels.hpp"
#include "testbed/view/gauge_panel.hpp"
#include "testbed/view/graph_panel.hpp"
#include "testbed/view/map_panel.hpp"
#include "testbed/view/panel_frame.hpp"
#include "testbed/view/picker.hpp"
#include "testbed/view/run_numbers.hpp"
#include "testbed/view/view_memory.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

const RunNumber& number(const RunNumbers& numbers, const std::string& name) {
  for (const RunNumber& one : numbers.all())
    if (one.name == name) return one;
  ADD_FAILURE() << name;
  return numbers.all().front();
}

TEST(RunNumbers, KeepTheStatesNumbersFourTimesASecondAndForgetWhereTheRunWentBack) {
  TestDive dive = dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\n") +
                          diver_text(std::string("position_m = [4, -12, 0]\n") + kProne));
  RunNumbers numbers;
  std::vector<double> depths;
  for (int i = 0; i < 480; ++i) {
    numbers.look(*dive.world, dive.simulation->newest(), 20.0, 0.5);
    if (i % 60 == 0) depths.push_back(dive.state().vehicles()[0].body.position_ned_m.z);
    dive.run(1.0 / 240.0);
  }
  const RunNumber& depth = number(numbers, "rov depth");
  ASSERT_EQ(numbers.count(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(numbers.at(depth, i), depths[i], 1e-5) << i;
  EXPECT_TRUE(depth.down);
  EXPECT_NEAR(number(numbers, "diver tank").newest, 200.0, 3.0);
  EXPECT_EQ(number(numbers, "view's resolution").newest, 50.0);
  TestDive again = dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\n") +
                           diver_text(std::string("position_m = [4, -12, 0]\n") + kProne));
  numbers.look(*again.world, again.simulation->newest(), 20.0, 0.5);
  EXPECT_EQ(numbers.count(), 1u);
}

// Few pictures a second of fast time: each value keeps its own time, and two minutes are shown.
TEST(RunNumbers, AreAsOldAsTheScenesTimeSaysHoweverSeldomTheyCome) {
  TestDive dive = dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\n"));
  RunNumbers numbers;
  for (int i = 0; i < 60; ++i) {
    numbers.look(*dive.world, dive.simulation->newest(), 20.0, 1.0);
    dive.run(2.5);
  }
  ASSERT_EQ(numbers.count(), 49u);
  EXPECT_NEAR(numbers.age_s(48), 0.0, 1e-9);
  EXPECT_NEAR(numbers.age_s(47), 2.5, 0.01);
  EXPECT_NEAR(numbers.age_s(0), 120.0, 0.01);
}

TEST(Readout, SaysWhoseDepthAndHeadingItIsInTheUnitsOfTheDive) {
  EXPECT_EQ(readout_words({"diver", 40.34, radians(91.2), 1}, hud::Units::kMetric),
            "diver  depth 40.3 m  heading 091\u00b0");
  EXPECT_EQ(readout_words({"camera", -1.5, 0.0, 2}, hud::Units::kImperial),
            "camera  4.9 ft above water  heading 000\u00b0");
}

// On one screen a diver has one depth and one heading: the instruments', the readout's, the
// graphs'.
TEST(Readout, OfADiverHasTheDepthAndTheHeadingOfTheInstruments) {
  TestDive dive =
      dive_of("[physics]\n" + diver_text(std::string("position_m = [4, -52, 0]\n") + kProne));
  dive.run(3.0);
  const auto& snapshot = dive.simulation->newest();
  const hud::DiveData data = instrument_data(*dive.world, 0, snapshot);
  const DiverGauge gauge = gauge_of(dive.world->humans()[0], snapshot.state.humans()[0]);
  const double true_m = snapshot.state.humans()[0].human.root.position_ned_m.z;
  RunNumbers numbers;
  numbers.look(*dive.world, snapshot, 20.0, 1.0);
  EXPECT_EQ(number(numbers, "diver depth").newest, gauge.depth_m);
  for (const hud::Units units : {hud::Units::kMetric, hud::Units::kImperial}) {
    const hud::Shown shown =
        hud::shown_of(hud::LayoutKind::kMask, units, data, {}, {}, {}, data.time_s);
    EXPECT_EQ(readout_words({"diver", gauge.depth_m, gauge.heading_rad, 1}, units),
              fmt::format("diver  depth {} {}  heading {}\u00b0", shown.depth.view(),
                          hud::unit_names(units).depth, shown.heading.view()));
    // Otherwise the test could not fail.
    EXPECT_NE(length_text(true_m, 1, units).substr(0, shown.depth.view().size()),
              shown.depth.view());
  }
}

TEST(Units, WhatAWindowSaysIsImperialWhereThatIsAskedFor) {
  constexpr auto kFeet = hud::Units::kImperial, kMetres = hud::Units::kMetric;
  EXPECT_EQ(force_text(44.482, kFeet), "10 lbf");
  EXPECT_EQ(force_text(44.482, kMetres), "44 N");
  EXPECT_EQ(flow_text(28.3168, kFeet), "1.00 cu ft/min");
  EXPECT_EQ(flow_text(28.3168, kMetres), "28 l/min");
  const sonar::Limits limits{.range_min_m = 0.3048, .range_max_m = 9.144};
  EXPECT_EQ(range_words(limits, kFeet), "1 to 30 ft");
  EXPECT_EQ(range_words(limits, kMetres), "0.305 to 9.14 m");
  EXPECT_EQ(grid_words(7.62, kFeet), "grid 25 ft");
  EXPECT_EQ(grid_words(5.0, kMetres), "grid 5 m");
  EXPECT_EQ(picked_words("rov, vehicle", 3.048, kFeet), "rov, vehicle, 10.0 ft");
  EXPECT_EQ(picked_words("rov, vehicle", 3.048, kMetres), "rov, vehicle, 3.05 m");
  VehicleGauges gauges;
  gauges.tether_n = 44.482, gauges.tether_used = 0.5;
  EXPECT_EQ(tether_words(gauges, kFeet), "tether 10 lbf, 50 % of its length out");
  EXPECT_EQ(tether_words(gauges, kMetres), "tether 44 N, 50 % of its length out");
}

// Each number of a run has a unit, and none that has an imperial one is shown in metres, bar,
// litres or newton there.
TEST(Units, OfEveryNumberInAGraphAreThoseThatAreAskedFor) {
  TestDive dive = dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\n") +
                          diver_text(std::string("position_m = [4, -12, 0]\n") + kProne));
  RunNumbers numbers;
  numbers.look(*dive.world, dive.simulation->newest(), 20.0, 0.5);
  const std::set<std::string> both{"min", "/min", "deg", "%", "ms"};
  for (const RunNumber& one : numbers.all()) {
    const bool oxygen = one.name.ends_with(" pO2");  // the HUD's too is in bar
    EXPECT_TRUE(one.unit.metric != std::string(one.unit.imperial) ||
                both.contains(one.unit.metric) || oxygen)
        << one.name;
  }
  const RunNumber& depth = number(numbers, "diver depth");
  EXPECT_EQ(caption(depth, depth.newest, depth.newest, hud::Units::kImperial),
            fmt::format("diver depth   {:.4g} ft   ({:.3g} to {:.3g})", depth.newest / 0.3048,
                        depth.newest / 0.3048, depth.newest / 0.3048));
  const RunNumber& tank = number(numbers, "diver tank");
  EXPECT_EQ(caption(tank, tank.newest, tank.newest, hud::Units::kMetric),
            fmt::format("diver tank   {:.4g} bar   ({:.3g} to {:.3g})", tank.newest, tank.newest,
                        tank.newest));
}

TEST(MapTrails, AreBoundedAndTheMapHoldsThemAll) {
  MapTrails trails;
  std::vector<MapMark> marks{{"rov", {0, -5, 0}}, {"lost", {NAN, 0, 1e300}}};
  for (int i = 0; i < 20000; ++i) {
    marks[0].position_m = {0.1 * i, -5, -0.05 * i};
    trails.add(marks, 0.1 * i);
  }
  EXPECT_LE(trails.of("rov").size(), MapTrails::kMostPoints);
  EXPECT_GT(trails.of("rov").size(), MapTrails::kMostPoints / 3);
  EXPECT_EQ(trails.of("rov").front(), Vec2(0.0));
  EXPECT_NEAR(trails.of("rov").back().x, 2000.0, 20.0);
  EXPECT_TRUE(trails.of("lost").empty());
  const MapFrame frame = map_frame(marks, trails);
  EXPECT_NEAR(frame.middle.x, 1000.0, 1.0);
  EXPECT_NEAR(frame.middle.y, 500.0, 1.0);
  EXPECT_GT(frame.side_m, 2000.0);
  trails.add(marks, 1.0);  // the run went back
  EXPECT_EQ(trails.of("rov").size(), 1u);
}

TEST(MapLabels, OfNearParticipantsDoNotMeetAndStayOnTheMap) {
  const PanelRect room{0.0f, 0.0f, 300.0f, 200.0f};
  std::vector<PanelRect> labels;
  for (const Vec2 at : {Vec2(150, 100), Vec2(155, 102), Vec2(150, 104), Vec2(290, 100),
                        Vec2(292, 5), Vec2(5, 198)}) {
    const PanelRect label = label_place(at, 8.0f, {70.0, 14.0}, room, labels);
    ASSERT_FALSE(label.empty()) << at.x << ", " << at.y;
    EXPECT_TRUE(label.x >= 0.0f && label.y >= 0.0f && label.right() <= 300.0f &&
                label.bottom() <= 200.0f)
        << at.x << ", " << at.y;
    for (const PanelRect& other : labels) EXPECT_FALSE(overlap(label, other)) << at.x;
    labels.push_back(label);
  }
  EXPECT_EQ(labels[0].x, 158.0f);  // right above where that is free
  EXPECT_TRUE(label_place({150, 100}, 8.0f, {70.0, 14.0}, room, {room}).empty());
}

TEST(VehicleGauges, SayTheSharesOfTheThrustersLimits) {
  TestDive dive =
      dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\nmission = { waypoints "
                                       "= [ { position_m = [0, -10, -20] } ] }\n"));
  dive.run(3.0);
  const VehicleGauges gauges = gauges_of(*dive.world, dive.state(), 0);
  ASSERT_EQ(gauges.thrust.size(), dive.world->vehicles()[0].vehicle.thruster_count);
  double most = 0.0;
  for (const double share : gauges.thrust) {
    EXPECT_LE(std::abs(share), 1.0 + 1e-9);
    most = std::max(most, std::abs(share));
  }
  EXPECT_GT(most, 0.02);
  EXPECT_NEAR(gauges.depth_m, 10.0, 0.3);
  EXPECT_EQ(gauges.tether_used, 0.0);
  EXPECT_FALSE(gauges.battery);
}

TEST(Picked, WordsAreAnObjectsNameAndClass) {
  const scene::Scene scene =
      load_text(
          "[[objects]]\nname = \"anchor\"\nclass = \"wreck\"\nshape = \"box\"\n"
          "position_m = [0, -5, -5]\n[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n"
          "position_m = [2, -5, -5]\n")
          .value();
  const scene::Object& anchor = scene.objects[0];
  EXPECT_EQ(words_of_label(scene, anchor.class_id, anchor.instance), "anchor, wreck");
  EXPECT_NE(
      words_of_label(scene, scene.objects[1].class_id, scene.objects[1].instance).find("ball"),
      std::string::npos);
  EXPECT_EQ(words_of_label(scene, 0, 0), "");
}

TEST(ViewMemory, ComesBackAsItWasAndABrokenFileIsNamedInOneLine) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "state" / "window.json";
  EXPECT_EQ(read_view_memory(file).value(), ViewMemory{});
  const ViewMemory wanted{.width = 900,
                          .height = 700,
                          .panels = false,
                          .map = true,
                          .numbers = {"diver depth", "frame"},
                          .sonar_gain_db = -6.0,
                          .sonar_range_part = 0.5};
  ASSERT_TRUE(write_view_memory(file, wanted).ok());
  EXPECT_EQ(read_view_memory(file).value(), wanted);
  std::ofstream(file) << "{ \"width_px\": 1e300, \"sonar_gain_db\": \"loud\", \"numbers\": [1] }";
  const ViewMemory odd = read_view_memory(file).value();
  EXPECT_EQ(odd.sonar_gain_db, 0.0);
  EXPECT_TRUE(odd.numbers.empty());
  std::ofstream(file) << "{ \"width_px\"";
  const auto broken = read_view_memory(file);
  ASSERT_FALSE(broken.ok());
  EXPECT_NE(broken.error().message.find("window.json"), std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
