// A vehicle's tether in a scene: its pull, its snags, its winch, its top on a ship; as state,
// stream and drawing.
#include "testbed/simulation/tethers.hpp"

#include "testbed/simulation/output_samples.hpp"
#include "testbed/simulation/saved_state.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

using testing::HasSubstr;

constexpr const char* kStation = "navigation = \"truth\"\nmission = { hold = \"station\" }\n";

std::string at_text(const std::string& at) {
  return "position_m = " + at + "\n";
}

// A heavy line from 2 m below the surface to a vehicle that holds its place.
std::string hanging(const std::string& keys = "") {
  return kStillWater + rov_text(at_text("[0, -4, -20]") + kStation +
                                "tether = { from_m = [0, -2, 0], length_m = 24, net_weight_n_m = "
                                "0.5, segments = 24" +
                                keys + " }\n");
}

const TetherState& tether(const TestDive& dive, std::size_t i = 0) {
  return dive.state().tethers()[i];
}

TEST(SceneTether, WhatNamesNoneHasNone) {
  TestDive dive = dive_of(kStillWater + rov_text(at_text("[0, -4, -20]") + kStation));
  EXPECT_TRUE(dive.state().tethers().empty());
  EXPECT_TRUE(dive.state().tether_nodes().empty());
  EXPECT_FALSE(dive.world->streams().find("rov/tether"));
  EXPECT_EQ(dive.scene.objects.size(), 1u);
}

TEST(SceneTether, ItHangsAsACatenaryAndTheVehicleHoldsAgainstItsPull) {
  TestDive dive = dive_of(hanging());
  dive.run(40.0);
  // 20 m across, 2 m down, 24 m long: by bisection of 2 a sinh(10 / a) = sqrt(24^2 - 2^2).
  double low = 1.0, high = 1e3;
  for (int i = 0; i < 100; ++i) {
    const double a = std::sqrt(low * high);
    (2.0 * a * std::sinh(10.0 / a) > std::sqrt(572.0) ? low : high) = a;
  }
  const double across_n = 0.5 * low;
  const TetherReading told = tether_reading(tether(dive));
  EXPECT_NEAR(told.pull_n.z, across_n, 0.06 * across_n);  // towards its top, which is south
  EXPECT_NEAR(told.pull_n.x, 0.0, 0.05);
  // The line that hangs at the vehicle, from the lowest point on, pulls it down.
  const double lowest_m = 10.0 + low * std::atanh(2.0 / 24.0);
  EXPECT_NEAR(told.pull_n.y, -0.5 * low * std::sinh((20.0 - lowest_m) / low), 0.4);
  EXPECT_NEAR(told.tension_n, glm::length(told.pull_n), 0.06 * told.tension_n);
  EXPECT_LT(glm::distance(dive.pose().position_m, Vec3(0, -4, -20)), 0.25);
  EXPECT_EQ(told.length_m, 24.0);
  EXPECT_EQ(told.touching, 0u);
  EXPECT_EQ(tether(dive).unconverged, 0u);
}

// Such a line would throw the vehicle at its top.
TEST(SceneTether, OneThatDoesNotReachItsVehicleIsRefused) {
  const auto told = [](const std::string& keys) {
    const test::ScratchFolder scratch;
    EXPECT_TRUE(
        write_text(scratch / "s.toml", kStillWater + rov_text(at_text("[0, -4, -20]") + kStation +
                                                              "tether = { " + keys + " }\n"))
            .ok());
    const auto scene = scene::load_scene(scratch / "s.toml");
    if (!scene.ok()) return scene.error().message;
    const auto world = PhysicsWorld::create(*scene);
    return world.ok() ? std::string() : world.error().message;
  };
  EXPECT_EQ(told("from_m = [0, -4, 0], length_m = 20"), "");
  EXPECT_THAT(told("from_m = [0, -4, 0], length_m = 19"),
              HasSubstr("rov: tether.length_m: found 19; accepted: 20 metres or more"));
  EXPECT_THAT(told("from_m = [0, 0, 0], from = \"rov\", length_m = 20"),
              HasSubstr("tether.from: found \"rov\"; accepted: another object than the vehicle"));
}

TEST(SceneTether, AtItsEndItHoldsTheVehicleBack) {
  TestDive dive = dive_of(
      kStillWater +
      rov_text(
          at_text("[0, -6, -8]") +
          "navigation = \"truth\"\nmission = { speed_m_s = 1.0, waypoints = [{ position_m = [0, "
          "-6, -40] }] }\ntether = { from_m = [0, -6, 0], length_m = 15 }\n"));
  double farthest_m = 0.0;
  dive.run(30.0, [&] { farthest_m = std::max(farthest_m, -dive.pose().position_m.z); });
  EXPECT_NEAR(farthest_m, 15.0, 0.3);
  EXPECT_GT(tether(dive).end_n, 5.0);
  EXPECT_EQ(dive.vehicle().mission.arrived, 0u);
}

// A post, and a vehicle that goes round it: the line hangs on its corners.
TestDive round_a_post() {
  return dive_of(
      std::string(kStillWater) +
      "[[objects]]\nname = \"post\"\nclass = \"structure\"\nshape = \"box\"\nsize_m = [2, 14, "
      "2]\nposition_m = [0, -8, -6]\n" +
      rov_text(
          at_text("[-4, -8, 0]") +
          "navigation = \"truth\"\nmission = { speed_m_s = 0.8, acceptance_m = 0.5, waypoints = [{ "
          "position_m = [-4, -8, -11] }, { position_m = [5, -8, -11] }, { position_m = [15, -8, "
          "1] }] }\ntether = { from_m = [0, -6, 4], length_m = 24, segments = 24 }\n"));
}

TEST(SceneTether, ItSnagsOnAPostAndTheVehicleDoesNotGetThere) {
  TestDive dive = round_a_post();
  dive.run(75.0);
  // Straight, 24 m would do for 15.6; round the post they do not.
  EXPECT_EQ(dive.vehicle().mission.arrived, 2u);
  const TetherReading told = tether_reading(tether(dive));
  EXPECT_LT(told.straight_m, 15.5);
  EXPECT_GT(told.tension_n, 5.0);
  EXPECT_GE(told.touching, 2u);
  // It pulls to the post's corner, not to its top.
  const Vec3 at = dive.pose().position_m, pull = glm::normalize(told.pull_n);
  EXPECT_GT(glm::dot(pull, glm::normalize(Vec3(1, at.y, -7) - at)), 0.97);
  // Nowhere is it in the post.
  for (const rov::CableNode& node : dive.state().tether_nodes()) {
    const Vec3 p = rov::world_from_ned(node.position_ned_m);
    EXPECT_FALSE(std::abs(p.x) < 0.99 && std::abs(p.z + 6.0) < 0.99) << p.x << " " << p.z;
  }
}

TEST(SceneTether, ItLiesOnTheFloor) {
  TestDive dive = dive_of(
      std::string(kStillWater) +
      "[[objects]]\nname = \"floor\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [80, "
      "80]\nposition_m = [0, -10, 0]\n" +
      rov_text(
          at_text("[0, -9, -20]") + kStation +
          "tether = { from_m = [0, -4, 0], length_m = 40, net_weight_n_m = 1, segments = 20 }\n"));
  for (const rov::CableNode& node : dive.state().tether_nodes())
    EXPECT_LT(node.position_ned_m.z, 10.0);
  dive.run(20.0);
  EXPECT_GE(tether(dive).touching, 8u);
  for (const rov::CableNode& node : dive.state().tether_nodes()) {
    EXPECT_LT(node.position_ned_m.z, 10.0);
    EXPECT_LT(glm::length(node.velocity_ned_m_s), 0.05);
  }
}

TEST(SceneTether, AWinchPaysOutAndKeepsItsTension) {
  TestDive dive = dive_of(
      kStillWater +
      rov_text(
          at_text("[0, -6, -12]") +
          "navigation = \"truth\"\nmission = { speed_m_s = 0.3, waypoints = [{ position_m = [0, "
          "-6, -22] }] }\ntether = { from_m = [0, -5, 0], length_m = 12.2, net_weight_n_m = 0.2, "
          "winch = { hold_n = 8, speed_m_s = 0.8, most_m = 60 } }\n"));
  dive.run(60.0);
  EXPECT_EQ(dive.vehicle().mission.arrived, 1u);
  EXPECT_GT(tether(dive).length_m, 21.5);
  EXPECT_LT(tether(dive).length_m, 25.0);
  EXPECT_NEAR(tether(dive).top_n, 8.0, 1.6);
}

TEST(SceneTether, AShipThatMovesTowsTheVehicle) {
  TestDive dive =
      dive_of(std::string(kStillWater) +
              "[[objects]]\nname = \"ship\"\nshape = \"box\"\nsize_m = [3, 2, 8]\ntrack = { "
              "waypoints_m = [[0, 0, 0], [0, 0, 100]], speed_m_s = 0.5 }\n" +
              rov_text(at_text("[0, -6, -10]") +
                       "tether = { from_m = [0, -1, 0], from = \"ship\", length_m = 12 }\n"));
  dive.run(60.0);
  const TetherState& now = tether(dive);
  EXPECT_NEAR(rov::world_from_ned(now.top_ned_m).z, 30.0, 1e-6);
  EXPECT_LT(tether_reading(now).straight_m, 12.1);
  EXPECT_GT(now.end_n, 1.0);
}

TEST(SceneTether, ASavedOneGoesOnBitByBit) {
  TestDive dive = round_a_post();
  dive.run(2.0);
  const StateFormat format = dive.world->state_format();
  const std::vector<std::byte> bytes = encode_state(format, saved_state(*dive.simulation, format));
  dive.run(2.0);
  TestDive again = round_a_post();
  const auto parsed = parse_state(format, bytes, "saved");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  restore_state(*again.simulation, *parsed);
  again.run(2.0);
  EXPECT_EQ(again.simulation->newest().hash, dive.simulation->newest().hash);
  // The hash sees the line.
  PhysicsState moved = dive.state();
  const std::uint64_t before = sim::state_hash(moved);
  moved.tether_nodes()[3].position_ned_m.x += 1e-9;
  EXPECT_NE(sim::state_hash(moved), before);
}

TEST(SceneTether, ItsStreamTellsItSixtyTimesASecond) {
  TestDive dive = dive_of(hanging());
  OutputSamples outputs(*dive.world, {dive.world->streams().find("rov/tether").value()});
  std::size_t count = outputs.of(dive.simulation->newest()).size();
  TetherReading last;
  dive.run(1.0, [&] {
    for (const Sample& sample : outputs.of(dive.simulation->newest())) {
      ++count;
      last = std::get<TetherReading>(sample.payload);
    }
  });
  EXPECT_EQ(count, 61u);
  EXPECT_EQ(last.length_m, 24.0);
  EXPECT_GT(last.tension_n, 1.0);
}

TEST(SceneTether, ItIsDrawnFromItsTopToTheVehicle) {
  TestDive dive = dive_of(hanging());
  const PhysicsTether& of = dive.world->tethers().all()[0];
  const scene::Object& object = dive.scene.objects[of.object];
  EXPECT_EQ(object.name, "rov_tether");
  ASSERT_GE(object.model, 0);
  const scene::Model& model = *dive.scene.models[static_cast<std::size_t>(object.model)];
  const auto key = drawn_tether(dive.world->tethers().nodes(dive.state(), 0), tether(dive), 0.0);
  EXPECT_EQ(key.places_m.size(), 24u * scene::kTetherJoints + 1);
  EXPECT_EQ(model.skins.at(0).joints.size(), key.places_m.size());
  EXPECT_LT(glm::length(key.places_m.front()), 1e-12);
  EXPECT_LT(glm::distance(key.places_m.back(), Vec3(0, -2, -20)), 1e-9);
  double way_m = 0.0;
  for (std::size_t i = 1; i < key.places_m.size(); ++i) {
    way_m += glm::distance(key.places_m[i - 1], key.places_m[i]);
    // A ring stands across the line.
    const Vec3 down = key.rotations[i] * Vec3(0.0, -1.0, 0.0);
    EXPECT_GT(glm::dot(down, glm::normalize(key.places_m[i] - key.places_m[i - 1])), 0.9);
  }
  EXPECT_NEAR(way_m, 24.0, 0.1);
}

TEST(SceneTether, FaultsAreOneLine) {
  const auto fault = [](const std::string& keys, const std::string& more = "") {
    auto scene = load_text(kStillWater +
                           rov_text(at_text("[0, -4, 0]") + more + "tether = { " + keys + " }\n"));
    if (!scene.ok()) return scene.error().message;
    auto world = PhysicsWorld::create(*scene);
    return world.ok() ? std::string("none") : world.error().message;
  };
  EXPECT_THAT(fault("length_m = 5"), HasSubstr("from_m"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], length_m = 0"), HasSubstr("length_m: found 0"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], length_m = nan"), HasSubstr("length_m"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], segments = 0"), HasSubstr("segments: found 0"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], from = \"boat\""), HasSubstr("boat"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], net_weight_n_m = -5"), HasSubstr("net_weight_n_m"));
  EXPECT_THAT(fault("from_m = [0, 0, 0], length_m = 9, winch = { most_m = 5 }"),
              HasSubstr("most_m"));
  EXPECT_THAT(fault("from_m = [0, 0, 0]", "tether_anchor_m = [0, 0, 0]\n"),
              HasSubstr("tether_anchor_m"));
  EXPECT_EQ(fault("from_m = [0, 0, 0]"), "none");
}

}  // namespace
}  // namespace neritic::testbed
