// A World: what programs outside see of a scene, in ROS conventions, and what they can do to it.
#include "testbed/world/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "testbed/motion/live_physics.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

std::string assets(const char* path) {
  return (test::source_dir() / "assets" / path).string();
}

// One vehicle with all its sensors that faces east at 6 m, and a box that devices move.
std::string scene_text(const std::string& dynamics = "bluerov2_heavy_survey_dynamics") {
  return "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"" +
         assets(("vehicles/" + dynamics + ".toml").c_str()) +
         "\"\nposition_m = [2, -6, -3]\nrotation_xyzw = [0, -0.7071067811865476, 0, "
         "0.7071067811865476]\n";
}

class WorldTest : public testing::Test {
 protected:
  std::unique_ptr<World> open(const WorldOptions& options = {},
                              const char* dynamics = "bluerov2_heavy_survey_dynamics") const {
    EXPECT_TRUE(write_text(scratch_ / "s.toml", scene_text(dynamics)).ok());
    auto world = World::open(scratch_ / "s.toml", options);
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
    return std::move(world).value();
  }
  static Reading newest(const World& world, const std::string& name) {
    return world.newest()[world.stream(name).value()];
  }
  const test::ScratchFolder scratch_;
};

TEST_F(WorldTest, SaysWhereAVehicleIsInEastNorthUp) {
  const auto world = open();
  const Truth truth = world->truth("rov").value();
  // x east, y north (world z is south), z up.
  EXPECT_NEAR(truth.position[0], 2.0, 1e-12);
  EXPECT_NEAR(truth.position[1], 3.0, 1e-12);
  EXPECT_NEAR(truth.position[2], -6.0, 1e-12);
  // It faces east, which is yaw 0: forward is x.
  EXPECT_NEAR(std::abs(truth.orientation[3]), 1.0, 1e-9);
}

TEST_F(WorldTest, AVehicleAtRestFeelsGravityUpward) {
  const auto world = open();
  ASSERT_TRUE(world->tick(24).ok());
  const Reading imu = newest(*world, "rov/imu");
  ASSERT_EQ(imu.count, 6u);
  EXPECT_NEAR(imu.values[5], 9.8, 0.3);  // ROS: a sensor at rest reads +g up
  EXPECT_LE(imu.stamp_ns, imu.arrival_ns);
}

TEST_F(WorldTest, GoesWhereItIsTold) {
  const auto world = open();
  const double there[] = {4.0, 3.0, -7.0, 0.5 * kPi};
  ASSERT_TRUE(world->command("rov", "goto", there).ok());
  ASSERT_TRUE(world->tick(240 * 15).ok());
  const Truth truth = world->truth("rov").value();
  EXPECT_NEAR(truth.position[0], 4.0, 0.1);
  EXPECT_NEAR(truth.position[1], 3.0, 0.1);
  EXPECT_NEAR(truth.position[2], -7.0, 0.1);
  // It faces north.
  EXPECT_NEAR(2.0 * std::atan2(truth.orientation[2], truth.orientation[3]), 0.5 * kPi, 0.05);
}

TEST_F(WorldTest, MovesAtTheVelocityThatItIsTold) {
  const auto world = open();
  const double ahead[] = {0.4, 0.1, 0.0, 0.0};
  ASSERT_TRUE(world->command("rov", "velocity", ahead).ok());
  ASSERT_TRUE(world->tick(240 * 4).ok());
  const Truth before = world->truth("rov").value();
  ASSERT_TRUE(world->tick(240 * 10).ok());
  // It faces east: ahead is x, left is y.
  const Truth truth = world->truth("rov").value();
  EXPECT_NEAR(truth.position[0] - before.position[0], 4.0, 0.3);  // it flies on what it measures
  EXPECT_NEAR(truth.position[1] - before.position[1], 1.0, 0.3);
  EXPECT_NEAR(truth.position[2], -6.0, 0.1);
}

// Whatever it is told, it goes no faster than it can, in its line and at its depth.
TEST_F(WorldTest, AVelocityBeyondItsReachKeepsDepthAndLine) {
  double reached_m_s = 0.0;
  for (const double told_m_s : {0.5, 1.0, 3.0, 10.0, 100.0}) {
    const auto world = open({}, "bluerov2_heavy_dynamics");  // it knows where it is
    ASSERT_TRUE(world->tick(120).ok());
    const Truth before = world->truth("rov").value();
    const double ahead[] = {told_m_s, 0.0, 0.0, 0.0};
    ASSERT_TRUE(world->command("rov", "velocity", ahead).ok());
    double up_m = 0.0, aside_m = 0.0;
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(world->tick(24).ok());
      const Truth now = world->truth("rov").value();
      up_m = std::max(up_m, std::abs(now.position[2] - before.position[2]));
      aside_m = std::max(aside_m, std::abs(now.position[1] - before.position[1]));
    }
    EXPECT_LT(up_m, 0.15) << told_m_s;
    EXPECT_LT(aside_m, 0.15) << told_m_s;
    const double speed_m_s = world->truth("rov")->linear_velocity[0];
    if (told_m_s == 0.5)
      EXPECT_NEAR(speed_m_s, told_m_s, 0.02);
    else if (told_m_s == 1.0)
      reached_m_s = speed_m_s;
    else
      EXPECT_NEAR(speed_m_s, reached_m_s, 0.02);
  }
  const auto world = open();
  for (const auto& [kind, values, words] :
       std::vector<std::tuple<std::string, std::vector<double>, std::string>>{
           {"velocity", {1e30, 0, 0, 0}, "velocity: found 1e+30 m/s; accepted: -100 to 100 m/s"},
           {"velocity", {0, 0, 0, -1e9}, "rad/s"},
           {"goto", {0, 1e30, 0, 0}, "accepted: -40000000 to 40000000 m"},
           {"wrench", {1e300, 0, 0, 0, 0, 0}, "N or N m"},
           {"thrusters", std::vector<double>(8, 1e9), "accepted: -1000000 to 1000000 N"}}) {
    const Status status = world->command("rov", kind, values);
    ASSERT_FALSE(status.ok()) << kind;
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
  }
}

TEST_F(WorldTest, GivesThrustersTheirForces) {
  const auto world = open();
  const std::vector<double> forces(8, 0.0), some{10.0, 0, 0, 0, 0, 0, 0, 0};
  ASSERT_TRUE(world->command("rov", "thrusters", some).ok());
  ASSERT_TRUE(world->tick(48).ok());
  EXPECT_NEAR(world->truth("rov")->thruster_n[0], 10.0, 0.5);
  // A setpoint after it acts: the wrench's group is given back.
  const double here[] = {2.0, 3.0, -6.0, 0.0};
  ASSERT_TRUE(world->command("rov", "goto", here).ok());
  ASSERT_TRUE(world->tick(240 * 20).ok());
  EXPECT_NEAR(world->truth("rov")->position[0], 2.0, 0.4);
}

TEST_F(WorldTest, GoesOnFromSavedBytesWithTheSameHashes) {
  const auto world = open();
  const double there[] = {4.0, 3.0, -7.0, 0.0};
  ASSERT_TRUE(world->command("rov", "goto", there).ok());
  ASSERT_TRUE(world->tick(200).ok());
  const auto saved = world->save();
  ASSERT_TRUE(world->tick(200).ok());
  const std::uint64_t hash = world->hash();
  const Status back = world->restore(saved);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(world->step(), 200u);
  ASSERT_TRUE(world->tick(200).ok());
  EXPECT_EQ(world->hash(), hash);
  // Commands are heard again, though time went back.
  EXPECT_TRUE(world->command("rov", "goto", there).ok());
}

// In this world and in a new one, a command of the saved time ends as if nothing had been restored.
TEST_F(WorldTest, ACommandThatWasSavedIsReleasedOrFollowedByAnother) {
  const std::vector<double> up(8, 5.0);
  const double there[] = {4.0, 3.0, -7.0, 0.0};
  const auto first = open();
  ASSERT_TRUE(first->command("rov", "thrusters", up).ok());
  ASSERT_TRUE(first->tick(20).ok());
  const auto saved = first->save();
  for (const bool release : {false, true}) {
    const auto end = [&](World& world) {
      EXPECT_TRUE((release ? world.release("rov") : world.command("rov", "goto", there)).ok());
      EXPECT_TRUE(world.tick(240).ok());
      return world.hash();
    };
    const auto straight = open(), fresh = open();
    ASSERT_TRUE(straight->command("rov", "thrusters", up).ok());
    ASSERT_TRUE(straight->tick(20).ok());
    const std::uint64_t hash = end(*straight);
    const Truth truth = straight->truth("rov").value();
    EXPECT_GT(std::abs(truth.thruster_n[0] - 5.0), 1.0);
    for (World* world : {first.get(), fresh.get()}) {
      ASSERT_TRUE(world->restore(saved).ok());
      EXPECT_EQ(end(*world), hash) << release;
      EXPECT_EQ(world->truth("rov")->thruster_n, truth.thruster_n);
    }
  }
}

// A dive with a display that goes on from it: clients end what clients began; the display's own
// keys give back what they took.
TEST_F(WorldTest, ADiveGoesOnWithASavedCommandThatItsClientsEnd) {
  for (const bool keys : {false, true}) {
    const auto first = open();
    ASSERT_TRUE(first
                    ->command("rov", "thrusters", std::vector<double>(8, 5.0), 0.0,
                              keys ? "keyboard" : "client")
                    .ok());
    ASSERT_TRUE(first->tick(20).ok());
    const auto scene = scene::load_scene(scratch_ / "s.toml");
    ASSERT_TRUE(scene.ok());
    auto physics = PhysicsWorld::create(*scene).value();
    const auto saved = parse_state(physics->state_format(), first->save(), "saved");
    ASSERT_TRUE(saved.ok());
    const auto live = LivePhysics::create(std::move(physics), {.start = *saved});
    const auto dive = World::attach(*live, *scene, "s.toml").value();
    ASSERT_TRUE(dive->release("rov").ok());
    for (int i = 0; i < 24; ++i) live->advance();
    const double force_n = live->newest().state.vehicles()[0].command_n[0];
    EXPECT_NEAR(force_n, keys ? 5.0 : 0.0, 0.2);
  }
}

TEST_F(WorldTest, ARestoreAtASensorsInstantBringsNoReadingTwice) {
  const auto world = open();
  ASSERT_TRUE(world->tick(240).ok());
  const Reading before = newest(*world, "rov/imu");
  ASSERT_EQ(before.stamp_ns, world->time_ns());
  ASSERT_TRUE(world->restore(world->save()).ok());
  EXPECT_EQ(newest(*world, "rov/imu").count, 0u);
  const std::uint32_t imu = world->stream("rov/imu").value();
  ASSERT_TRUE(world->keep(imu, true).ok());
  ASSERT_TRUE(world->tick(24).ok());
  const auto arrived = world->take_arrived();
  ASSERT_FALSE(arrived.empty());
  EXPECT_EQ(arrived.front().sequence, before.sequence + 1);
}

TEST_F(WorldTest, TheNewestReadingIsTheOneThatWasMeasuredLast) {
  const auto world = open();
  const std::uint32_t imu = world->stream("rov/imu").value();
  ASSERT_TRUE(world->set_link(imu, {.delay_s = 0.02, .jitter_s = 0.1, .loss = 0.0}).ok());
  ASSERT_TRUE(world->keep(imu, true).ok());
  TimeNs last_ns = 0;
  for (int i = 0; i < 480; ++i) {
    ASSERT_TRUE(world->tick(1).ok());
    EXPECT_GE(newest(*world, "rov/imu").stamp_ns, last_ns) << i;
    last_ns = newest(*world, "rov/imu").stamp_ns;
  }
  // Those that were overtaken came all the same.
  const auto arrived = world->take_arrived();
  EXPECT_FALSE(std::ranges::is_sorted(arrived, {}, &Reading::sequence));
}

TEST_F(WorldTest, ForcesOfThrustersActInTheStepInWhichTheyCome) {
  const auto world = open();
  for (int i = 0; i < 12; ++i) {
    const double force_n = 5.0 + i;
    ASSERT_TRUE(world->command("rov", "thrusters", std::vector<double>(8, force_n)).ok());
    ASSERT_TRUE(world->tick(1).ok());
    EXPECT_NEAR(world->truth("rov")->thruster_n[0], force_n, 0.2) << i;
  }
  // No command gives more than the agent says.
  for (const double sign : {-1.0, 1.0}) {
    ASSERT_TRUE(world->command("rov", "thrusters", std::vector<double>(8, sign * 1e6)).ok());
    ASSERT_TRUE(world->tick(1).ok());
    const auto [least_n, most_n] = world->agents()[0].thruster_n[0];
    EXPECT_DOUBLE_EQ(world->truth("rov")->thruster_n[0], sign < 0.0 ? least_n : most_n);
  }
}

TEST_F(WorldTest, ATickEndsWhereItIsStopped) {
  const auto world = open();
  int asked = 0;
  ASSERT_TRUE(world->tick(100, [&] { return ++asked == 7; }).ok());
  EXPECT_EQ(world->step(), 7u);
  ASSERT_TRUE(world->tick(3).ok());
  EXPECT_EQ(world->step(), 10u);
}

TEST_F(WorldTest, RefusesWhatWouldActOtherwiseThanItSays) {
  const auto world = open(), other = open({.seed = 7});
  const auto has = [](const Status& status, const char* part) {
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
  };
  has(world->set_link(world->stream("rov/setpoint").value(), {.delay_s = 1.0}),
      "link: rov/setpoint: found a stream of inputs");
  has(world->restore(other->save()), "a state of seed 7; accepted: one of seed ");
  std::vector<double> failed(8, 0.0);
  for (const double value : {5.0, -1.0, 0.5}) {
    failed[2] = value;
    has(world->command("rov", "faults", failed), "accepted: 0 or 1");
  }
}

TEST_F(WorldTest, DelaysAndLosesOnArrivalAlone) {
  const auto near = open(), far = open();
  const std::uint32_t imu = near->stream("rov/imu").value();
  ASSERT_TRUE(far->set_link(imu, {.delay_s = 0.1, .jitter_s = 0.05, .loss = 0.2}).ok());
  ASSERT_TRUE(near->keep(imu, true).ok());
  ASSERT_TRUE(far->keep(imu, true).ok());
  ASSERT_TRUE(near->tick(480).ok());
  ASSERT_TRUE(far->tick(480).ok());
  EXPECT_EQ(near->hash(), far->hash());
  const auto all = near->take_arrived(), some = far->take_arrived();
  ASSERT_GT(some.size(), all.size() / 2);
  EXPECT_LT(some.size(), all.size() * 9 / 10);
  for (const Reading& reading : some) {
    EXPECT_GE(reading.arrival_ns - reading.stamp_ns, 100'000'000);
    const Reading& same = all[reading.sequence - all.front().sequence];
    ASSERT_EQ(same.sequence, reading.sequence);
    EXPECT_EQ(same.stamp_ns, reading.stamp_ns);
    EXPECT_EQ(same.values, reading.values);
  }
}

TEST_F(WorldTest, ReadingsOfAllStreamsComeInTheOrderOfTheirArrivalInTicksOfAnyLength) {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> orders[2];
  for (const std::uint64_t steps : {480, 7}) {
    const auto world = open();
    const std::uint32_t imu = world->stream("rov/imu").value();
    ASSERT_TRUE(world->set_link(imu, {.delay_s = 0.03, .jitter_s = 0.02}).ok());
    for (const char* name : {"rov/imu", "rov/pressure", "rov/dvl"})
      ASSERT_TRUE(world->keep(world->stream(name).value(), true).ok());
    TimeNs last_ns = 0;
    while (world->step() < 480) {
      ASSERT_TRUE(world->tick(std::min<std::uint64_t>(steps, 480 - world->step())).ok());
      for (const Reading& reading : world->take_arrived()) {
        EXPECT_GE(reading.arrival_ns, last_ns);
        last_ns = reading.arrival_ns;
        orders[steps == 7].emplace_back(reading.stream, reading.sequence);
      }
    }
  }
  EXPECT_GT(orders[0].size(), 300u);
  EXPECT_EQ(orders[0], orders[1]);
}

TEST_F(WorldTest, ALongTickCanBeEndedBeforeLateReadingsAreTooMany) {
  const auto world = open();
  const std::uint32_t imu = world->stream("rov/imu").value();
  ASSERT_TRUE(world->set_link(imu, {.delay_s = 0.1}).ok());
  ASSERT_TRUE(world->keep(imu, true).ok());
  constexpr std::uint64_t kSteps = 2400;
  constexpr std::size_t kMany = 100;
  std::size_t came = 0;
  while (world->step() < kSteps) {
    ASSERT_TRUE(
        world->tick(kSteps - world->step(), [&] { return world->arrived() >= kMany; }).ok());
    const std::size_t some = world->take_arrived().size();
    EXPECT_LE(some, kMany + 1);
    came += some;
  }
  EXPECT_GT(came, 15 * kMany);
}

TEST_F(WorldTest, RefusesInOneLine) {
  const auto world = open();
  const double two[] = {1.0, 2.0};
  const double nan[] = {1.0, 2.0, NAN, 0.0};
  for (const Status& status :
       {world->command("rovv", "goto", two), world->command("rov", "got", two),
        world->command("rov", "goto", two), world->command("rov", "goto", nan),
        world->inject("rov/imu", two, "me"), world->restore({}), world->stop_recording(),
        world->set_link(0, {.loss = 2.0})}) {
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("accepted: "), std::string::npos)
        << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
}

TEST_F(WorldTest, TellsWhatBecameOfTheSamplesOfEachSource) {
  const auto world = open();
  EXPECT_TRUE(world->sources().empty());
  constexpr std::uint64_t kSent = 3000;
  const double pushes[] = {10.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (std::uint64_t i = 0; i < kSent; ++i)
    ASSERT_TRUE(world->inject("rov/wrench", pushes, "burst").ok());
  const double too_strong[] = {1e9, 0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(world->inject("rov/wrench", too_strong, "burst").ok());
  EXPECT_FALSE(world->inject("rov/wrench", pushes, "old", -5.0).ok());
  ASSERT_TRUE(world->command("rov", "wrench", pushes, 0.5, "pilot").ok());
  ASSERT_TRUE(world->tick(2).ok());
  const auto sources = world->sources();
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[0].name, "burst");
  EXPECT_EQ(sources[0].counts.accepted, kSent);
  // The inbox keeps its capacity and the newest one.
  EXPECT_EQ(sources[0].counts.dropped, kSent - SampleInbox::kCapacity - 1);
  EXPECT_EQ(sources[0].counts.not_plausible, 1u);
  EXPECT_EQ(sources[0].health, "");  // no group listens to it
  EXPECT_FALSE(sources[0].link);
  EXPECT_EQ(sources[1].counts.late, 1u);
  EXPECT_EQ(sources[2].name, "pilot");
  EXPECT_EQ(sources[2].health, "good");
  ASSERT_TRUE(world->tick(240).ok());
  EXPECT_EQ(world->sources()[2].health, "lost");
}

TEST_F(WorldTest, RefusesRotationsThatAreNone) {
  NERITIC_ASSERT_OK(const auto world, World::open(assets("scenes/dive.toml"), {}));
  const auto said = [](const Status& status) {
    return status.ok() ? std::string() : status.error().message;
  };
  const auto joints = [](double length) {
    std::vector<double> values;
    for (int i = 0; i < 15; ++i)
      values.insert(values.end(), {0.0, 0.0, 0.6 * length, 0.8 * length});
    values.push_back(0.0);
    return values;
  };
  EXPECT_EQ(said(world->inject("diver/joints", joints(1.0), "suit")), "");
  EXPECT_EQ(said(world->inject("diver/joints", joints(0.9995), "suit")), "");
  EXPECT_EQ(said(world->inject("diver/joints", joints(0.0), "suit")),
            "diver/joints: joints at place 0: found a quaternion of length 0; accepted: x y z w of "
            "length 1, within 0.001");
  for (const double length : {1e-3, 0.99, 1.01, 1.8}) {
    const std::string where = "joints at place 0: found a quaternion of length";
    EXPECT_NE(said(world->inject("diver/joints", joints(length), "suit")).find(where),
              std::string::npos);
    // A command that is refused leaves the authority as it was: the state is that of a world
    // without.
    EXPECT_NE(said(world->command("diver", "joints", joints(length))).find(where),
              std::string::npos);
  }
  NERITIC_ASSERT_OK(const auto other, World::open(assets("scenes/dive.toml"), {}));
  ASSERT_TRUE(world->tick(24).ok() && other->tick(24).ok());
  EXPECT_EQ(world->hash(), other->hash());
  // The pose of a hand that is not tracked means nothing.
  std::vector<double> hands{0, 0, -5, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0};
  EXPECT_EQ(said(world->inject("diver/hand_poses", hands, "suit")), "");
  hands[15] = 1.0;
  EXPECT_EQ(
      said(world->inject("diver/hand_poses", hands, "suit")),
      "diver/hand_poses: right_orientation: found a quaternion of length 0; accepted: x y z w "
      "of length 1, within 0.001");
}

TEST_F(WorldTest, RefusesATankThatADiverLacksAndAStampThatIsToCome) {
  NERITIC_ASSERT_OK(const auto world, World::open(assets("scenes/dive.toml"), {}));
  const auto said = [](const Status& status) {
    return status.ok() ? std::string() : status.error().message;
  };
  const auto gas = [&](double tank) { return said(world->command("diver", "gas", {&tank, 1})); };
  EXPECT_EQ(gas(0.0), "");
  EXPECT_EQ(gas(1.0), "diver: gas: found 1; accepted: a tank's number, 0 to 0");
  EXPECT_NE(gas(0.5).find("found 0.5"), std::string::npos);
  EXPECT_NE(gas(-1.0).find("found -1"), std::string::npos);
  const std::vector<double> joints(59, 0.0);
  EXPECT_EQ(said(world->command("diver", "joints", joints)),
            "diver: joints: found 59 numbers; accepted: 60 or 61");
  const double beat[] = {0.0, 0.0, 0.0, 1.0};
  const std::string later = said(world->inject("diver/heart", beat, "strap", 2.5));
  EXPECT_NE(later.find("ahead of the newest step"), std::string::npos) << later;
}

}  // namespace
}  // namespace neritic::testbed
