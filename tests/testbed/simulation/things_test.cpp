// Things that a gripper holds, carries, drops and hands over; and the wash that pushes a diver.
#include "testbed/simulation/things.hpp"

#include "testbed/simulation/output_samples.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// A thing; keys of its table.
std::string thing_text(const std::string& at, const std::string& keys) {
  return "[[objects]]\nname = \"tool\"\nclass = \"target\"\nshape = \"sphere\"\nradius_m = "
         "0.05\nposition_m = " +
         at + "\nthing = { " + keys + " }\n";
}

constexpr const char* kGripper =
    "gripper = { position_m = [0, 0, -0.45], reach_m = 0.12 }\nnavigation = \"truth\"\n";

void grip(TestDive& dive, const std::string& stream, GripChoice choice) {
  EXPECT_TRUE(send(*dive.simulation, dive.world->streams().find(stream).value(), GripUse{choice}));
}

Vec3 tool_place(const TestDive& dive) {
  return dive.state().objects()[0].motion.pose.position_m;
}

TEST(SceneThing, AFreeOneFallsAsItsClosedFormAndRestsOnTheFloor) {
  // 2 kg, 1 l, C_d A 0.01 m^2.
  TestDive dive = dive_of(
      kStillWater + thing_text("[0, -2, 0]", "mass_kg = 2, volume_l = 1, drag_area_m2 = 0.01") +
      "[[objects]]\nname = \"floor\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [40, "
      "40]\nposition_m = [0, -8, 0]\n");
  const double net_n = (2.0 - 1.028) * 9.80665, moving_kg = 2.0 + 0.514;
  const double terminal = std::sqrt(2.0 * net_n / (1028.0 * 0.01)),
               tau = moving_kg * terminal / net_n;
  dive.run(1.0);
  EXPECT_NEAR(-dive.state().objects()[0].motion.velocity_m_s.y, terminal * std::tanh(1.0 / tau),
              0.01 * terminal);
  EXPECT_NEAR(-2.0 - tool_place(dive).y, terminal * tau * std::log(std::cosh(1.0 / tau)), 0.02);
  dive.run(10.0);
  // On the floor, by the radius of a ball of a litre.
  EXPECT_NEAR(tool_place(dive).y, -8.0 + std::cbrt(0.75e-3 / kPi), 0.02);
  EXPECT_LT(glm::length(dive.state().objects()[0].motion.velocity_m_s), 0.02);
}

TEST(SceneThing, ABuoyantOneRisesAndFloatsAtTheSurface) {
  // Half as heavy as its water: it floats half under, so that its middle is at the surface.
  TestDive dive = dive_of(kStillWater + thing_text("[0, -2, 0]",
                                                   "mass_kg = 0.514, volume_l = 1, "
                                                   "drag_area_m2 = 0.01"));
  dive.run(20.0);
  EXPECT_NEAR(tool_place(dive).y, 0.0, 0.03);
  EXPECT_LT(glm::length(dive.state().objects()[0].motion.velocity_m_s), 0.2);
}

// As a task that moves its rack does: once nobody tells its place any more, it lies there.
TEST(SceneThing, ARackedOneLiesWhereItWasPlaced) {
  TestDive dive = dive_of(
      kStillWater + thing_text("[0, -10, -0.5]", "mass_kg = 1.5, volume_l = 0.5, racked = true"));
  ObjectPose there;
  there.world_from_object.position_m = Vec3(4.0, -9.0, 1.0);
  const auto say = [&](PayloadKind kind, const Payload& payload) {
    EXPECT_TRUE(
        send(*dive.simulation, dive.world->streams().id(OwnerSort::kObject, 0, kind), payload));
  };
  const auto acts = [&](Authority who) {
    return hand_over(0, who, dive.simulation->inbox().open("test").value());
  };
  say(PayloadKind::kEvent, acts(Authority::kLive));
  say(PayloadKind::kObjectPose, there);
  dive.run(0.1);
  say(PayloadKind::kEvent, acts(Authority::kAutopilot));
  dive.run(5.0);
  EXPECT_LT(glm::distance(tool_place(dive), Vec3(4.0, -9.0, 1.0)), 1e-9);
}

TEST(SceneThing, ARackedOneStaysAndAGripperThatClosesTakesItsWeight) {
  const std::string text =
      kStillWater +
      rov_text(std::string("position_m = [0, -10, 0]\nmission = { hold = \"station\" }\n") +
               kGripper) +
      thing_text("[0, -10, -0.5]", "mass_kg = 1.5, volume_l = 0.5, racked = true");
  TestDive dive = dive_of(text);
  dive.run(3.0);
  EXPECT_EQ(tool_place(dive), Vec3(0.0, -10.0, -0.5));
  EXPECT_EQ(dive.state().things()[0].holder, 0u);
  grip(dive, "rov/grip", GripChoice::kClose);
  dive.run(25.0);
  EXPECT_EQ(dive.state().things()[0].holder, 1u);
  // It hangs in the gripper, its weight in water pulls, and the ROV still holds its depth.
  const Motion at = dive.world->things().grip_motion(0, dive.world->humans(), dive.state());
  EXPECT_LT(glm::distance(tool_place(dive), at.pose.position_m), 1e-9);
  EXPECT_NEAR(dive.state().grips()[0].load_n, (1.5 - 0.514) * 9.80665, 0.6);
  EXPECT_NEAR(dive.pose().position_m.y, -10.0, 0.1);
  const GripReading told =
      grip_reading(dive.world->things(), 0, dive.world->humans(), dive.state());
  EXPECT_EQ(told.held, 1u);
  EXPECT_LT(told.nearest_m, 1e-6);
  grip(dive, "rov/grip", GripChoice::kOpen);
  dive.run(2.0);
  EXPECT_EQ(dive.state().things()[0].holder, 0u);
  EXPECT_EQ(dive.state().grips()[0].drops, 1u);
  EXPECT_LT(tool_place(dive).y, -10.5);
}

// A gripper that meets a thing at a quarter of a metre a second feels the same jolt at any step.
TEST(SceneThing, AJoltDoesNotDependOnTheStep) {
  std::vector<double> most_n;
  for (const char* rate_hz : {"60", "240", "1000"}) {
    TestDive dive = dive_of(std::string("[physics]\nrate_hz = ") + rate_hz + "\n" +
                            rov_text(std::string("position_m = [0, -10, 0]\n") + kGripper) +
                            thing_text("[0, -10, -0.62]", "mass_kg = 4, volume_l = 3.9"));
    PhysicsState state = dive.world->start();
    state.vehicles()[0].body.velocity = rov::vec6(Vec3(0.25, 0.0, 0.0), Vec3(0.0));
    PhysicsInputs inputs = dive.world->start_inputs();
    inputs.grips()[0].use.choice = GripChoice::kClose;
    const double step_s = dive.world->step_s();
    most_n.push_back(0.0);
    for (std::uint64_t step = 0; step_s * static_cast<double>(step) < 2.0; ++step) {
      state = dive.world->step(state, inputs, {step, step_s});
      most_n.back() = std::max(most_n.back(), state.grips()[0].load_n);
    }
    EXPECT_EQ(state.things()[0].holder, 1u);
    EXPECT_EQ(state.grips()[0].drops, 0u);
  }
  // 6 kg with its added mass, brought to some 0.15 m/s within 20 ms.
  EXPECT_GT(most_n[1], 20.0);
  EXPECT_NEAR(most_n[0], most_n[1], 0.4 * most_n[1]);
  EXPECT_NEAR(most_n[2], most_n[1], 0.15 * most_n[1]);
}

TEST(SceneThing, AGrabKeepsTheMomentumOfBoth) {
  // Without drag of the thing or weight of either; an ROV that drifts onto it.
  TestDive dive =
      dive_of(kStillWater + rov_text(std::string("position_m = [0, -10, 0]\n") + kGripper) +
              thing_text("[0, -10, -0.62]",
                         "mass_kg = 4, volume_l = 3.8910505836575875, drag_area_m2 = 0"));
  PhysicsState state = dive.world->start();
  state.vehicles()[0].body.velocity = rov::vec6(Vec3(0.2, 0.0, 0.0), Vec3(0.0));
  PhysicsInputs inputs = dive.world->start_inputs();
  inputs.grips()[0].use.choice = GripChoice::kClose;
  const double step_s = dive.world->step_s();
  std::uint64_t step = 0;
  double before = 0.0, after = 0.0;
  const double rov_kg = 13.5 + 6.36;  // with added mass, along (rov/bluerov2.cpp)
  for (; step < 480 && state.things()[0].holder == 0; ++step) {
    before = rov_kg * state.vehicles()[0].body.velocity[0];
    state = dive.world->step(state, inputs, {step, step_s});
  }
  ASSERT_EQ(state.things()[0].holder, 1u);
  const double moving_kg = 4.0 + 0.5 * 1028.0 * 3.8910505836575875e-3;
  after = rov_kg * state.vehicles()[0].body.velocity[0] -
          moving_kg * state.objects()[0].motion.velocity_m_s.z;
  EXPECT_NEAR(after, before, 0.02 * before);  // its drag in a step is small
  EXPECT_LT(state.vehicles()[0].body.velocity[0], 0.17);
}

TEST(SceneThing, ADiversHandTakesWhatTheGripperHoldsOut) {
  // The ROV faces the diver's right hand from the north, the tool in its gripper.
  TestDive dive = dive_of(
      kStillWater +
      diver_text(std::string(kProne) + "position_m = [0, -10, 0]\nhands = { reach_m = 0.15 }\n") +
      rov_text(std::string("position_m = [0.25, -10.2, -1.15]\nyaw_deg = 180\nmission = { hold = "
                           "\"station\" }\n") +
               kGripper) +
      thing_text("[0.25, -10.2, -0.7]", "mass_kg = 0.6, volume_l = 0.5"));
  grip(dive, "rov/grip", GripChoice::kClose);
  dive.run(10.0);
  EXPECT_EQ(dive.state().things()[0].handovers, 1u);
  ASSERT_NE(dive.state().things()[0].holder, 0u);
  const std::size_t holder = dive.state().things()[0].holder - 1;
  EXPECT_EQ(dive.world->things().grips()[holder].sort, OwnerSort::kDiver);
  EXPECT_LT(
      glm::distance(tool_place(dive), dive.world->things()
                                          .grip_motion(holder, dive.world->humans(), dive.state())
                                          .pose.position_m),
      1e-9);
  EXPECT_EQ(dive.state().grips()[0].drops + dive.state().grips()[1].drops, 0u);
}

TEST(SceneThing, IsSavedAndTheSameOnAnyNumberOfThreads) {
  const std::string text =
      kStillWater +
      rov_text(
          std::string("position_m = [0, -10, 0]\nmission = { hold = \"station\" }\nwash = {}\n") +
          kGripper) +
      thing_text("[0, -10, -0.5]", "mass_kg = 1.5") +
      diver_text(std::string(kProne) + "position_m = [3, -10, 0]\n");
  TestDive dive = dive_of(text);
  const auto threaded = dive.world->simulation({}, 3);
  grip(dive, "rov/grip", GripChoice::kClose);
  EXPECT_TRUE(
      send(*threaded, dive.world->streams().find("rov/grip").value(), GripUse{GripChoice::kClose}));
  dive.run(2.0);
  threaded->advance(480);
  EXPECT_EQ(dive.state().things()[0].holder, 1u);
  EXPECT_EQ(threaded->newest().hash, dive.simulation->newest().hash);
  const StateFormat format = dive.world->state_format();
  const auto saved =
      parse_state(format, encode_state(format, saved_state(*dive.simulation, format)), "a");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  TestDive other = dive_of(text);
  restore_state(*other.simulation, *saved);
  dive.run(1.0), other.run(1.0);
  EXPECT_EQ(dive.simulation->newest().hash, other.simulation->newest().hash);
}

TEST(SceneThing, ExtremesStayFinite) {
  for (const char* keys : {"mass_kg = 1e-9, volume_l = 0, drag_area_m2 = 100",
                           "mass_kg = 10000, volume_l = 10000, drag_area_m2 = 0",
                           "mass_kg = 1e-9, volume_l = 10000, drag_area_m2 = 0.01"}) {
    TestDive dive =
        dive_of(kStillWater + rov_text(std::string("position_m = [0, -10, 0]\n") + kGripper) +
                thing_text("[0, -10, -0.5]", keys));
    grip(dive, "rov/grip", GripChoice::kClose);
    dive.run(3.0);
    EXPECT_TRUE(sim::all_finite(dive.state())) << keys;
    EXPECT_LT(dive.speed_m_s(), 20.0) << keys;
  }
}

TEST(SceneWash, AThrusterBlowsADiverAway) {
  // The ROV faces north and pushes itself south: the jets of its front thrusters leave to the
  // north-west and north-east. The diver is 1.9 m away in the former.
  const auto text = [](const char* wash) {
    return kStillWater + diver_text(std::string(kProne) + "position_m = [-1.2, -10, 1.13]\n") +
           rov_text(std::string("position_m = [0, -10, 2.6]\n") + wash);
  };
  TestDive with = dive_of(text("wash = {}\n")), without = dive_of(text(""));
  for (TestDive* dive : {&with, &without})
    EXPECT_TRUE(
        pilot(*dive, 0, {.pilot = rov::vec6(Vec3(-60.0, 0.0, 0.0), Vec3(0.0)), .piloted = 1}));
  with.run(3.0), without.run(3.0);
  const auto place = [](const TestDive& dive) {
    return dive.state().humans()[0].human.root.position_ned_m;
  };
  const Vec3 blown = place(with) - place(without);
  EXPECT_GT(glm::dot(blown, glm::normalize(Vec3(1.0, -1.0, 0.0))), 0.03);
  // Far from anything solid the vehicle itself moves as without.
  EXPECT_EQ(with.state().vehicles()[0].body.position_ned_m,
            without.state().vehicles()[0].body.position_ned_m);
}

}  // namespace
}  // namespace neritic::testbed
