// The state of a person for a robot: whom the eyes look at, and how far each value can be relied
// on.
#include "diver/reach.hpp"
#include "rov/frames.hpp"
#include "testbed/simulation/human_readings.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string ball(const char* name, const Vec3& at_m, const char* more = "") {
  return fmt::format(
      "[[objects]]\nname = \"{}\"\nshape = \"sphere\"\nradius_m = 0.1\n"
      "position_m = [{}, {}, {}]\n{}\n",
      name, at_m.x, at_m.y, at_m.z, more);
}

HumanReading reading_of(const TestDive& dive) {
  return human_reading(dive.world->humans()[0], dive.state().humans()[0],
                       dive.world->looks_at(dive.state(), 0, dive.time_s()));
}

std::string looked_at(const TestDive& dive) {
  const std::uint64_t object = reading_of(dive).gaze_object;
  return object == 0 ? "" : dive.scene.objects.at(object - 1).name;
}

// Eyes and line of sight of a diver who was just put there.
struct Sight {
  Vec3 eyes_m, gaze;
};
Sight sight_of(const TestDive& dive) {
  const PhysicsHuman& human = dive.world->humans()[0];
  const diver::HumanState& state = dive.state().humans()[0].human;
  const Pose eyes = diver::body_from_eyes(
      human.body, diver::posture_of(human.body, state.limbs.rotation, state.limbs.rate));
  return {world_from_ned(state.root.position_ned_m + state.root.attitude * eyes.position_m),
          world_from_ned(state.life.vitals.gaze_ned)};
}

const std::string kDiver =
    kStillWater + diver_text("position_m = [0, -12, 0]\n" + std::string(kProne));

TestDive after_a_step(const std::string& text) {
  TestDive dive = dive_of(text);
  dive.run(0.01);
  return dive;
}

TEST(HumanReading, TheEyesLookNotTheHips) {
  const Sight sight = sight_of(after_a_step(kDiver));
  const Vec3 aside = glm::normalize(glm::cross(sight.gaze, Vec3(0.3, 1.0, 0.2)));
  for (const double far_m : {1.0, 1.5, 3.0, 8.0, 40.0}) {
    const auto at = [&](double off_deg) {
      return sight.eyes_m +
             far_m * (std::cos(radians(off_deg)) * sight.gaze + std::sin(radians(off_deg)) * aside);
    };
    EXPECT_EQ(looked_at(after_a_step(kDiver + ball("ball", at(0.0)))), "ball") << far_m;
    // Its own size counts: 4 degrees from its edge, 9 from its edge.
    const double half_deg = glm::degrees(std::asin(0.1 / far_m));
    const TestDive near = after_a_step(kDiver + ball("ball", at(4.0 + half_deg)));
    EXPECT_EQ(looked_at(near), "ball") << far_m;
    EXPECT_LT(reading_of(near).gaze_off_rad, radians(4.3));
    EXPECT_NEAR(reading_of(near).gaze_distance_m, far_m, 0.2);
    EXPECT_EQ(looked_at(after_a_step(kDiver + ball("ball", at(9.0 + half_deg)))), "");
  }
}

TEST(HumanReading, WhatIsNearerHidesAndWhatTheDiverCarriesDoesNotCount) {
  const Sight sight = sight_of(after_a_step(kDiver));
  const auto ahead = [&](double far_m) { return sight.eyes_m + far_m * sight.gaze; };
  EXPECT_EQ(looked_at(after_a_step(kDiver + ball("far", ahead(6.0)) + ball("near", ahead(3.0)))),
            "near");
  EXPECT_EQ(
      looked_at(after_a_step(
          kDiver + ball("far", ahead(6.0)) +
          "[[objects]]\nname = \"torch\"\nshape = \"sphere\"\nradius_m = 0.1\non = \"diver\"\n"
          "position_m = [0, 0.9, 0]\n")),
      "far");
  const TestDive walled = after_a_step(
      kDiver + ball("far", ahead(6.0)) +
      fmt::format("[[objects]]\nname = \"bed\"\nclass = \"seabed\"\nshape = \"box\"\ncollision = "
                  "true\nsize_m = [4, 4, 0.5]\nposition_m = [{}, {}, {}]\n",
                  ahead(3.0).x, ahead(3.0).y, ahead(3.0).z));
  EXPECT_EQ(looked_at(walled), "");
}

TEST(HumanReading, EachValueSaysHowFarItCanBeReliedOn) {
  TestDive dive =
      dive_of(kStillWater +
              diver_text("position_m = [0, -12, 0]\n" + std::string(kProne) +
                         "inputs = { heart = \"strap\", breath = { from = \"microphone\" } }\n"));
  dive.run(0.5);
  HumanReading now = reading_of(dive);
  EXPECT_EQ(now.gaze_quality, ValueQuality::kModelled);
  EXPECT_EQ(now.heart_quality, ValueQuality::kLost);
  EXPECT_EQ(now.breath_quality, ValueQuality::kLost);
  EXPECT_EQ(now.variability_quality, ValueQuality::kMissing);
  EXPECT_GT(now.heart_bpm, 50.0);
  EXPECT_NEAR(now.depth_m, 12.0, 0.3);

  Heart heart;
  heart.state.time_s = 1.0;
  heart.state.rate_bpm = 93.0;
  heart.state.quality = diver::SignalQuality::kGood;
  heart.state.over_five_minutes.pairs = 40;
  heart.state.over_five_minutes.sdnn_ms = 52.0;
  heart.state.over_five_minutes.rmssd_ms = 39.1;
  const auto sources = dive.simulation->inbox().source_names();
  const auto strap = static_cast<SourceId>(std::ranges::find(sources, "strap") - sources.begin());
  const StreamId stream = *dive.world->streams().find("diver/heart");
  std::uint64_t sequence = 0;
  const auto say = [&](diver::SignalQuality quality) {
    heart.state.time_s += 1.0;
    heart.state.quality = quality;
    EXPECT_EQ(dive.simulation->inbox().push({{stream, strap, sequence++, 0, 0}, heart}),
              SampleVerdict::kAccepted);
    dive.run(0.1);
  };
  say(diver::SignalQuality::kGood);
  now = reading_of(dive);
  EXPECT_EQ(now.heart_quality, ValueQuality::kGood);
  EXPECT_EQ(now.heart_bpm, 93.0);
  EXPECT_EQ(now.variability_quality, ValueQuality::kGood);
  EXPECT_EQ(now.rmssd_ms, 39.1);
  say(diver::SignalQuality::kPoor);
  now = reading_of(dive);
  EXPECT_EQ(now.heart_quality, ValueQuality::kPoor);
  EXPECT_EQ(now.variability_quality, ValueQuality::kMissing);
  EXPECT_EQ(now.rmssd_ms, 0.0);
  say(diver::SignalQuality::kGood);
  dive.run(12.0);
  EXPECT_EQ(reading_of(dive).heart_quality, ValueQuality::kLost);
}

}  // namespace
}  // namespace neritic::testbed
