// The sweep against two loops over all pairs: the same pairs in the same order, and the same bits
// of what parts.
#include "testbed/simulation/pair_finder.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engine/sim/body_pair.hpp"

namespace neritic::testbed {
namespace {

bool near(const PairSphere& a, const PairSphere& b) {
  return glm::distance(a.centre_m, b.centre_m) <= a.reach_m + b.reach_m;
}

// Every pair in the order in which pairs are solved: vehicles, then each diver with all vehicles
// and with the divers after it.
std::vector<MeetingPair> every_pair(std::uint32_t vehicles, std::uint32_t bodies) {
  std::vector<MeetingPair> out;
  for (std::uint32_t i = 0; i < vehicles; ++i)
    for (std::uint32_t j = i + 1; j < vehicles; ++j) out.push_back({i, j});
  for (std::uint32_t k = vehicles; k < bodies; ++k) {
    for (std::uint32_t i = 0; i < vehicles; ++i) out.push_back({k, i});
    for (std::uint32_t m = k + 1; m < bodies; ++m) out.push_back({k, m});
  }
  return out;
}

TEST(PairFinder, FindsThePairsOfTwoLoopsInTheirOrder) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-8.0, 8.0), reach(0.1, 2.0);
  PairFinder finder;
  std::size_t met = 0;
  for (int round = 0; round < 300; ++round) {
    // About the origin, and a hundred kilometres off; spread along each axis in turn.
    const Vec3 origin_m = round % 2 == 0 ? Vec3(0.0) : Vec3(1e5, -80.0, -1e5);
    Vec3 spread(1.0);
    spread[round % 3] = 10.0;
    const std::uint32_t vehicles = random() % 60, bodies = vehicles + random() % 10;
    std::vector<PairSphere> spheres;
    for (std::uint32_t i = 0; i < bodies; ++i)
      spheres.push_back({origin_m + spread * Vec3(place(random), place(random), place(random)),
                         random() % 20 == 0 ? 30.0 : reach(random)});
    finder.begin(vehicles, bodies);
    for (std::uint32_t i = 0; i < bodies; ++i) finder.set(i, spheres[i]);
    finder.find();
    for (const MeetingPair& pair : every_pair(vehicles, bodies)) {
      if (!near(spheres[pair.first], spheres[pair.second])) continue;
      ASSERT_EQ(finder.next(), pair) << round;
      ++met;
    }
    ASSERT_EQ(finder.next(), std::nullopt) << round;
  }
  EXPECT_GT(met, 5000u);
}

// A body that parts and moves farther meets those that come later in the order.
TEST(PairFinder, ABodyThatReachesFartherMeetsThoseStillToCome) {
  PairFinder finder;
  finder.begin(4, 4);
  for (std::size_t i = 0; const double x_m : {0.0, 1.0, 5.0, 9.0})
    finder.set(i++, {Vec3(x_m, 0.0, 0.0), 0.6});
  finder.find();
  EXPECT_EQ(finder.next(), (MeetingPair{0, 1}));
  finder.set_reach(1, 8.0);
  EXPECT_EQ(finder.next(), (MeetingPair{1, 2}));
  finder.set_reach(2, 0.1);
  EXPECT_EQ(finder.next(), (MeetingPair{1, 3}));
  finder.set_reach(3, 50.0);
  EXPECT_EQ(finder.next(), (MeetingPair{2, 3}));
  EXPECT_EQ(finder.next(), std::nullopt);
}

// A step that goes wrong is refused afterwards; until then its numbers must do no harm.
TEST(PairFinder, AReachThatIsNoNumberMeetsEverything) {
  PairFinder finder;
  finder.begin(2, 3);
  const double reaches_m[] = {0.1, std::numeric_limits<double>::quiet_NaN(), 0.1};
  for (std::size_t i = 0; i < 3; ++i)
    finder.set(i, {Vec3(1e4 * double(i), 0.0, 0.0), reaches_m[i]});
  finder.find();
  EXPECT_EQ(finder.next(), (MeetingPair{0, 1}));
  EXPECT_EQ(finder.next(), (MeetingPair{2, 1}));
  EXPECT_EQ(finder.next(), std::nullopt);
}

// Boxes of random sizes, speeds up to 300 m/s, partly overlapping.
struct Crowd {
  std::vector<sim::BodyShape> shapes;
  std::vector<sim::InverseMass> inverse_masses;
  std::vector<sim::PairBody> bodies;
};
Crowd random_crowd(std::uint32_t seed, std::size_t count, const Vec3& origin_m, double dt_s) {
  std::mt19937 random(seed);
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const auto vector = [&](double most) {
    const double x = uniform(-most, most), y = uniform(-most, most);
    return Vec3(x, y, uniform(-most, most));
  };
  Crowd out;
  out.shapes.resize(count);
  out.inverse_masses.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.shapes[i].add_box({}, Vec3(0.3) + vector(0.2));
    const double mass_kg = uniform(5.0, 100.0);
    for (std::size_t k = 0; k < 6; ++k)
      out.inverse_masses[i][7 * k] = (k < 3 ? 1.0 : 20.0) / mass_kg;
    const Quat turn = glm::normalize(Quat(1.0, uniform(-1.0, 1.0), uniform(-1.0, 1.0), 0.3));
    const Pose before{origin_m + vector(3.0), turn};
    const sim::Twist velocity{vector(random() % 8 == 0 ? 300.0 : 3.0), vector(3.0)};
    out.bodies.push_back({out.shapes[i],
                          out.inverse_masses[i],
                          before,
                          {sim::moved(before, velocity, dt_s), velocity}});
  }
  return out;
}

TEST(PairFinder, PartsACrowdWithTheBitsOfTwoLoopsOverAllPairs) {
  constexpr double kStep_s = 1.0 / 240.0;
  constexpr std::uint32_t kVehicles = 50, kBodies = 60;
  sim::PairMemory memory;
  PairFinder finder;
  int touched = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Vec3 origin_m = seed % 2 == 0 ? Vec3(0.0) : Vec3(1e5, -300.0, 1e5);
    Crowd loops = random_crowd(seed, kBodies, origin_m, kStep_s);
    Crowd swept = random_crowd(seed, kBodies, origin_m, kStep_s);
    for (const MeetingPair& pair : every_pair(kVehicles, kBodies))
      touched += sim::part_bodies(loops.bodies[pair.first], loops.bodies[pair.second], 0.4, kStep_s,
                                  memory);
    const auto reach_m = [&](std::uint32_t i) { return sim::pair_reach_m(swept.bodies[i]); };
    finder.begin(kVehicles, kBodies);
    for (std::uint32_t i = 0; i < kBodies; ++i)
      finder.set(i, {swept.bodies[i].before.position_m, reach_m(i)});
    finder.find();
    while (const auto pair = finder.next())
      if (sim::part_bodies(swept.bodies[pair->first], swept.bodies[pair->second], 0.4, kStep_s,
                           memory))
        for (const std::uint32_t i : {pair->first, pair->second}) finder.set_reach(i, reach_m(i));
    for (std::uint32_t i = 0; i < kBodies; ++i) {
      const sim::BodyMotion &a = loops.bodies[i].free, &b = swept.bodies[i].free;
      ASSERT_EQ(a.world_from_body.position_m, b.world_from_body.position_m) << seed << " " << i;
      ASSERT_EQ(a.world_from_body.rotation, b.world_from_body.rotation) << seed << " " << i;
      ASSERT_EQ(a.velocity.linear, b.velocity.linear) << seed << " " << i;
      ASSERT_EQ(a.velocity.angular, b.velocity.angular) << seed << " " << i;
    }
  }
  EXPECT_GT(touched, 500);
}

}  // namespace
}  // namespace neritic::testbed
