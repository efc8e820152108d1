// Two bodies that meet: momentum, energy, and nobody in nobody, by closed forms and by counting.
#include "engine/sim/body_pair.hpp"

#include <gtest/gtest.h>

#include "engine/core/random.hpp"
#include "engine/sim/convex_query.hpp"
#include "tests/sim/bodies.hpp"

namespace neritic::sim {
namespace {

PairMemory pair_memory;

using test::Body, test::inverse_of, test::kinetic_energy, test::make_body, test::mass_of;

constexpr double kPairStep_s = 1.0 / 240.0;
const Quat kAsBuilt(1.0, 0.0, 0.0, 0.0);

// A step of both: free, then apart. Whether they touched.
bool step_pair(Body& a, Body& b, double friction, double dt_s) {
  const auto free_of = [&](const Body& body) {
    const Pose& pose = body.motion.world_from_body;
    const Quat body_from_world = glm::conjugate(pose.rotation);
    const Twist rate = test::times(body.inverse_mass,
                                   body_from_world * body.force_n + body.thrust_n, body.torque_nm);
    BodyMotion free;
    free.velocity = {body.motion.velocity.linear + rate.linear * dt_s,
                     body.motion.velocity.angular + rate.angular * dt_s};
    free.world_from_body = moved(pose, free.velocity, dt_s);
    return free;
  };
  PairBody pa{a.shape, a.inverse_mass, a.motion.world_from_body, free_of(a)},
      pb{b.shape, b.inverse_mass, b.motion.world_from_body, free_of(b)};
  const bool met = part_bodies(pa, pb, friction, dt_s, pair_memory);
  a.motion = pa.free;
  b.motion = pb.free;
  return met;
}

Body ball(double mass_kg, double x_m, double speed_m_s) {
  BodyShape shape;
  shape.add_sphere(Vec3(0.0), 0.2);
  Body out = make_body(shape, mass_of(mass_kg, Vec3(0.016 * mass_kg)), {{x_m, 0, 0}, kAsBuilt});
  out.motion.velocity.linear.x = speed_m_s;
  return out;
}

// How deep the one is in the other, at most.
double depth_of(const Body& a, const Body& b) {
  double deepest_m = 0.0;
  for (const ConvexPart& pa : a.shape.parts())
    for (const ConvexPart& pb : b.shape.parts()) {
      std::vector<Vec3> points_a, points_b;
      const Pose a_from_b = inverse(a.motion.world_from_body) * b.motion.world_from_body;
      for (const Vec3& p : pa.core_m) points_a.push_back(p);
      for (const Vec3& p : pb.core_m) points_b.push_back(a_from_b * p);
      const auto found = convex_distance(points_a, points_b);
      if (found) deepest_m = std::max(deepest_m, pa.radius_m + pb.radius_m - found->distance_m);
    }
  return deepest_m;
}

TEST(BodyPair, BallsThatMeetGoOnTogether) {
  // Plastic: v' = (m_a v_a + m_b v_b) / (m_a + m_b), and a thousand times the mass hardly slows.
  for (const double mass_b : {10.0, 30.0, 1e4}) {
    Body a = ball(10.0, -0.5, 1.5), b = ball(mass_b, 0.5, -0.5);
    bool met = false;
    for (int i = 0; i < 240; ++i) met = step_pair(a, b, 0.0, kPairStep_s) || met;
    EXPECT_TRUE(met);
    const double together = (10.0 * 1.5 - mass_b * 0.5) / (10.0 + mass_b);
    EXPECT_NEAR(a.motion.velocity.linear.x, together, 1e-9) << mass_b;
    EXPECT_NEAR(b.motion.velocity.linear.x, together, 1e-9) << mass_b;
    EXPECT_LT(depth_of(a, b), 1e-5) << mass_b;
  }
}

TEST(BodyPair, EachMeetsItWithItsOwnAddedMass) {
  // Along x the water adds 5 kg to the one and 15 kg to the other.
  Body a = ball(10.0, -0.5, 1.0), b = ball(10.0, 0.5, 0.0);
  a.inverse_mass = inverse_of(mass_of(10.0, Vec3(0.16), Vec3(5.0, 50.0, 50.0)));
  b.inverse_mass = inverse_of(mass_of(10.0, Vec3(0.16), Vec3(15.0, 0.0, 0.0)));
  for (int i = 0; i < 240; ++i) step_pair(a, b, 0.3, kPairStep_s);
  EXPECT_NEAR(a.motion.velocity.linear.x, 15.0 / 40.0, 1e-9);
  EXPECT_NEAR(b.motion.velocity.linear.x, 15.0 / 40.0, 1e-9);
}

TEST(BodyPair, WhatIsApartKeepsItsBits) {
  Body a = ball(10.0, -5.0, 1.0), b = ball(10.0, 5.0, -1.0);
  PairBody pa{a.shape, a.inverse_mass, a.motion.world_from_body, a.motion},
      pb{b.shape, b.inverse_mass, b.motion.world_from_body, b.motion};
  pa.free.world_from_body.position_m += Vec3(1.0 / 3.0, 0.1, 0.2);
  const BodyMotion before = pa.free;
  EXPECT_FALSE(part_bodies(pa, pb, 0.5, kPairStep_s, pair_memory));
  EXPECT_EQ(pa.free.world_from_body.position_m, before.world_from_body.position_m);
  EXPECT_EQ(pa.free.velocity.linear, before.velocity.linear);
}

// For any mass, attitude, spin and speed, one step keeps the momentum and adds no energy.
TEST(BodyPair, MomentumStaysAndEnergyNeverGrows) {
  int met = 0;
  for (std::uint64_t index = 0; index < 400; ++index) {
    std::uint64_t draw = 0;
    const auto uniform = [&](double least, double most) {
      return least + (most - least) * random_uniform({31, index, 0}, draw++);
    };
    const auto vector = [&](double most) {
      return Vec3(uniform(-most, most), uniform(-most, most), uniform(-most, most));
    };
    const auto body = [&](const Vec3& at_m) {
      BodyShape shape;
      shape.add_box({}, {uniform(0.1, 0.4), uniform(0.1, 0.4), uniform(0.1, 0.4)});
      const double mass_kg = std::exp(uniform(0.0, 6.0));
      Body out = make_body(
          shape, mass_of(mass_kg, mass_kg * Vec3(0.05)),
          {at_m, glm::normalize(Quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), 1.0))});
      out.motion.velocity = {vector(2.0), vector(2.0)};
      return out;
    };
    Body a = body(Vec3(0.0)), b = body(glm::normalize(vector(1.0)) * uniform(0.3, 0.8));
    const auto momentum = [](const Body& of) {
      return (of.motion.world_from_body.rotation * of.motion.velocity.linear) * of.mass[0];
    };
    const double energy =
        kinetic_energy(a.mass, a.motion.velocity) + kinetic_energy(b.mass, b.motion.velocity);
    // The impulses of one step; attitudes as they are, so that axes do not turn meanwhile.
    PairBody pa{a.shape, a.inverse_mass, a.motion.world_from_body, a.motion},
        pb{b.shape, b.inverse_mass, b.motion.world_from_body, b.motion};
    const Vec3 before = momentum(a) + momentum(b);
    if (!part_bodies(pa, pb, uniform(0.0, 1.0), kPairStep_s, pair_memory)) continue;
    ++met;
    const Vec3 after = (a.motion.world_from_body.rotation * pa.free.velocity.linear) * a.mass[0] +
                       (b.motion.world_from_body.rotation * pb.free.velocity.linear) * b.mass[0];
    EXPECT_LT(glm::distance(before, after), 1e-9 * (1.0 + glm::length(before))) << index;
    const double now =
        kinetic_energy(a.mass, pa.free.velocity) + kinetic_energy(b.mass, pb.free.velocity);
    EXPECT_LE(now, energy * (1.0 + 1e-9) + 1e-12) << index;
  }
  EXPECT_GT(met, 100);
}

// Contacts bind to first order in a step's way and turn: of steps of centimetres nobody is deeper
// than the edges are round; of steps of up to 1.5 m nobody is passed, and then led out.
TEST(BodyPair, NobodyGetsIntoTheOtherNorPastIt) {
  for (const double dt_s : {1e-3, kPairStep_s, 0.05, 0.3})
    for (const double speed_m_s : {0.1, 1.0, 5.0}) {
      BodyShape frame;
      frame.add_box({}, {0.2, 0.1, 0.2});
      frame.add_capsule({-0.2, 0.15, 0.0}, {0.2, 0.15, 0.0}, 0.05);
      Body a = make_body(frame, mass_of(13.5, Vec3(0.3)), {{-1.0, 0.02, 0.01}, kAsBuilt});
      Body b = make_body(frame, mass_of(13.5, Vec3(0.3)),
                         {{1.0, -0.03, 0.0}, glm::angleAxis(0.4, Vec3(0, 0.6, 0.8))});
      a.motion.velocity.linear.x = speed_m_s;
      bool met = false;
      for (int i = 0; i < 4000 && i * dt_s < 25.0; ++i) {
        const bool meets = step_pair(a, b, 0.3, dt_s);
        if (speed_m_s * dt_s < 0.1) {
          ASSERT_LT(depth_of(a, b), 0.005) << dt_s << " s, " << speed_m_s << " m/s, step " << i;
        }
        if (meets && !met) {  // from here on they may slide off each other
          ASSERT_LT(a.motion.world_from_body.position_m.x, b.motion.world_from_body.position_m.x)
              << dt_s << " s, " << speed_m_s << " m/s, step " << i;
        }
        met = met || meets;
      }
      EXPECT_EQ(met, speed_m_s * std::min(25.0, 4000 * dt_s) > 1.6) << dt_s << " " << speed_m_s;
      EXPECT_LT(depth_of(a, b), 0.005) << dt_s << " " << speed_m_s;
    }
}

TEST(BodyPair, WhatIsPutIntoTheOtherIsPushedOut) {
  Body a = ball(10.0, 0.0, 0.0), b = ball(20.0, 0.25, 0.0);
  for (int i = 0; i < 240; ++i) step_pair(a, b, 0.3, kPairStep_s);
  EXPECT_LT(depth_of(a, b), 1e-4);
  EXPECT_LT(glm::length(a.motion.velocity.linear), 1e-9);  // and carries no energy away
  // By masses: the lighter one goes twice as far.
  EXPECT_NEAR(a.motion.world_from_body.position_m.x, -0.1, 1e-3);
  EXPECT_NEAR(b.motion.world_from_body.position_m.x, 0.3, 1e-3);
}

}  // namespace
}  // namespace neritic::sim
