// The limbs of a diver who swims elsewhere: drawn as samples of the joints say, smoothly between
// them, and by the model's clip where nothing is known.
#include "diver/frames.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/simulation/saved_state.hpp"
#include "tests/testbed/simulation/capture.hpp"

namespace neritic::testbed {
namespace {

std::string elsewhere_text(const std::string& keys) {
  return std::string(kStillWater) + "[[objects]]\nname = \"eve\"\nposition_m = [0, -5, 0]\n" + keys;
}
std::string diver_model() {
  return "model = \"" + (test::source_dir() / "assets/models/diver.glb").string() + "\"\n";
}
const std::string kLimbs = "inputs = { pose = \"network\" }\n";

double angle_rad(const Quat& a, const Quat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

// A kick of a cycle a second from the hip, 0.5 rad.
diver::JointRotations kicking(double t) {
  auto joints = diver::straight_joints();
  const double hip_rad = 0.5 * std::sin(2.0 * kPi * t);
  joints[diver::joint_of(diver::kLeftUpperLeg)] = glm::angleAxis(hip_rad, Vec3(0, 1, 0));
  joints[diver::joint_of(diver::kRightUpperLeg)] = glm::angleAxis(-hip_rad, Vec3(0, 1, 0));
  return joints;
}

struct Elsewhere {
  Elsewhere()
      : scene(load_text(elsewhere_text(diver_model() + kLimbs)).value()),
        live(LivePhysics::create(scene, LivePhysics::Pace::kPicture).value()),
        source(live->inbox().open("network").value()) {}
  void tell(double now_s, double captured_s, bool posed = true) {
    const auto push = [&](const char* stream, const Payload& payload, std::uint64_t& sequence) {
      EXPECT_EQ(
          live->inbox().push({{live->world().streams().find(stream).value(), source, sequence++,
                               std::llround(1e9 * captured_s), std::llround(1e9 * now_s)},
                              payload}),
          SampleVerdict::kAccepted);
    };
    if (posed) push("eve/pose", at({0, -6, captured_s}), poses);
    push("eve/joints", BodyJoints{kicking(captured_s)}, postures);
  }
  // The rotation of a node of the model, if samples move it.
  std::optional<Quat> drawn(diver::Segment segment, double t) const {
    const scene::Model& model = *scene.models.at(0);
    const auto pose = live->motion().model_pose(0, model, t);
    if (!pose) return std::nullopt;
    const int node = live->world().objects()[0].joints.nodes.at(segment);
    const auto parent = model.nodes[static_cast<std::size_t>(node)].parent;
    const auto rotation = [&](int i) {
      return glm::normalize(
          glm::quat_cast(Mat3(pose->model_from_node.at(static_cast<std::size_t>(i)))));
    };
    return glm::conjugate(rotation(parent)) * rotation(node);
  }
  scene::Scene scene;
  std::unique_ptr<LivePhysics> live;
  SourceId source;
  std::uint64_t poses = 0, postures = 0;
};

TEST(LimbsFromElsewhere, TheDrawnLimbsAreTheTrueOnesBetweenSamplesOfSixtyAHertz) {
  Elsewhere there;
  constexpr double kLatency_s = 0.02;
  there.live->follow(0, 0.05);
  EXPECT_FALSE(there.drawn(diver::kLeftUpperLeg, 0.05)) << "before any sample its clip moves it";
  double worst_rad = 0.0;
  for (int i = 6; i < 120; ++i) {
    const double now_s = i / 60.0;
    there.live->follow(0, now_s - 1e-6);
    there.tell(now_s, now_s - kLatency_s);
    if (i < 10) continue;
    for (const double t : {now_s - 0.3 / 240.0, now_s - 0.008}) {
      const auto seen = there.drawn(diver::kLeftUpperLeg, t);
      ASSERT_TRUE(seen);
      const auto true_joints = diver::standing_joints(
          kicking(t), there.live->world().objects()[0].joints.arms_spread_rad);
      worst_rad =
          std::max(worst_rad, angle_rad(*seen, true_joints[diver::joint_of(diver::kLeftUpperLeg)]));
    }
  }
  // Its angular acceleration over the latency and an interval: 20 rad/s^2 * (0.037 s)^2.
  EXPECT_LT(worst_rad, 0.03);
  EXPECT_GT(worst_rad, 1e-4);
}

TEST(LimbsFromElsewhere, ADiverWhoFallsSilentRestsAndLimbsAloneMoveNobody) {
  Elsewhere there;
  there.live->follow(0, 0.1);
  there.tell(0.1, 0.1, false);
  there.live->follow(0, 0.2);
  EXPECT_FALSE(there.drawn(diver::kLeftUpperLeg, 0.2)) << "nothing placed her";
  for (int i = 12; i < 30; ++i) {
    there.live->follow(0, i / 60.0 - 1e-6);
    there.tell(i / 60.0, i / 60.0);
  }
  const auto leg = [&](double t) {
    there.live->follow(0, t);
    return there.drawn(diver::kLeftUpperLeg, t);
  };
  const auto last = leg(0.7), later = leg(0.9);
  ASSERT_TRUE(last && later);
  EXPECT_LT(angle_rad(*last, *later), 1e-6) << "a tenth of a second after the last sample";
  const auto silent = leg(3.0);
  EXPECT_TRUE(silent) << "who is lost keeps her last posture where she is";
}

TEST(LimbsFromElsewhere, ASavedStateKeepsThemAndTheHashSeesThem) {
  const auto end_of = [](bool restored) {
    Elsewhere there;
    for (int i = 1; i < 40; ++i) {
      there.live->follow(0, i / 60.0 - 1e-6);
      there.tell(i / 60.0, i / 60.0);
      if (!restored || i != 20) continue;
      const StateFormat format = there.live->world().state_format();
      const auto bytes = encode_state(format, saved_state(there.live->simulation(), format));
      EXPECT_TRUE(there.live->go_to(parse_state(format, bytes, "it").value()).ok());
      there.tell(i / 60.0, i / 60.0);  // what waited is dropped
    }
    return there.live->newest().hash;
  };
  EXPECT_EQ(end_of(false), end_of(false));
  EXPECT_EQ(end_of(false), end_of(true));
  Elsewhere still;
  still.live->follow(0, 39 / 60.0 - 1e-6);
  EXPECT_NE(end_of(false), still.live->newest().hash);
}

TEST(LimbsFromElsewhere, OnlyAModelOfADiverHasThem) {
  const auto limbs_of = [](const std::string& text) {
    const auto world = PhysicsWorld::create(load_text(text).value()).value();
    return world->streams().find("eve/joints").has_value();
  };
  EXPECT_FALSE(limbs_of(elsewhere_text("shape = \"box\"\nsize_m = [1, 1, 1]\n" + kLimbs)));
  EXPECT_TRUE(limbs_of(elsewhere_text(diver_model() + kLimbs)));
}

}  // namespace
}  // namespace neritic::testbed
