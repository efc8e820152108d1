#include "engine/sim/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "engine/core/hash.hpp"
#include "engine/core/random.hpp"
#include "tests/sim/bodies.hpp"
#include "tests/support/support.hpp"

namespace neritic::sim {
namespace {

using test::Body, test::box_mesh, test::make_body, test::make_box_body, test::Mesh,
    test::sheet_mesh, test::step, test::world_of;

const Vec3 kRov(0.23, 0.14, 0.29);  // half sizes of a vehicle of 13.5 kg
constexpr double kStep_s = 1.0 / 240.0;

Pose tilted(const Vec3& at_m) {
  return {at_m, glm::angleAxis(0.3, glm::normalize(Vec3(1.0, 0.5, 0.2)))};
}
Mesh bumpy_mesh() {
  Mesh mesh = sheet_mesh(5.0, 5.0, 60);
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i)
    mesh.vertices_m[i].y = 0.08f * static_cast<float>(random_uniform({8, 0, 0}, i));
  return mesh;
}
StaticWorld bumpy_seabed() {
  const Mesh mesh = bumpy_mesh();
  std::vector<float> heights;
  for (const Vec3f& v : mesh.vertices_m) heights.push_back(v.y);
  StaticWorldBuilder builder;
  const auto shape = builder.add_heights(61, 61, 10.0 / 60.0, heights, "seabed");
  EXPECT_TRUE(shape.ok());
  builder.place(*shape, {}, {});
  return builder.build();
}

constexpr int kMinutes_s = neritic::test::kFast ? 120 : 20,
              kMinute_s = neritic::test::kFast ? 60 : 3;

// Dropped; at rest after ten seconds; then no move for so long.
void expect_rest(const StaticWorld& world, Body body, int duration_s) {
  for (int i = 0; i < 2400; ++i) step(body, world, kStep_s);
  const Pose rest = body.motion.world_from_body;
  double farthest_m = 0.0, lowest_m = 0.0, deepest_m = 0.0;
  for (int i = 0; i < duration_s * 240; ++i) {
    step(body, world, kStep_s);
    const Vec3 way = body.motion.world_from_body.position_m - rest.position_m;
    farthest_m = std::max(farthest_m, glm::length(way));
    lowest_m = std::min(lowest_m, way.y);
    deepest_m = std::max(deepest_m, body.report.deepest_m);
  }
  EXPECT_LT(farthest_m, 1e-6);
  EXPECT_GT(lowest_m, -1e-6);
  EXPECT_LT(deepest_m, 2e-6);
  EXPECT_LT(glm::length(body.motion.velocity.linear), 1e-9);
  EXPECT_LT(glm::length(body.motion.velocity.angular), 1e-9);
  const double turn =
      glm::angle(body.motion.world_from_body.rotation * glm::conjugate(rest.rotation));
  EXPECT_LT(std::min(turn, 2.0 * kPi - turn), 1e-6);
}

TEST(Rest, OnAFlatSeabedForMinutes) {
  expect_rest(test::flat_seabed(), make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07))),
              kMinutes_s);
}
TEST(Rest, OnABumpySeabedForMinutes) {
  expect_rest(bumpy_seabed(), make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07))), kMinutes_s);
}
TEST(Rest, OnAMeshForMinutes) {
  expect_rest(world_of(box_mesh(Vec3(3.0), 7), {{Vec3(0.0, -3.0, 0.0), Quat(1, 0, 0, 0)}}),
              make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07))), kMinutes_s);
}
TEST(Rest, OnAPlaneOfTwoLargeTriangles) {
  expect_rest(world_of(sheet_mesh(500.0, 500.0, 1)),
              make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07))), 20);
}
TEST(Rest, OnASlopeThatFrictionHolds) {
  expect_rest(
      world_of(sheet_mesh(20.0, 20.0, 37), {{Vec3(0.0), glm::angleAxis(0.3, Vec3(1.0, 0.0, 0.0))}}),
      make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07))), 20);
}
TEST(Rest, OnANarrowPost) {
  expect_rest(
      world_of(box_mesh(Vec3(0.05, 1.0, 0.08)), {{Vec3(0.1, -1.0, 0.05), Quat(1, 0, 0, 0)}}),
      make_box_body(kRov, 13.5, {Vec3(0.13, 0.3, 0.07), Quat(1, 0, 0, 0)}), 20);
}
TEST(Rest, AHundredKilometresOut) {
  const Vec3 far_m(1e5, -30.0, -7e4);
  expect_rest(test::flat_seabed({}, far_m),
              make_box_body(kRov, 13.5, tilted(far_m + Vec3(0.13, 0.6, 0.07))), 20);
}
TEST(Rest, WithAThousandTimesTheWeight) {
  Body body = make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07)));
  body.force_n *= 1000.0;
  expect_rest(test::flat_seabed(), body, 20);
}
// A frame, two skids and a float, as vehicles have them.
TEST(Rest, AVehicleOfSeveralParts) {
  BodyShape shape;
  shape.add_box({Vec3(0.0, 0.08, 0.0), Quat(1, 0, 0, 0)}, Vec3(0.2, 0.06, 0.25));
  for (const double side : {-1.0, 1.0})
    shape.add_capsule(Vec3(0.18 * side, -0.12, -0.25), Vec3(0.18 * side, -0.12, 0.25), 0.02);
  shape.add_sphere(Vec3(0.0, -0.02, -0.2), 0.05);
  Body body =
      make_body(shape, test::mass_of(13.5, Vec3(0.3, 0.35, 0.25)), tilted(Vec3(0.13, 0.6, 0.07)));
  body.force_n = Vec3(0.0, -13.5, 0.0);
  expect_rest(test::flat_seabed(), body, 20);
  expect_rest(bumpy_seabed(), body, 20);
}

TEST(Motion, WhatTouchesNothingKeepsItsBits) {
  const StaticWorld world = test::flat_seabed();
  BodyShape shape;
  shape.add_box({}, kRov);
  const InverseMass inverse = test::inverse_of(test::mass_of(13.5, Vec3(0.3)));
  const Pose before = tilted(Vec3(1.0, 2.0, 3.0));
  const BodyMotion free{tilted(Vec3(1.01, 2.02, 2.99)), {Vec3(0.1, 0.2, 0.3), Vec3(1.0, 2.0, 3.0)}};
  MotionReport report;
  const BodyMotion after = move_body(world, shape, inverse, before, free, kStep_s, &report);
  EXPECT_EQ(test::motion_hash(after), test::motion_hash(free));
  EXPECT_FALSE(report.touched);
  // Near, but going away.
  const Pose low{Vec3(0.0, 0.141, 0.0), Quat(1.0, 0.0, 0.0, 0.0)};
  const BodyMotion up{{Vec3(0.0, 0.15, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}, {Vec3(0.0, 2.0, 0.0)}};
  const BodyMotion risen = move_body(world, shape, inverse, low, up, kStep_s, &report);
  EXPECT_EQ(test::motion_hash(risen), test::motion_hash(up));
  EXPECT_GT(report.contacts, 0);
}

TEST(Motion, ASlidingBoxStopsWhereTheTextbookSays) {
  // s = v^2 / (2 mu g); g is 1 m/s^2 here, mu 0.5: 4 m from 2 m/s. Half a step's way of tolerance.
  for (const int cuts : {1, 50, 400}) {
    const StaticWorld world = world_of(sheet_mesh(20.0, 20.0, cuts), {}, {.friction = 0.5});
    Body box = make_box_body(kRov, 13.5, {Vec3(-3.013, 0.14, 0.021), Quat(1, 0, 0, 0)});
    box.motion.velocity.linear.x = 2.0;
    for (int i = 0; i < 5 * 240; ++i) step(box, world, kStep_s);
    EXPECT_NEAR(box.motion.world_from_body.position_m.x, -3.013 + 4.0, 2.0 * kStep_s) << cuts;
    EXPECT_NEAR(box.motion.world_from_body.position_m.z, 0.021, 1e-6) << cuts;
    EXPECT_LT(glm::length(box.motion.velocity.linear), 1e-9);
  }
}

TEST(Motion, ABouncingBallKeepsItsHeights) {
  // From h it returns to e^2 h.
  const StaticWorld world = test::flat_seabed({.friction = 0.0, .restitution = 0.7});
  BodyShape shape;
  shape.add_sphere(Vec3(0.0), 0.1);
  Body ball =
      make_body(shape, test::mass_of(10.0, Vec3(0.04)), {Vec3(0.2, 1.1, 0.3), Quat(1, 0, 0, 0)});
  ball.force_n = Vec3(0.0, -98.2, 0.0);
  double highest_m = 0.0;
  bool bounced = false;
  for (int i = 0; i < 2400 && !(bounced && ball.motion.velocity.linear.y < 0.0); ++i) {
    step(ball, world, 1e-3);
    bounced = bounced || ball.report.touched;
    if (bounced) highest_m = std::max(highest_m, ball.motion.world_from_body.position_m.y - 0.1);
  }
  EXPECT_NEAR(highest_m, 0.49, 0.01);
}

// How deep any point of the body's core is in a box at the origin.
double depth_in_box(const Body& body, const Vec3& half_m) {
  double deepest_m = 0.0;
  for (const ConvexPart& part : body.shape.parts())
    for (const Vec3& p : part.core_m) {
      const Vec3 in = half_m - glm::abs(body.motion.world_from_body * p);
      deepest_m = std::max(deepest_m, std::min({in.x, in.y, in.z}));
    }
  return deepest_m;
}

TEST(Motion, AMinuteOfFullThrustIntoABoxNeverGetsInside) {
  const Vec3 half(1.0);
  for (const int cuts : {1, 7}) {
    const StaticWorld world = world_of(box_mesh(half, cuts));
    for (std::uint64_t kind = 0; kind < 6; ++kind) {
      const auto uniform = [&](std::uint64_t i) { return random_uniform({9, kind, 0}, i) - 0.5; };
      const Quat turn =
          glm::angleAxis(6.0 * uniform(0), glm::normalize(Vec3(uniform(1), uniform(2), 0.3)));
      Body body = make_box_body(kRov, 13.5, {Vec3(uniform(3), uniform(4), 2.0), turn});
      body.mass = test::mass_of(13.5, Vec3(0.26, 0.23, 0.37), Vec3(6.36, 7.12, 18.68),
                                Vec3(0.189, 0.135, 0.222));
      body.inverse_mass = test::inverse_of(body.mass);
      body.drag_n_s_m = 30.0;
      double deepest_m = 0.0, fastest_m_s = 0.0;
      for (int i = 0; i < kMinute_s * 240; ++i) {
        // Towards the middle with more than the vehicle's largest pure wrench, and turning.
        body.force_n = -210.0 * glm::normalize(body.motion.world_from_body.position_m);
        body.torque_nm = 10.0 * Vec3(std::sin(i * 0.011), std::cos(i * 0.007), uniform(5)) -
                         3.0 * body.motion.velocity.angular;
        step(body, world, kStep_s);
        deepest_m = std::max(deepest_m, depth_in_box(body, half));
        fastest_m_s = std::max(fastest_m_s, glm::length(body.motion.velocity.linear));
      }
      // The core lies 5 mm within the vehicle's skin; a hard knock on a corner takes it 2 mm deep.
      EXPECT_LT(deepest_m, 0.002) << cuts << " " << kind;
      EXPECT_GT(fastest_m_s, 1.0);
    }
  }
}

TEST(Motion, NothingTunnelsAtAnySpeedAndStep) {
  // Through a sheet of no thickness, straight and tumbling, from 1 to 1000 m/s, in steps up to 1 s.
  const StaticWorld sheet = world_of(sheet_mesh(1e5, 1e5, 99));
  for (const double dt_s : {0.001, kStep_s, 0.05, 0.3, 1.0})
    for (const double speed_m_s : {1.0, 10.0, 100.0, 1000.0})
      for (const double spin_rad_s : {0.0, 3.0, 40.0}) {
        Body body = make_box_body(kRov, 13.5, tilted(Vec3(0.3, 3.0, -0.2)));
        body.force_n = Vec3(0.0, -10'000.0, 0.0);
        const Quat body_from_world = glm::conjugate(body.motion.world_from_body.rotation);
        body.motion.velocity = {body_from_world * Vec3(0.0, -speed_m_s, 0.0),
                                Vec3(spin_rad_s, 0.5 * spin_rad_s, 0.0)};
        for (int i = 0; i < 100; ++i) {
          step(body, sheet, dt_s);
          ASSERT_GT(body.motion.world_from_body.position_m.y, 0.1)
              << dt_s << " s, " << speed_m_s << " m/s, " << spin_rad_s << " rad/s, step " << i;
          ASSERT_TRUE(is_finite(body.motion.velocity.linear));
        }
      }
}

TEST(Motion, NoNumberHangsItOrLeavesAnythingButNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const StaticWorld world = bumpy_seabed();
  BodyShape shape;
  shape.add_box({}, kRov);
  const InverseMass inverse = test::inverse_of(test::mass_of(13.5, Vec3(0.3)));
  const Pose good{Vec3(0.0, 0.5, 0.0), Quat(1, 0, 0, 0)};
  const double kValues[] = {nan, std::numeric_limits<double>::infinity(), 1e300, 1e12, -1e6};
  for (const double value : kValues) {
    const Pose places[] = {{Vec3(0.0, value, 0.0), Quat(1, 0, 0, 0)},
                           {Vec3(value), Quat(1, 0, 0, 0)},
                           {Vec3(0.0, 0.3, 0.0), Quat(value, 0.0, 0.0, 0.0)}};
    for (const Pose& place : places) {
      // Not finite in, not finite out, but out: whoever steps refuses it.
      move_body(world, shape, inverse, good, {place, {Vec3(0.0, value, 0.0)}}, kStep_s);
      move_body(world, shape, inverse, place, {good, {Vec3(value, 0.0, 0.0)}}, kStep_s);
      world.cast(place.position_m, Vec3(0.0, -1.0, 0.0), 1e9);
    }
    world.cast(Vec3(0.0, 1.0, 0.0), Vec3(value, -1.0, 0.0), 1e9);
  }
  for (const double speed_m_s : {1e4, 1e6, 1e9}) {
    const Vec3 way(0.0, -speed_m_s, 0.0);
    const BodyMotion after = move_body(world, shape, inverse, good,
                                       {{good.position_m + way, good.rotation}, {way}}, 1.0);
    EXPECT_GT(after.world_from_body.position_m.y, 0.1) << speed_m_s;
    EXPECT_TRUE(is_finite(after.velocity.linear) && is_finite(after.velocity.angular));
  }
}

TEST(Motion, ATeleportIntoAMeshIsLedOut) {
  const Vec3 half(1.0, 0.8, 1.2);
  for (const int cuts : {1, 6})
    for (std::uint64_t i = 0; i < 10; ++i) {
      const StaticWorld world = world_of(box_mesh(half, cuts));
      const auto uniform = [&](std::uint64_t n) {
        return 2.0 * random_uniform({10, n, 0}, i) - 1.0;
      };
      Body body =
          make_box_body(kRov, 13.5, tilted(Vec3(uniform(0), uniform(1), uniform(2)) * half * 0.99));
      body.force_n = Vec3(0.0);
      double fastest_m_s = 0.0;
      for (int k = 0; k < 480; ++k) {
        step(body, world, kStep_s);
        fastest_m_s = std::max(fastest_m_s, glm::length(body.motion.velocity.linear));
      }
      EXPECT_LT(depth_in_box(body, half), 0.001) << cuts << " " << i;
      EXPECT_LT(fastest_m_s, 1e-9);  // led out, not thrown out
    }
}

TEST(Motion, ATeleportBelowTheSeabedIsLedUp) {
  Body body = make_box_body(kRov, 13.5, tilted(Vec3(0.4, -3.0, 0.2)));
  const StaticWorld world = bumpy_seabed();
  for (int i = 0; i < 20 * 240; ++i) step(body, world, kStep_s);
  EXPECT_GT(body.motion.world_from_body.position_m.y, 0.1);
  EXPECT_LT(glm::length(body.motion.velocity.linear), 1e-6);
}

TEST(Motion, EnergyNeverGrowsWithoutInputWhateverIsTouched) {
  const StaticWorld world = bumpy_seabed();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Body body = make_box_body(kRov, 13.5, tilted(Vec3(0.2, 0.5, 0.1)));
    body.mass = test::mass_of(13.5, Vec3(0.26, 0.23, 0.37), Vec3(6.36, 7.12, 18.68),
                              Vec3(0.189, 0.135, 0.222));
    body.inverse_mass = test::inverse_of(body.mass);
    body.force_n = Vec3(0.0);
    const auto uniform = [&](std::uint64_t i) { return random_uniform({11, seed, 0}, i) - 0.5; };
    body.motion.velocity = {Vec3(uniform(0), uniform(1) - 1.0, uniform(2)),
                            10.0 * Vec3(uniform(3), uniform(4), uniform(5))};
    const double first_j = test::kinetic_energy(body.mass, body.motion.velocity);
    for (int i = 0; i < 1200; ++i) {
      step(body, world, kStep_s);
      ASSERT_LE(test::kinetic_energy(body.mass, body.motion.velocity),
                body.free_energy_j * (1.0 + 1e-12))
          << seed << " " << i;
    }
    EXPECT_LT(test::kinetic_energy(body.mass, body.motion.velocity), first_j);
  }
}

std::uint64_t tumble_hash(const StaticWorld& world) {
  Body body = make_box_body(kRov, 13.5, tilted(Vec3(0.13, 0.6, 0.07)));
  body.motion.velocity = {Vec3(1.0, 0.0, 0.5), Vec3(2.0, 3.0, -1.0)};
  Hash64 hash;
  for (int i = 0; i < 240; ++i) {
    step(body, world, kStep_s);
    hash.add(test::motion_hash(body.motion));
  }
  return hash.value();
}

TEST(Motion, AHundredRunsAlsoOnBusyCoresHaveTheSameHash) {
  const StaticWorld world = bumpy_seabed();
  const std::uint64_t first = tumble_hash(world);
  for (int run = 0; run < 50; ++run) ASSERT_EQ(tumble_hash(bumpy_seabed()), first) << run;
  // The same world from several threads at once.
  std::array<int, 5> wrong{};
  std::vector<std::thread> threads;
  for (int& count : wrong)
    threads.emplace_back([&world, first, &count] {
      for (int run = 0; run < 10; ++run) count += tumble_hash(world) != first;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace neritic::sim
