// Divers in scenes: they swim where they are told, a vehicle keeps beside, nothing is swum through,
// and what is drawn is the body that the physics has.
#include "diver/exertion.hpp"
#include "diver/frames.hpp"
#include "engine/scene/animation.hpp"
#include "testbed/record/dive_record.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

Pose swimmer_pose(const TestDive& dive) {
  const diver::RootState& root = dive.state().humans()[0].human.root;
  return world_pose(root.position_ned_m, root.attitude);
}

TEST(HumanDive, SwimsFromPointToPointAndHoversAtTheLast) {
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne + R"(
[objects.swim]
speed_m_s = 0.45
waypoints_m = [[0, -12, -10], [8, -11, -16]]
)"));
  std::uint64_t arrived = 0;
  dive.run(70.0, [&] {
    const HumanPhysics& human = dive.state().humans()[0];
    if (human.arrived == arrived) return;
    ++arrived;
    ASSERT_EQ(human.arrived, arrived);
  });
  EXPECT_EQ(arrived, 2u);
  EXPECT_LT(glm::distance(swimmer_pose(dive).position_m, Vec3(8, -11, -16)), 6.0);
  EXPECT_LT(glm::length(dive.state().humans()[0].human.root.velocity.linear()), 0.25);
  const diver::LifeState& life = dive.state().humans()[0].human.life;
  EXPECT_LT(diver::tank_pressure(dive.world->humans()[0].body, life.tanks, 0), 199e5);
  // Tissues take up gas.
  EXPECT_NEAR(life.computer.dive_min, 70.0 / 60.0, 0.02);
  EXPECT_GT(life.computer.tissues.n2_bar[0],
            dive.world->humans()[0].start.human.life.computer.tissues.n2_bar[0]);
}

TEST(HumanDive, AVehicleKeepsBesideADiver) {
  TestDive dive = dive_of(kStillWater +
                          diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                     "swim = { waypoints_m = [[0, -12, -40]] }\n") +
                          rov_text(R"(
position_m = [2.5, -12, 0]
mission = { follow = { object = "diver", offset_m = [2.5, 0.3, 0] }, look_at = "diver" }
)"));
  double least = 1e9, most = 0.0, facing = 1.0;
  dive.run(40.0, [&] {
    if (dive.time_s() < 10.0) return;
    const Vec3 way = swimmer_pose(dive).position_m - dive.pose().position_m;
    least = std::min(least, glm::length(way));
    most = std::max(most, glm::length(way));
    facing = std::min(facing, glm::dot(dive.pose().rotation * Vec3(0, 0, -1), glm::normalize(way)));
  });
  EXPECT_GT(least, 2.2);
  EXPECT_LT(most, 2.9);
  EXPECT_GT(facing, 0.9);
  EXPECT_GT(dive.vehicle().body.position_ned_m.x, 10.0);
}

// The shipped dive, and five minutes after its last waypoint: the diver comes back where the
// current takes him off, and the vehicle stays at its station, on either side, clear of the wreck.
TEST(HumanDive, AVehicleKeepsBesideADiverWhoComesBack) {
  auto scene = scene::load_scene(test::source_dir() / "assets/scenes/dive.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  TestDive dive = dive_of(std::move(scene).value());
  double off_m = 0.0;
  dive.run(420.0, [&] {
    if (dive.time_s() < 10.0) return;
    const VehicleState& rov = dive.vehicle();
    off_m = std::max(off_m, glm::distance(rov.mission.wanted_ned_m, rov.body.position_ned_m));
  });
  EXPECT_EQ(dive.state().humans()[0].arrived, 4u);
  EXPECT_LT(off_m, 1.5);
  EXPECT_LT(glm::distance(swimmer_pose(dive).position_m, Vec3(5.5, -14.4, 24.0)), 5.0);
  EXPECT_EQ(dive.vehicle().contact.touched_steps, 0u);
  EXPECT_EQ(dive.state().humans()[0].contact.touched_steps, 0u);
}

TEST(HumanDive, IsStoppedByAWallAndComesBackFromIt) {
  TestDive dive = dive_of(kStillWater + std::string(R"(
[[objects]]
name = "wall"
class = "structure"
shape = "box"
size_m = [40, 40, 1]
position_m = [0, -12, -5.5]
)") + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne + R"(
[objects.swim]
speed_m_s = 0.6
waypoints_m = [[0, -12, -20]]
)"));
  double farthest = 0.0;
  dive.run(40.0, [&] { farthest = std::min(farthest, swimmer_pose(dive).position_m.z); });
  const HumanPhysics& human = dive.state().humans()[0];
  EXPECT_GT(human.contact.touched_steps, 10u);
  EXPECT_LT(human.contact.deepest_m, 0.05);
  EXPECT_GT(farthest, -5.0);  // the hips; the head is 0.8 m before them
  EXPECT_TRUE(sim::all_finite(dive.state()));
}

TEST(HumanDive, WhatIsDrawnIsTheBodyOfThePhysics) {
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                       "swim = { waypoints_m = [[20, -12, -10]] }\n"));
  const PhysicsHuman& human = dive.world->humans()[0];
  const scene::Model& model =
      *dive.scene.models[static_cast<std::size_t>(dive.scene.objects[human.object].model)];
  double moved_m = 0.0, breath = 0.0;
  Vec3 first_foot(0.0);
  for (int i = 0; i < 30; ++i) {
    dive.run(0.21);
    const HumanPhysics& state = dive.state().humans()[0];
    const scene::NodeKey key = drawn_joints(human, state, 0.0);
    const scene::ModelPose pose = scene::evaluate_pose(model, {human.nodes, &key}, 0.0);
    const Pose world_from_model = drawn_pose(state);
    const diver::Posture posture =
        diver::posture_of(human.body, state.human.limbs.rotation, state.human.limbs.rate);
    const diver::RootState& root = state.human.root;
    for (const diver::Segment joint :
         {diver::kPelvis, diver::kHead, diver::kLeftForearm, diver::kRightHand,
          diver::kLeftLowerLeg, diver::kRightLowerLeg, diver::kLeftFoot, diver::kRightFoot}) {
      const Vec3 drawn =
          world_from_model *
          Vec3(pose.model_from_node[static_cast<std::size_t>(human.nodes[joint])][3]);
      const Vec3 there =
          world_from_ned(root.position_ned_m + root.attitude * posture[joint].origin_m);
      // The model's hips, knees and ankles are some centimetres from the tables'.
      EXPECT_LT(glm::distance(drawn, there), 0.05) << diver::kSegmentNames[joint] << " " << i;
      if (joint != diver::kLeftFoot) continue;
      const Vec3 in_model = inverse(world_from_model) * drawn;
      if (i == 0) first_foot = in_model;
      moved_m = std::max(moved_m, glm::distance(in_model, first_foot));
    }
    const Vec3 scale = key.scales[diver::kAbdomen];
    breath = std::max(breath, scale.z - 1.0);
  }
  EXPECT_GT(moved_m, 0.15);
  EXPECT_GT(breath, 0.02);
  EXPECT_LT(breath, 0.15);
}

// The drawn jacket: as built without gas, and by a layer of 45 mm wider on each side with 18
// litres, which is the gas's volume about an ellipse of 0.195 and 0.146 m, 0.33 m high.
TEST(HumanDive, TheDrawnJacketSwellsWithItsGas) {
  const TestDive dive = dive_of(kStillWater + diver_text("position_m = [0, -12, 0]\n"));
  const PhysicsHuman& human = dive.world->humans()[0];
  const scene::Model& model =
      *dive.scene.models[static_cast<std::size_t>(dive.scene.objects[human.object].model)];
  const auto scale_of = [&](const char* name, double gas_m3) {
    HumanPhysics state = human.start;
    state.human.life.jacket_moles =
        diver::jacket_moles(human.body, gas_m3, diver::thorax_place(human.body, state.human));
    const scene::NodeKey key = drawn_joints(human, state, 0.0);
    for (std::size_t i = 0; i < human.nodes.size(); ++i)
      if (model.nodes[static_cast<std::size_t>(human.nodes[i])].name == name) return key.scales[i];
    return Vec3(0.0);
  };
  const double size = human.scale, full_m3 = human.body.jacket.capacity_m3;
  double before_m = 0.0;
  for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const Vec3 thorax = scale_of("jacket_thorax", share * full_m3);
    EXPECT_EQ(thorax, scale_of("jacket_abdomen", share * full_m3));
    EXPECT_EQ(scale_of("jacket_pelvis", share * full_m3), Vec3(1.0));
    EXPECT_EQ(thorax.y, 1.0);
    const double wide_m = 0.195 * (thorax.x - 1.0), deep_m = 0.146 * (thorax.z - 1.0);
    EXPECT_NEAR(wide_m, deep_m, 1e-12);
    const double more_m3 = kPi * 0.33 * (0.195 * 0.146) * (thorax.x * thorax.z - 1.0);
    EXPECT_NEAR(more_m3 * size * size * size, share * full_m3, 1e-3 * full_m3) << share;
    EXPECT_GE(wide_m, before_m);
    before_m = wide_m;
  }
  EXPECT_NEAR(before_m * size, 0.045, 0.003);
}

// The drawn diver has the file's height and exactly the file's gear.
TEST(HumanDive, IsDrawnAtItsHeightWithItsGear) {
  const test::ScratchFolder folder;
  const auto bounds_of = [&](const std::string& file, double* crown_m) {
    EXPECT_TRUE(write_text(folder / "d.toml", file).ok());
    // Stands, so that the pose is the model's but for what is drawn otherwise.
    const TestDive dive = dive_of(
        kStillWater + diver_text("position_m = [0, -12, 0]\n", (folder / "d.toml").string()));
    const PhysicsHuman& human = dive.world->humans()[0];
    const scene::Model& model =
        *dive.scene.models[static_cast<std::size_t>(dive.scene.objects[human.object].model)];
    scene::NodeKey key = drawn_joints(human, human.start, 0.0);
    for (Quat& turn : key.rotations) turn = Quat(1.0, 0.0, 0.0, 0.0);  // as it was built
    const scene::ModelPose pose = scene::evaluate_pose(model, {human.nodes, &key}, 0.0);
    // Head to foot, which no gear lengthens.
    const auto at = [&](diver::Segment s) {
      return Vec3(pose.model_from_node[static_cast<std::size_t>(human.nodes[s])][3]);
    };
    *crown_m = at(diver::kHead).y - at(diver::kRightFoot).y;
    return scene::model_bounds(model, pose);
  };
  double usual_m = 0.0, small_m = 0.0, tall_m = 0.0;
  const auto usual = bounds_of("height_m = 1.80\n", &usual_m);
  const auto bare =
      bounds_of("height_m = 1.45\ntanks = []\nfins = false\njacket = false\n", &small_m);
  const auto tall =
      bounds_of("height_m = 2.05\nfins = { length_m = 0.8, width_m = 0.2 }\n", &tall_m);
  EXPECT_NEAR(small_m / usual_m, 1.45 / 1.80, 0.01);
  EXPECT_NEAR(tall_m / usual_m, 2.05 / 1.80, 0.01);
  // The model's own: the tank behind the back to 0.36 m, blades before the toes to 0.58 m.
  EXPECT_NEAR(usual.max.z, 0.36, 0.02);
  EXPECT_NEAR(usual.min.z, -0.58, 0.02);
  EXPECT_LT(bare.max.z, 0.20);          // no tank
  EXPECT_GT(bare.min.z, -0.22);         // no fins: toes and mask
  EXPECT_LT(tall.min.z, -0.165 - 0.8);  // blades of 0.8 m
  EXPECT_GT(tall.min.z, -0.22 * 2.05 / 1.80 - 0.82);
}

// A kick as a table of joint angles, one beat that repeats, swims as the swimmer's own kick does.
TEST(HumanDive, RecordedLimbsSwim) {
  const test::ScratchFolder scratch;
  const TestDive hovering =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne));
  const diver::Body& body = hovering.world->humans()[0].body;
  std::string csv = "t_s";
  for (std::size_t joint = 0; joint < diver::kJoints; ++joint)
    csv +=
        fmt::format(",{0}_x_deg,{0}_y_deg,{0}_z_deg", diver::kSegmentNames[diver::child_of(joint)]);
  constexpr int kRows = 60;
  for (int i = 0; i <= kRows; ++i) {
    diver::JointAngles joints = diver::streamlined(body);
    diver::set_flutter(joints, body, {}, 2.0 * kPi * i / kRows);
    csv += fmt::format("\n{}", i / double{kRows});
    for (const Vec3& angle : joints)
      csv += fmt::format(",{},{},{}", degrees(angle.x), degrees(angle.y), degrees(angle.z));
  }
  ASSERT_TRUE(write_text(scratch / "kick.csv", csv).ok());
  const std::string swim =
      fmt::format("swim = {{ motion = \"{}\", repeat = true }}\n", (scratch / "kick.csv").string());
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne + swim));
  dive.run(5.0);
  const Vec3 from = swimmer_pose(dive).position_m;
  dive.run(5.0);
  const double speed_m_s = glm::distance(swimmer_pose(dive).position_m, from) / 5.0;
  EXPECT_GT(speed_m_s, 0.4);  // 0.54 m a beat
  EXPECT_LT(speed_m_s, 0.7);
  EXPECT_EQ(dive.state().humans()[0].human.far_joints, 0u);
  EXPECT_LT(dive.state().humans()[0].human.life.limb_power_w, 300.0);
}

// As fast as the legs go, some 227 W: within four minutes a fifth of the reserve is spent.
TEST(HumanDive, TheShippedDiverTiresAtTheHardestPaceWithinFiveMinutes) {
  TestDive dive = dive_of(
      kStillWater + diver_text("position_m = [0, -10, 0]\nyaw_deg = 180\npitch_deg = -90\n"
                               "swim = { speed_m_s = 0.9, waypoints_m = [[0, -10, 500]] }\n"));
  dive.run(240.0);
  const auto& life = dive.state().humans()[0].human.life;
  EXPECT_GT(life.limb_power_w, 200.0);
  EXPECT_LT(diver::reserve_share(dive.world->humans()[0].body.fitness, life.spent_j), 0.8);
}

TEST(HumanDive, RunsAndReplaysWithTheSameHashes) {
  const std::string text =
      kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                               "swim = { waypoints_m = [[3, -12, -6], [0, -11, 0]] }\n");
  TestDive a = dive_of(text), b = dive_of(text);
  a.run(4.0);
  Suit steering;
  steering.worn = 1;
  steering.human.buttons = diver::kInflate;
  steering.human.joints = diver::rotations_of(diver::streamlined(a.world->humans()[0].body));
  ASSERT_TRUE(wear(a, 0, steering));
  a.run(3.0);
  b.run(4.0);
  const auto& hashes = a.simulation->log().hashes;
  for (std::size_t i = 0; i <= 960; ++i) ASSERT_EQ(hashes[i], b.simulation->log().hashes[i]) << i;
  EXPECT_GT(a.state().humans()[0].human.life.jacket_moles,
            b.state().humans()[0].human.life.jacket_moles);
  const auto report = replayed(*a.world, a.simulation->log());
  EXPECT_FALSE(report.first_difference.has_value());
  EXPECT_EQ(report.steps, a.simulation->log().steps());
}

std::string fault_of(const std::string& text) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "s.toml", text).ok());
  const auto scene = scene::load_scene(scratch / "s.toml");
  if (!scene.ok()) return scene.error().message;
  const auto world = PhysicsWorld::create(*scene);
  return world.ok() ? "" : world.error().message;
}

TEST(HumanDive, MistakesAreToldInOneLine) {
  const std::string box = "[[objects]]\nname = \"box\"\nshape = \"box\"\nhuman = \"" +
                          (test::source_dir() / "assets/divers/recreational.toml").string() +
                          "\"\n";
  EXPECT_NE(fault_of(std::string("[physics]\n") + box).find("without the node 'pelvis'"),
            std::string::npos);
  const std::string any_file = (test::source_dir() / "assets/divers/recreational.toml").string();
  EXPECT_NE(fault_of(kStillWater +
                     diver_text("swim = { motion = \"" + any_file + "\", speed_m_s = 0.4 }\n"))
                .find("no such key beside motion"),
            std::string::npos);
  EXPECT_NE(fault_of(kStillWater + diver_text("swim = { motion = \"" + any_file + "\" }\n"))
                .find("recreational.toml"),
            std::string::npos);
  const test::ScratchFolder scratch;
  const std::string bare = (scratch / "bare.toml").string(),
                    buttons = (scratch / "buttons.csv").string();
  ASSERT_TRUE(write_text(bare, "jacket = false\n").ok());
  ASSERT_TRUE(write_text(buttons, "t_s,inflate\n0,1\n").ok());
  const std::string pressed = "jacket_buttons = \"" + buttons + "\"\n";
  EXPECT_NE(fault_of(kStillWater + diver_text(pressed, bare)).find("a diver without a jacket"),
            std::string::npos);
  EXPECT_NE(fault_of(kStillWater + rov_text(pressed)).find("no such key without human"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
