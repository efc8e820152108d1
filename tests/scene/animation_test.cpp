// Poses of clips against closed forms: step, linear, spherical, cubic; hierarchy, skins, morphs.
#include "engine/scene/animation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace neritic::scene {
namespace {

// Node 1 hangs below node 0; the channel moves node 0.
Model two_nodes(Channel channel) {
  Model model;
  model.nodes.resize(2);
  model.nodes[0].children = {1};
  model.nodes[1].parent = 0;
  model.nodes[1].translation_m = Vec3(1.0, 0.0, 0.0);
  model.roots = {0};
  Clip clip;
  clip.name = "move";
  clip.duration_s = channel.times_s.back();
  channel.node = 0;
  clip.channels.push_back(std::move(channel));
  model.clips.push_back(std::move(clip));
  return model;
}

Vec3 origin_of(const ModelPose& pose, int node) {
  return Vec3(pose.model_from_node[node][3]);
}

Channel slide(Channel::Interpolation interpolation) {
  Channel channel;
  channel.interpolation = interpolation;
  channel.times_s = {1.0f, 2.0f, 4.0f};
  channel.values = {0, 0, 0, 10, 0, 0, 10, 20, 0};
  return channel;
}

Channel turn(const Quat& from, const Quat& to) {
  Channel channel;
  channel.path = Channel::Path::kRotation;
  channel.width = 4;
  channel.times_s = {0.0f, 1.0f};
  for (const Quat& q : {from, to})
    for (const double v : {q.x, q.y, q.z, q.w}) channel.values.push_back(static_cast<float>(v));
  return channel;
}

TEST(Animation, StepHoldsTheLastKeyUntilTheNext) {
  const Model model = two_nodes(slide(Channel::Interpolation::kStep));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 1.999, false), 0), Vec3(0, 0, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 2.0, false), 0), Vec3(10, 0, 0));
}

TEST(Animation, LinearBlendsBetweenKeysAndCarriesTheChildAlong) {
  const Model model = two_nodes(slide(Channel::Interpolation::kLinear));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 1.5, false), 0), Vec3(5, 0, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 2.5, false), 1), Vec3(11, 5, 0));
}

TEST(Animation, TimeIsClampedOrWrappedAndNanCountsAsZero) {
  const Model model = two_nodes(slide(Channel::Interpolation::kLinear));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, -3.0, false), 0), Vec3(0, 0, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 99.0, false), 0), Vec3(10, 20, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 4.0 + 1.5, true), 0), Vec3(5, 0, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, 1.5 - 8.0, true), 0), Vec3(5, 0, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(origin_of(evaluate_pose(model, 0, nan, true), 0), Vec3(0, 0, 0));
}

TEST(Animation, NoClipIsTheRestPose) {
  const Model model = two_nodes(slide(Channel::Interpolation::kLinear));
  EXPECT_EQ(origin_of(evaluate_pose(model, -1, 2.0), 1), Vec3(1, 0, 0));
  EXPECT_EQ(origin_of(evaluate_pose(model, 7, 2.0), 1), Vec3(1, 0, 0));
  EXPECT_EQ(find_clip(model, "move", "clip").value(), 0);
  EXPECT_EQ(find_clip(model, "0", "clip").value(), 0);
  EXPECT_EQ(find_clip(model, "stand", "--clip").error().message,
            "--clip: found \"stand\"; accepted: a clip of the model, by name or number: 0 move");
}

// A cubic whose tangents are the slopes of f(t) = t^3 - 2t reproduces f exactly.
TEST(Animation, CubicSplineReproducesACubic) {
  const auto f = [](double t) { return t * t * t - 2.0 * t; };
  const auto slope = [](double t) { return 3.0 * t * t - 2.0; };
  Channel channel;
  channel.interpolation = Channel::Interpolation::kCubic;
  channel.times_s = {0.5f, 2.0f, 3.0f};
  for (const double t : {0.5, 2.0, 3.0})
    for (const double v : {slope(t), f(t), slope(t)})
      channel.values.insert(channel.values.end(), {static_cast<float>(v), 0.0f, 0.0f});
  const Model model = two_nodes(channel);
  for (double t = 0.5; t <= 3.0; t += 0.09)
    EXPECT_NEAR(origin_of(evaluate_pose(model, 0, t, false), 0).x, f(t), 1e-5) << t;
}

TEST(Animation, RotationsTurnAtConstantSpeedOnTheShorterArc) {
  const double angle_rad = radians(100.0);
  const Quat to = glm::angleAxis(angle_rad, Vec3(0, 0, 1));
  for (const double sign : {1.0, -1.0}) {  // q and -q are the same attitude
    const Model model = two_nodes(turn(Quat(1, 0, 0, 0), to * sign));
    for (const double t : {0.25, 0.5, 0.8}) {
      const Vec3 tip = origin_of(evaluate_pose(model, 0, t, false), 1);
      EXPECT_NEAR(tip.x, std::cos(t * angle_rad), 1e-6);
      EXPECT_NEAR(tip.y, std::sin(t * angle_rad), 1e-6);
    }
  }
}

TEST(Animation, NearlyEqualRotationsStayFinite) {
  const Quat to = glm::angleAxis(1e-9, Vec3(0, 0, 1));
  const Model model = two_nodes(turn(Quat(1, 0, 0, 0), to));
  EXPECT_NEAR(origin_of(evaluate_pose(model, 0, 0.5, false), 1).x, 1.0, 1e-12);
}

TEST(Animation, CubicRotationsAreNormalised) {
  Channel channel;
  channel.path = Channel::Path::kRotation;
  channel.interpolation = Channel::Interpolation::kCubic;
  channel.width = 4;
  channel.times_s = {0.0f, 1.0f};
  channel.values = {9, 9, 9, 9, 0, 0, 0, 1, 3, -2, 1, 0, 5, 0, 0, 2, 0, 0, 1, 0, 9, 9, 9, 9};
  const Model model = two_nodes(channel);
  for (const double t : {0.1, 0.5, 0.9}) {
    const Vec3 tip = origin_of(evaluate_pose(model, 0, t, false), 1);
    EXPECT_NEAR(glm::length(tip), 1.0, 1e-9);
  }
}

TEST(Animation, MatrixNodesKeepTheirMatrix) {
  Model model = two_nodes(slide(Channel::Interpolation::kLinear));
  Mat4 shear(1.0);
  shear[1][0] = 0.5;  // x += y / 2
  model.nodes[1].matrix = shear;
  model.nodes[0].scale = Vec3(2.0, 3.0, 4.0);
  const auto pose = evaluate_pose(model, -1, 0.0);
  EXPECT_EQ(Vec3(pose.model_from_node[1] * Vec4(0, 2, 0, 1)), Vec3(2, 6, 0));
}

TEST(Animation, DeepHierarchiesNeedNoStack) {
  Model model;
  constexpr int kDepth = 200000;
  model.nodes.resize(kDepth);
  for (int i = 0; i < kDepth; ++i) {
    model.nodes[i].parent = i - 1;
    if (i + 1 < kDepth) model.nodes[i].children = {i + 1};
    model.nodes[i].translation_m = Vec3(1.0, 0.0, 0.0);
  }
  model.roots = {0};
  EXPECT_EQ(origin_of(evaluate_pose(model, -1, 0.0), kDepth - 1).x, kDepth);
}

Model skinned_pair() {
  Model model = two_nodes(slide(Channel::Interpolation::kLinear));
  Primitive primitive;
  primitive.positions = {Vec3f(0, 0, 0), Vec3f(2, 0, 0)};
  primitive.normals.assign(2, Vec3f(0, 1, 0));
  primitive.joints = {{0, 0, 0, 0}, {0, 1, 0, 0}};
  primitive.weights = {Vec4f(1, 0, 0, 0), Vec4f(0.5f, 0.5f, 0, 0)};
  for (const Vec3f& p : primitive.positions) primitive.bounds.add(Vec3(p));
  Mesh mesh;
  mesh.primitives.push_back(primitive);
  model.meshes.push_back(mesh);
  Mat4 inverse(1.0);
  inverse[3] = Vec4(-1, 0, 0, 1);
  model.skins.push_back({"skin", {0, 1}, {Mat4(1.0), inverse}});
  model.nodes.emplace_back();
  model.nodes[2].mesh = 0;
  model.nodes[2].skin = 0;
  model.nodes[2].translation_m = Vec3(1000, 0, 0);  // ignored: the joints place a skinned mesh
  model.roots = {0, 2};
  return model;
}

TEST(Animation, JointMatricesAreTheIdentityInTheBindPose) {
  const Model model = skinned_pair();
  for (const Mat4& m : joint_matrices(model, evaluate_pose(model, -1, 0.0), 0))
    EXPECT_EQ(m, Mat4(1.0));
}

TEST(Animation, BoundsFollowTheSkin) {
  Model model = skinned_pair();
  EXPECT_EQ(model_bounds(model, evaluate_pose(model, -1, 0.0)).max, Vec3(2, 0, 0));
  model.nodes[1].translation_m = Vec3(1.0, 6.0, 0.0);  // the second joint, half of vertex 1
  EXPECT_EQ(model_bounds(model, evaluate_pose(model, -1, 0.0)).max, Vec3(2, 3, 0));
}

TEST(Animation, MorphWeightsComeFromMeshNodeOrClipAndMoveTheBounds) {
  Channel channel;
  channel.path = Channel::Path::kWeights;
  channel.width = 2;
  channel.times_s = {0.0f, 1.0f};
  channel.values = {0, 0, 1, 0.5f};
  Model model = two_nodes(channel);
  Primitive primitive;
  primitive.positions = {Vec3f(0.0f)};
  primitive.targets.resize(2);
  primitive.targets[0].positions = {Vec3f(4, 0, 0)};
  primitive.targets[1].positions = {Vec3f(0, 8, 0)};
  Mesh mesh;
  mesh.primitives = {primitive};
  mesh.weights = {0.25f, 0.0f};
  model.meshes = {mesh};
  model.nodes[0].mesh = 0;
  EXPECT_EQ(model_bounds(model, evaluate_pose(model, -1, 0.0)).max, Vec3(1, 0, 0));
  EXPECT_EQ(model_bounds(model, evaluate_pose(model, 0, 0.5)).max, Vec3(2, 2, 0));
  model.nodes[0].weights = {0.0f, 1.0f};
  EXPECT_EQ(model_bounds(model, evaluate_pose(model, -1, 0.0)).max, Vec3(0, 8, 0));
}

TEST(Animation, BoundsOfTooManyVerticesStayTrue) {
  Model model = skinned_pair();
  Primitive& primitive = model.meshes[0].primitives[0];
  primitive.positions.assign(100000, Vec3f(2, 0, 0));
  primitive.joints.assign(100000, {0, 1, 0, 0});
  primitive.weights.assign(100000, Vec4f(0.5f, 0.5f, 0, 0));
  const Node node = model.nodes[2];
  for (int i = 0; i < 60; ++i) {  // 6 million vertices in all
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
  }
  const Bounds bounds = model_bounds(model, evaluate_pose(model, -1, 0.0));
  EXPECT_LE(bounds.min.x, 2.0);
  EXPECT_GE(bounds.max.x, 2.0);
}

TEST(Animation, BoundsContainEveryInstance) {
  Model model;
  Primitive primitive;
  primitive.positions = {Vec3f(-1, 0, 0), Vec3f(1, 0, 0)};
  for (const Vec3f& p : primitive.positions) primitive.bounds.add(Vec3(p));
  Mesh mesh;
  mesh.primitives = {primitive};
  model.meshes = {mesh};
  model.nodes.resize(1);
  model.nodes[0].mesh = 0;
  model.roots = {0};
  for (const double x : {-5.0, 7.0}) {
    Mat4 m(1.0);
    m[3] = Vec4(x, 0, 0, 1);
    model.nodes[0].instances.push_back(m);
  }
  const Bounds bounds = model_bounds(model, evaluate_pose(model, -1, 0.0));
  EXPECT_EQ(bounds.min.x, -6.0);
  EXPECT_EQ(bounds.max.x, 8.0);
}

}  // namespace
}  // namespace neritic::scene
