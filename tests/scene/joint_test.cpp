// Things that hang on a node of another's model: they follow its clip, or what else poses it.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/motion.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

std::string diver_with(const std::string& more, const std::string& of_diver = "") {
  return "[water]\n[[objects]]\nname = \"diver\"\nmodel = \"" +
         (test::source_dir() / "assets/models/diver.glb").string() +
         "\"\nclip = \"cruise\"\nclip_offset_s = 0.3\nclip_rate = 1.5\nscale = 1.2\n" +
         "position_m = [1, -5, 2]\nyaw_deg = 40\npitch_deg = -86\n" + of_diver + more;
}

constexpr const char* kTorch =
    "[[objects]]\nname = \"torch\"\nshape = \"sphere\"\non = \"diver\"\njoint = \"hand_r\"\n"
    "position_m = [0.1, 0.02, -0.03]\nyaw_deg = 20\n"
    "[[lamps]]\non = \"torch\"\nposition_m = [0, 0, -0.1]\n";

int node_named(const Model& model, std::string_view name) {
  const auto at = std::ranges::find(model.nodes, name, &Node::name);
  return at == model.nodes.end() ? -1 : static_cast<int>(at - model.nodes.begin());
}

// A swimmer's limbs, from nothing but the time: the arm is lifted by it.
class LiftsTheArm final : public SimulatedMotion {
 public:
  std::optional<MotionAt> at(std::size_t object, double) const override {
    if (object != 0) return std::nullopt;
    return MotionAt{{{Vec3(3, -4, 5), Quat(1, 0, 0, 0)}}};
  }
  std::optional<ModelPose> model_pose(std::size_t object, const Model& model,
                                      double time_s) const override {
    if (object != 0) return std::nullopt;
    return evaluate_pose(model, keys(), time_s);
  }
  std::optional<Mat4> model_from_node(std::size_t object, const Model& model, int node,
                                      double time_s) const override {
    if (object != 0) return std::nullopt;
    return evaluate_node(model, node, keys(), time_s);
  }

  explicit LiftsTheArm(const Model& model)
      : nodes_{node_named(model, "upper_arm_r"), node_named(model, "forearm_r")} {
    for (const double time_s : {0.0, 2.0})
      ends_.push_back({time_s,
                       {glm::angleAxis(time_s, Vec3(1, 0, 0)), glm::angleAxis(0.3, Vec3(0, 0, 1))},
                       {Vec3(1.0), Vec3(1.0)}});
  }

 private:
  NodeKeys keys() const { return {nodes_, &ends_[0], &ends_[1]}; }
  std::vector<int> nodes_;
  std::vector<NodeKey> ends_;
};

TEST(Joint, WhatHangsOnItFollowsTheClip) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, diver_with(kTorch));
  ASSERT_EQ(scene.objects.size(), 2u);
  const Model& model = *scene.models[0];
  const int hand = node_named(model, "hand_r");
  ASSERT_GE(hand, 0);
  const Mount& torch = scene.objects[1].mount;
  EXPECT_EQ(torch.joint, hand);
  for (const double time_s : {0.0, 0.4, 7.3}) {
    // By matrices: clip, the diver's scale, its place.
    const ModelPose pose = evaluate_pose(model, scene.objects[0].clip, 0.3 + 1.5 * time_s);
    const Mat4 m = pose.model_from_node[static_cast<std::size_t>(hand)];
    const Pose world_from_diver = scene.world_from(scene.objects[0].mount, time_s);
    const Vec3 expected = world_from_diver * (1.2 * Vec3(m[3]) + Mat3(m) * Vec3(0.1, 0.02, -0.03));
    const Pose there = scene.world_from(torch, time_s);
    expect_near(there.position_m, expected, 1e-6);
    expect_near(forward_of(there),
                world_from_diver.rotation *
                    (Mat3(m) * (glm::angleAxis(radians(20.0), Vec3(0, 1, 0)) * Vec3(0, 0, -1))),
                1e-6);
    expect_near(scene.world_from(scene.lamps[0].mount, time_s).position_m,
                there.position_m + 0.1 * forward_of(there));
  }
  EXPECT_GT(glm::distance(scene.world_from(torch, 0.0).position_m,
                          scene.world_from(torch, 0.5).position_m),
            0.01);
}

TEST(Joint, ItsVelocityIsThatOfItsPlaces) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, diver_with(kTorch));
  const MotionSource source(scene);
  const Mount& lamp = scene.lamps[0].mount;
  const Motion motion = source.at(lamp, 0.6).motion;
  constexpr double kStep_s = 2e-3;
  const Vec3 by_places = (source.world_from(lamp, 0.6 + kStep_s).position_m -
                          source.world_from(lamp, 0.6 - kStep_s).position_m) /
                         (2.0 * kStep_s);
  EXPECT_GT(glm::length(by_places), 0.01);
  expect_near(motion.velocity_m_s, by_places, 0.02 * glm::length(by_places));
}

TEST(Joint, WhatHangsOnItFollowsASimulatedBody) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, diver_with(kTorch));
  const LiftsTheArm simulated(*scene.models[0]);
  const MotionSource source(scene, &simulated);
  const Model& model = *scene.models[0];
  const int hand = node_named(model, "hand_r");
  for (const double time_s : {0.0, 1.0}) {
    const Mat4 m = simulated.model_pose(0, model, time_s)->model_from_node[hand];
    const Vec3 hand_m = Vec3(3, -4, 5) + 1.2 * Vec3(m[3]);
    expect_near(source.world_from_joint(0, hand, time_s).position_m, hand_m, 1e-6);
    const Vec3 torch_m = hand_m + Mat3(m) * Vec3(0.1, 0.02, -0.03);
    expect_near(source.world_from(scene.objects[1].mount, time_s).position_m, torch_m, 1e-6);
    // As missions know it, without the scene.
    const CarriedThing thing(scene, scene.objects[1].mount);
    expect_near(thing.at(time_s, &simulated).motion.pose.position_m, torch_m, 1e-6);
  }
  expect_near(source.world_from_joint(0, -1, 0.0).position_m, {3, -4, 5});
}

TEST(Joint, OneNodeIsWhereTheWholePoseHasIt) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, diver_with(kTorch));
  const Model& model = *scene.models[0];
  const LiftsTheArm simulated(model);
  for (const double time_s : {-1.0, 0.0, 0.7, 1.9, 1e7})
    for (std::size_t node = 0; node < model.nodes.size(); ++node) {
      const int joint = static_cast<int>(node);
      EXPECT_EQ(evaluate_node(model, joint, scene.objects[0].clip, time_s),
                evaluate_pose(model, scene.objects[0].clip, time_s).model_from_node[node]);
      EXPECT_EQ(*simulated.model_from_node(0, model, joint, time_s),
                simulated.model_pose(0, model, time_s)->model_from_node[node]);
    }
}

TEST(Joint, APartThatIsNotWornHasTheObjectsAxes) {
  Mat4 model_from_node(0.0);
  model_from_node[3] = Vec4(1, 2, 3, 1);
  const Pose out = object_from_joint(model_from_node, Vec3(2.0));
  expect_near(out.position_m, {2, 4, 6});
  EXPECT_EQ(out.rotation, Quat(1, 0, 0, 0));
}

TEST(Joint, ACameraLooksFromItAtWhatHangsThere) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(
      scratch, diver_with(std::string(kTorch) +
                          "[[cameras]]\non = \"diver\"\njoint = \"head\"\nlook_at = \"torch\"\n"));
  const Pose eye = scene.world_from(scene.cameras[0].mount);
  const Vec3 torch_m = scene.world_from(scene.objects[1].mount).position_m;
  expect_near(forward_of(eye), glm::normalize(torch_m - eye.position_m), 1e-6);
}

TEST(Joint, WrongNamesAreNamed) {
  const test::ScratchFolder scratch;
  const std::string on_diver = "[[objects]]\nshape = \"box\"\non = \"diver\"\n";
  EXPECT_EQ(message_of(scratch, diver_with(on_diver + "joint = \"hand\"\n")),
            "s.toml:15: objects[1].joint: found \"hand\"; accepted: a node of diver's model "
            "(nearest: \"head\")");
  EXPECT_EQ(message_of(scratch, diver_with("[[objects]]\nshape = \"box\"\njoint = \"head\"\n")),
            "s.toml:14: objects[1].joint: found \"head\"; accepted: beside on");
  EXPECT_EQ(message_of(scratch, diver_with(on_diver + "joint = \"head\"\n",
                                           "copies = [[0, 0, 0], [1, 0, 0]]\n")),
            "s.toml:16: objects[1].joint: found \"head\" of diver; accepted: a node of an object "
            "that is drawn once");
  EXPECT_EQ(
      message_of(scratch, diver_with("[[water.bubbles]]\non = \"diver\"\njoint = \"regulatr\"\n")),
      "s.toml:14: water.bubbles[0].joint: found \"regulatr\"; accepted: a node of diver's model "
      "(nearest: \"regulator\")");
  EXPECT_EQ(message_of(scratch, diver_with("[[water.silt]]\non = \"diver\"\njoint = \"fin\"\n"
                                           "bed_depth_m = 9\n")),
            "s.toml:14: water.silt[0].joint: found \"fin\"; accepted: a node of diver's model "
            "(nearest: \"fin_l\")");
}

// Bubbles of each place's divers leave the regulator's exhaust, as it is worn and posed.
TEST(Joint, TheBubblesOfPlacesLeaveTheRegulator) {
  std::size_t sources = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "assets/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const auto scene = load_scene(entry.path());
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    if (!scene->water) continue;
    const MotionSource motion(*scene);
    for (const BubbleSource& bubbles : scene->water->bubbles) {
      const Object& object = scene->objects[static_cast<std::size_t>(bubbles.object)];
      const Model& model = *scene->models[static_cast<std::size_t>(object.model)];
      const int regulator = node_named(model, "regulator");
      if (regulator < 0) continue;
      ++sources;
      for (const double time_s : {0.0, 0.7, 11.3}) {
        // The exhaust tee is 0.032 m over the joint and 0.16 m before it.
        const Vec3 exhaust_m =
            motion.world_from_joint(bubbles.object, regulator, time_s) * Vec3(0.0, 0.032, -0.160);
        const Vec3 from_m =
            motion.world_from_joint(bubbles.object, bubbles.joint, time_s) * bubbles.position_m;
        EXPECT_LT(glm::distance(exhaust_m, from_m), 0.02) << entry.path() << " " << time_s;
      }
    }
  }
  EXPECT_GE(sources, 2u);
}

// A torch burns before its lens, and its handle is in the hand.
TEST(Joint, TheTorchesOfPlacesAreInHands) {
  for (const char* name : {"cave.toml", "night.toml", "halocline.toml"}) {
    const auto scene = load_scene(test::source_dir() / "assets/scenes" / name);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto lamp = std::ranges::find(scene->lamps, "torch", &Lamp::name);
    ASSERT_NE(lamp, scene->lamps.end()) << name;
    ASSERT_GE(lamp->mount.object, 0) << name;
    const Object& torch = scene->objects[static_cast<std::size_t>(lamp->mount.object)];
    ASSERT_GE(torch.mount.joint, 0) << name;
    const Object& diver = scene->objects[static_cast<std::size_t>(torch.mount.object)];
    const Model& model = *scene->models[static_cast<std::size_t>(diver.model)];
    EXPECT_EQ(model.nodes[static_cast<std::size_t>(torch.mount.joint)].name, "hand_r") << name;
    for (const double time_s : {0.0, 1.0, 2.0}) {
      Mount hand = torch.mount;
      hand.pose = {};
      const Vec3 hand_m = scene->world_from(hand, time_s).position_m;
      const Pose at = scene->world_from(lamp->mount, time_s);
      EXPECT_LT(glm::distance(hand_m, at.position_m), 0.25) << name;
      // Ahead, as the diver swims: the model lies with its head ahead.
      const Vec3 ahead = scene->world_from(diver.mount, time_s).rotation * Vec3(0, 1, 0);
      EXPECT_GT(glm::dot(forward_of(at), ahead), 0.8) << name;
    }
  }
}

}  // namespace
}  // namespace neritic::scene
