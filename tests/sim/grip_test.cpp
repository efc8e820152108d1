// A body that holds a point mass: momentum, and that both move alike.
#include "engine/sim/grip.hpp"

#include <gtest/gtest.h>

namespace neritic::sim {
namespace {

// A box of 20 kg, its own inertia.
InverseMass box() {
  InverseMass m{};
  for (std::size_t i = 0; i < 3; ++i) m[7 * i] = 1.0 / 20.0;
  m[21] = 1.0 / 0.5, m[28] = 1.0 / 0.4, m[35] = 1.0 / 0.9;
  return m;
}

TEST(Grip, GrabbingKeepsMomentumAndMakesBothMoveAlike) {
  BodyMotion body{{Vec3(1.0, 2.0, 3.0), glm::angleAxis(0.8, glm::normalize(Vec3(1.0, 2.0, -1.0)))},
                  {Vec3(0.4, -0.2, 0.1), Vec3(0.3, -0.5, 0.2)}};
  Held held{Vec3(0.3, -0.1, -0.5), Vec3(-0.2, 0.6, 0.1), 5.0};
  const Quat q = body.world_from_body.rotation;
  const Vec3 place = q * held.at_m;
  const auto linear = [&] { return 20.0 * (q * body.velocity.linear) + 5.0 * held.velocity_m_s; };
  const auto angular = [&] {
    return q * (Vec3(0.5, 0.4, 0.9) * body.velocity.angular) +
           glm::cross(place, 5.0 * held.velocity_m_s);
  };
  const auto energy = [&] {
    return 10.0 * glm::dot(body.velocity.linear, body.velocity.linear) +
           0.5 * glm::dot(body.velocity.angular, Vec3(0.5, 0.4, 0.9) * body.velocity.angular) +
           2.5 * glm::dot(held.velocity_m_s, held.velocity_m_s);
  };
  const Vec3 p = linear(), l = angular();
  const double e = energy();
  const Vec3 impulse = grip_impulse(box(), body, held);
  hold(box(), impulse, 0.0, body, held);
  EXPECT_LT(glm::length(linear() - p), 1e-12);
  EXPECT_LT(glm::length(angular() - l), 1e-12);
  EXPECT_LT(glm::length(held.velocity_m_s - point_velocity(body, held.at_m)), 1e-12);
  EXPECT_LT(energy(), e);  // a grab takes energy
  // Again nothing is to be done.
  EXPECT_LT(glm::length(grip_impulse(box(), body, held)), 1e-12);
}

TEST(Grip, AHeavyThingStopsTheBodyAndALightOneHardlyFeelsIt) {
  for (const double kg : {1e-6, 1e9}) {
    BodyMotion body{{Vec3(0.0), Quat(1.0, 0.0, 0.0, 0.0)}, {Vec3(1.0, 0.0, 0.0), Vec3(0.0)}};
    Held held{Vec3(0.0), Vec3(0.0), kg};
    hold(box(), grip_impulse(box(), body, held), 0.0, body, held);
    EXPECT_NEAR(body.velocity.linear.x, 20.0 / (20.0 + kg), 1e-9);
    EXPECT_NEAR(held.velocity_m_s.x, body.velocity.linear.x, 1e-9);
  }
}

}  // namespace
}  // namespace neritic::sim
