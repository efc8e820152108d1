// Samples of collisions: who, with whom and where, against scenes whose geometry says so.
#include "testbed/simulation/output_samples.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

struct Collisions {
  std::vector<CollisionReading> of_vehicle[2], of_diver;
};

// All collisions of these seconds; each stream without gaps, a sample a step that touched.
Collisions collisions_of(TestDive& dive, double seconds) {
  const StreamTable& table = dive.world->streams();
  OutputSamples outputs(*dive.world, OutputSamples::all(*dive.world));
  outputs.of(dive.simulation->newest());
  Collisions out;
  dive.run(seconds, [&] {
    for (const Sample& sample : outputs.of(dive.simulation->newest())) {
      const auto* reading = std::get_if<CollisionReading>(&sample.payload);
      if (!reading) continue;
      const Stream& stream = table[sample.header.stream];
      auto& list = stream.sort == OwnerSort::kVehicle ? out.of_vehicle[stream.owner] : out.of_diver;
      EXPECT_EQ(sample.header.sequence, list.size());
      EXPECT_EQ(sample.header.captured_ns, dive.simulation->newest().due_ns);
      list.push_back(*reading);
    }
  });
  for (std::size_t i = 0; i < dive.state().vehicles().size(); ++i)
    EXPECT_EQ(out.of_vehicle[i].size(), dive.vehicle(i).contact.touched_steps);
  for (const HumanPhysics& human : dive.state().humans())
    EXPECT_EQ(out.of_diver.size(), human.contact.touched_steps);
  return out;
}

Piloting wrench_of(std::size_t axis, double newton) {
  Piloting piloting;
  piloting.piloted = 1;
  piloting.pilot[axis] = newton;
  return piloting;
}

TEST(CollisionSamples, AVehiclePressedToTheGroundTouchesItFromAbove) {
  TestDive dive = dive_of(
      std::string(kStillWater) +
      "[[objects]]\nname = \"far\"\nshape = \"box\"\nsize_m = [1, 1, 1]\nposition_m = [9, -9, 0]\n"
      "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [40, 40]\n"
      "position_m = [0, -12, 0]\n" +
      rov_text("position_m = [0, -11.5, 0]\n"));
  pilot(dive, 0, wrench_of(2, 60.0));
  const auto touched = collisions_of(dive, 5.0).of_vehicle[0];
  ASSERT_GT(touched.size(), 240u);
  std::uint64_t sand = 0;
  for (const auto& object : dive.scene.objects)
    if (object.name == "sand") sand = object.instance;
  double impulse_n_s = 0.0;
  for (const CollisionReading& reading : touched) {
    ASSERT_EQ(reading.with, CollisionWith::kSolid);
    ASSERT_EQ(reading.other, sand);
    ASSERT_NEAR(reading.point_m.y, -12.0, 0.001);
    ASSERT_LT(glm::length(Vec3(reading.point_m.x, 0.0, reading.point_m.z)), 0.5);
    ASSERT_GT(reading.normal.y, 0.999);
    ASSERT_LT(reading.depth_m, 0.005);
    impulse_n_s += reading.impulse_n_s.y;
  }
  EXPECT_GT(impulse_n_s, 0.0);
}

TEST(CollisionSamples, TwoVehiclesTellOfEachOtherAtTheSamePlace) {
  TestDive dive =
      dive_of("[physics]\n" + rov_text("position_m = [-1.5, -6, 0]\nyaw_deg = -90\n", "one") +
              rov_text("position_m = [1.5, -6.05, 0.1]\nyaw_deg = 90\n", "other"));
  pilot(dive, 0, wrench_of(0, 200.0));
  pilot(dive, 1, wrench_of(0, 200.0));
  const Collisions found = collisions_of(dive, 10.0);
  const auto &one = found.of_vehicle[0], &other = found.of_vehicle[1];
  ASSERT_GT(one.size(), 50u);
  ASSERT_EQ(one.size(), other.size());
  EXPECT_GT(std::abs(one.front().normal.x), 0.9);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].with, CollisionWith::kVehicle);
    ASSERT_EQ(one[i].other, 1u);
    ASSERT_EQ(other[i].other, 0u);
    ASSERT_NEAR(one[i].depth_m, other[i].depth_m, 1e-6);
    ASSERT_LT(glm::length(one[i].normal + other[i].normal), 1e-3) << i;
    ASSERT_LT(one[i].depth_m, 0.01);
  }
  EXPECT_LT(glm::distance(one.front().point_m, other.front().point_m), 0.3);
}

TEST(CollisionSamples, ADiverAndAVehicleTellOfEachOther) {
  TestDive dive = dive_of(std::string(kStillWater) +
                          diver_text(std::string("position_m = [0, -12, 0]\n") + kProne) +
                          rov_text("position_m = [-1.6, -12, -0.3]\nyaw_deg = -90\n"));
  pilot(dive, 0, wrench_of(0, 200.0));
  const Collisions found = collisions_of(dive, 8.0);
  ASSERT_GT(found.of_diver.size(), 20u);
  ASSERT_EQ(found.of_diver.size(), found.of_vehicle[0].size());
  for (std::size_t i = 0; i < found.of_diver.size(); ++i) {
    ASSERT_EQ(found.of_diver[i].with, CollisionWith::kVehicle);
    ASSERT_EQ(found.of_vehicle[0][i].with, CollisionWith::kDiver);
    ASSERT_EQ(found.of_diver[i].other, 0u);
  }
  EXPECT_GT(found.of_diver.front().normal.x, 0.9);  // pushed to the east
}

}  // namespace
}  // namespace neritic::testbed
