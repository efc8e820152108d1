// A person's recorded motion drives the 16 segments: a walk by subject 02 of the CMU Graphics Lab
// Motion Capture Database (ASF and AMC, 120 Hz). Its joints, put on our body of the same leg
// length: bones keep their length, the foot on the ground stays, strides have a walker's rate, in
// air limbs change no momentum, and under water they move a person by a person's strength.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "diver/anthropometry.hpp"
#include "engine/core/files.hpp"
#include "engine/sim/fields.hpp"
#include "tests/diver/bodies.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

constexpr double kWalk_hz = 120.0;
constexpr double kAsfUnit_m = 0.0254 / 0.45;

struct AsfBone {
  std::string parent, dofs;  // "rx", "ry", "rz" one after the other
  Vec3 direction{0.0}, axis_deg{0.0};
  double length = 0.0;
};

// About x, then y, then z: as both files mean it.
Quat turned(const Vec3& deg) {
  return glm::angleAxis(radians(deg.z), Vec3(0, 0, 1)) *
         glm::angleAxis(radians(deg.y), Vec3(0, 1, 0)) *
         glm::angleAxis(radians(deg.x), Vec3(1, 0, 0));
}

std::map<std::string, AsfBone> read_asf(const std::string& text) {
  std::map<std::string, AsfBone> bones;
  std::istringstream lines(text);
  std::string line, name;
  bool hierarchy = false;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == ":hierarchy") hierarchy = true;
    if (key.empty() || key[0] == ':' || key == "begin" || key == "end") continue;
    if (name.empty() && key != "name") continue;  // units, the root
    if (hierarchy) {
      for (std::string child; words >> child;) bones[child].parent = key;
    } else if (key == "name") {
      words >> name;
    } else if (key == "direction" || key == "axis") {
      Vec3& to = key == "axis" ? bones[name].axis_deg : bones[name].direction;
      words >> to.x >> to.y >> to.z;
    } else if (key == "length") {
      words >> bones[name].length;
    } else if (key == "dof") {
      for (std::string dof; words >> dof;) bones[name].dofs += dof;
    }
  }
  return bones;
}

struct AmcFrame {
  Vec3 root_m{0.0};
  Quat root{1.0, 0.0, 0.0, 0.0};
  std::map<std::string, Vec3> deg;
};

std::vector<AmcFrame> read_amc(const std::string& text,
                               const std::map<std::string, AsfBone>& bones) {
  std::vector<AmcFrame> frames;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key.empty() || key[0] == '#' || key[0] == ':') continue;
    if (std::isdigit(static_cast<unsigned char>(key[0]))) {
      frames.emplace_back();
    } else if (key == "root") {
      Vec3 at, deg;
      words >> at.x >> at.y >> at.z >> deg.x >> deg.y >> deg.z;
      frames.back().root_m = kAsfUnit_m * at;
      frames.back().root = turned(deg);
    } else {
      Vec3& deg = frames.back().deg[key];
      const std::string& dofs = bones.at(key).dofs;
      for (std::size_t i = 1; i < dofs.size(); i += 2) words >> deg[dofs[i] - 'x'];
    }
  }
  return frames;
}

// The shortest turn of one direction into another.
Quat between(const Vec3& from, const Vec3& to) {
  const Vec3 axis = glm::cross(from, to);
  return glm::normalize(Quat(1.0 + glm::dot(from, to), axis.x, axis.y, axis.z));
}

struct Walk {
  std::map<std::string, AsfBone> bones;
  std::vector<AmcFrame> frames;

  Quat world_from(const AmcFrame& frame, const std::string& name) const {
    if (name == "root") return frame.root;
    const AsfBone& bone = bones.at(name);
    const Quat axis = turned(bone.axis_deg);
    const auto deg = frame.deg.find(name);
    const Quat local = deg == frame.deg.end() ? Quat(1.0, 0.0, 0.0, 0.0) : turned(deg->second);
    return world_from(frame, bone.parent) * axis * local * glm::conjugate(axis);
  }
  double leg_m() const {
    return kAsfUnit_m * (bones.at("lfemur").length + bones.at("ltibia").length);
  }
};

Walk read_walk(const std::filesystem::path& folder) {
  Walk walk;
  walk.bones = read_asf(read_text(folder / "02.asf").value());
  walk.frames = read_amc(read_text(folder / "02_01.amc").value(), walk.bones);
  return walk;
}

constexpr const char* kBoneOfSegment[kSegments] = {
    "root",    "lowerback", "thorax", "head",   "lhumerus", "lradius", "lwrist", "rhumerus",
    "rradius", "rwrist",    "lfemur", "ltibia", "lfoot",    "rfemur",  "rtibia", "rfoot"};

// Our axes of a segment (to the head, to the right, to the front) in theirs (x left, y up, z
// front).
const Quat kTheirsFromSegment = glm::quat_cast(Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)));
// North is where they walk.
const Quat kNedFromTheirs =
    glm::quat_cast(glm::transpose(Mat3(Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, -1, 0))));

struct WalkPose {
  Vec3 hips_ned_m{0.0};
  Quat ned_from_body{1.0, 0.0, 0.0, 0.0};
  JointRotations joints;
};

WalkPose pose_of(const Walk& walk, const AmcFrame& frame) {
  WalkPose out;
  std::array<Quat, kSegments> attitudes;
  for (std::size_t i = 0; i < kSegments; ++i) {
    const std::string name = kBoneOfSegment[i];
    // Their bones as they stand; ours hang straight, with toes to the front.
    Quat stands(1.0, 0.0, 0.0, 0.0);
    const bool foot = i == kLeftFoot || i == kRightFoot;
    if (i >= kLeftUpperArm)
      stands = between(foot ? Vec3(0, 0, 1) : Vec3(0, -1, 0),
                       glm::normalize(walk.bones.at(name).direction));
    attitudes[i] = kNedFromTheirs * walk.world_from(frame, name) * stands * kTheirsFromSegment;
  }
  out.ned_from_body = attitudes[kPelvis];
  out.joints = rotations_of(attitudes);
  Vec3 hips = frame.root_m;
  for (const char* hip : {"lhipjoint", "rhipjoint"}) {
    const AsfBone& bone = walk.bones.at(hip);
    hips += frame.root * (0.5 * kAsfUnit_m * bone.length * bone.direction);
  }
  out.hips_ned_m = kNedFromTheirs * hips;
  return out;
}

Body walker(const Walk& walk, double water_kg_m3) {
  BodyParameters p;
  p.gear = no_gear();
  p.water_kg_m3 = water_kg_m3;
  const Body as_tables = make_body(p).value();
  const double leg_m = std::abs(as_tables.segments[kLeftLowerLeg].joint_m.x) +
                       std::abs(as_tables.segments[kLeftFoot].joint_m.x);
  p.build.height_m *= walk.leg_m() / leg_m;
  return make_body(p).value();
}

class RecordedWalk : public testing::Test {
 protected:
  void SetUp() override {
    NERITIC_REQUIRE_SHARED(shared);
    walk_ = read_walk(shared / "data" / "recordings" / "mocap_walk");
    ASSERT_EQ(walk_.frames.size(), 343u);
    ASSERT_EQ(walk_.bones.size(), 30u);
  }
  Walk walk_;
};

TEST_F(RecordedWalk, BonesKeepTheirLengthAndTheFootOnTheGroundItsPlace) {
  const Body body = walker(walk_, 0.0);
  std::array<std::vector<Vec3>, 2> ankles;
  for (const AmcFrame& frame : walk_.frames) {
    const WalkPose pose = pose_of(walk_, frame);
    const Posture posture = posture_of(body, pose.joints, {});
    for (std::size_t i = 1; i < kSegments; ++i)
      ASSERT_NEAR(glm::distance(posture[i].origin_m, posture[kParent[i]].origin_m),
                  glm::length(body.segments[i].joint_m), 1e-6);
    const Segment feet[] = {kLeftFoot, kRightFoot};
    for (int side = 0; side < 2; ++side)
      ankles[static_cast<std::size_t>(side)].push_back(
          pose.hips_ned_m + pose.ned_from_body * posture[feet[side]].origin_m);
  }
  for (const std::vector<Vec3>& ankle : ankles) {
    // On the ground: where the ankle moves at less than 0.25 m/s.
    std::size_t longest = 0, best = 0, run = 0;
    for (std::size_t i = 1; i < ankle.size(); ++i) {
      run = glm::distance(ankle[i], ankle[i - 1]) * kWalk_hz < 0.25 ? run + 1 : 0;
      if (run > longest) longest = run, best = i;
    }
    EXPECT_GT(longest / kWalk_hz, 0.25);  // a stance
    EXPECT_LT(longest / kWalk_hz, 0.9);
    double drift_m = 0.0;
    for (std::size_t i = best - longest; i <= best; ++i)
      drift_m = std::max(drift_m, glm::distance(ankle[i], ankle[best - longest / 2]));
    EXPECT_LT(drift_m, 0.03);
    // Between two stances it goes a stride.
    const double way_m = glm::distance(ankle.back(), ankle.front());
    EXPECT_GT(way_m, 2.0);
  }
  // Left and right are half a stride apart: a stride takes as long as the way between the feet to
  // come back.
  std::vector<double> apart;
  for (std::size_t i = 0; i < ankles[0].size(); ++i)
    apart.push_back(ankles[0][i].x - ankles[1][i].x);
  double best = -1.0, stride_s = 0.0;
  for (std::size_t lag = 60; lag < 220; ++lag) {
    double sum = 0.0, a = 0.0, b = 0.0;
    for (std::size_t i = 0; i + lag < apart.size(); ++i) {
      sum += apart[i] * apart[i + lag];
      a += apart[i] * apart[i];
      b += apart[i + lag] * apart[i + lag];
    }
    if (sum / std::sqrt(a * b) <= best) continue;
    best = sum / std::sqrt(a * b);
    stride_s = static_cast<double>(lag) / kWalk_hz;
  }
  EXPECT_GT(best, 0.95);
  EXPECT_NEAR(stride_s, 1.1, 0.2);
}

TEST_F(RecordedWalk, InAirItsLimbsChangeNoMomentum) {
  const Body body = without_drag(walker(walk_, 0.0));
  const double kg = dry_mass(body);
  RootState root;
  LimbState limbs;
  root.attitude = pose_of(walk_, walk_.frames[0]).ned_from_body;
  limbs.rotation = pose_of(walk_, walk_.frames[0]).joints;
  const GasLoad load;
  const double dt = 1.0 / kWalk_hz;
  double fastest = 0.0;
  for (std::size_t i = 0; i < walk_.frames.size(); ++i) {
    const LimbState before = limbs;
    follow_limbs(limbs, pose_of(walk_, walk_.frames[i]).joints, dt);
    move_root(body, root, before, limbs, load, Vec3(0.0), dt);
    for (const Vec3& rate : limbs.rate) fastest = std::max(fastest, glm::length(rate));
    const double fell_s = static_cast<double>(i + 1) * dt;
    const WorldMomentum m = world_momentum(body, root, limbs, load, root.position_ned_m);
    ASSERT_NEAR(m.linear_ned.z, kg * kGravity_m_s2 * fell_s, 1e-6 * kg * kGravity_m_s2);
    ASSERT_LT(std::hypot(m.linear_ned.x, m.linear_ned.y), 1e-8);
  }
  EXPECT_GT(fastest, 2.0);  // knees of a walker: some 5 rad/s
  EXPECT_LT(fastest, 12.0);
}

TEST_F(RecordedWalk, UnderWaterItMovesThePersonByAPersonsStrength) {
  const Body body = walker(walk_, 1025.0);
  const WalkPose first = pose_of(walk_, walk_.frames[0]);
  HumanState state = start_at(body, {0.0, 0.0, 5.0}, first.ned_from_body, first.joints);
  HumanInputs inputs;
  double most_w = 0.0;
  for (const AmcFrame& frame : walk_.frames) {
    inputs.joints = pose_of(walk_, frame).joints;
    state = step(body, state, inputs, 1.0 / kWalk_hz);
    ASSERT_TRUE(sim::all_finite(state));
    most_w = std::max(most_w, state.life.limb_power_w);
  }
  EXPECT_EQ(state.far_joints, 0u);
  EXPECT_GT(glm::length(state.root.position_ned_m - Vec3(0.0, 0.0, 5.0)), 0.02);
  EXPECT_LT(glm::length(state.root.velocity.linear()), 1.5);
  EXPECT_GT(most_w, 5.0);
  EXPECT_LT(most_w, 300.0);
}

}  // namespace
}  // namespace neritic::diver
