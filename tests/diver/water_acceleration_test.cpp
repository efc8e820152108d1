// Divers in water that speeds up, against closed forms.
#include <gtest/gtest.h>

#include "diver/human_step.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

constexpr double kMoved_s = 1.0 / 240.0;

// Weight and buoyancy of every segment, and their centres, alike: what floats in itself.
Body floating() {
  return weightless(body_with(Gear{}));
}

// All of the water gathers speed evenly. A neutral body goes along, in any attitude and posture,
// though the water that moves along differs along each axis; limbs that rest feel nothing, and drag
// takes nothing from what does not move through the water.
TEST(DiverWaterAcceleration, WhoFloatsMovesWithWaterThatGathersSpeed) {
  const Vec3 a(0.3, -0.2, 0.1);
  for (std::uint64_t index = 0; index < 6; ++index) {
    const Body body = floating();
    RootState root;
    root.position_ned_m.z = 100.0;
    root.attitude = HumanDraws(index).attitude();
    const Quat attitude = root.attitude;
    LimbState limbs;
    limbs.rotation = swinging(index, 0.3);
    for (int i = 0; i < 2400; ++i)
      move_root(body, root, limbs, limbs, {}, {a * (i * kMoved_s), a, a}, kMoved_s);
    EXPECT_LT(glm::length(root.attitude * root.velocity.linear() - 10.0 * a), 1e-8) << index;
    EXPECT_LT(glm::length(root.velocity.angular()), 1e-8) << index;
    EXPECT_LT(1.0 - std::abs(glm::dot(root.attitude, attitude)), 1e-9) << index;
    EXPECT_LT(glm::length(root.position_ned_m - Vec3(0.0, 0.0, 100.0) - 50.0 * a), 1e-7) << index;
  }
}

// A swimmer in water that gathers speed swims as in still water, seen from the water.
TEST(DiverWaterAcceleration, ASwimmerWhoFloatsSwimsAsInStillWater) {
  const Body body = floating();
  const Vec3 a(0.1, 0.2, 0.0), start(0.0, 0.0, 100.0);
  RootState still, carried;
  still.position_ned_m = carried.position_ned_m = start;
  LimbState limbs;
  limbs.rotation = swinging(3, 0.0);
  for (int i = 0; i < 480; ++i) {
    const LimbState before = limbs;
    follow_limbs(limbs, swinging(3, i * kMoved_s), kMoved_s);
    const LimbWork a_work = move_root(body, still, before, limbs, {}, Vec3(0.0), kMoved_s);
    const LimbWork b_work =
        move_root(body, carried, before, limbs, {}, {a * (i * kMoved_s), a, a}, kMoved_s);
    ASSERT_NEAR(a_work.power_w, b_work.power_w, 1e-6 * (1.0 + std::abs(a_work.power_w)));
  }
  EXPECT_LT(glm::length(carried.position_ned_m - still.position_ned_m - 2.0 * a), 1e-8);
  EXPECT_NEAR(std::abs(glm::dot(carried.attitude, still.attitude)), 1.0, 1e-10);
}

// The momentum balance of a body that is heavier than water, without drag: it gains
// (rho V + M_A) a t less what M_A keeps of the water's own, in closed form for one whose added mass
// is the same along each axis: v = (rho V + m_a) / (m + m_a) a t, 3 / (1 + 2 s) for a sphere (Lamb
// 1932, art. 92).
TEST(DiverWaterAcceleration, WhatIsHeavierTakesItsShare) {
  Body body = without_drag(floating());
  // A sphere: all mass, volume and added mass at the hips.
  for (SegmentBody& segment : body.segments) segment = {segment.joint_m};
  for (std::size_t i = 0; i < body.part_count; ++i)
    body.parts[i].volume_m3 = body.parts[i].suit_gas_m3 = 0.0;
  Part& ball = body.parts[0];
  ASSERT_EQ(ball.segment, static_cast<std::size_t>(kPelvis));
  ball.start_m = -0.5 * ball.length_m * ball.segment_from_part[0];
  ball.volume_m3 = 0.1;
  const double rho_v = body.water_kg_m3 * ball.volume_m3;
  for (const double density : {0.5, 1.0, 2.7}) {
    SegmentBody& pelvis = body.segments[kPelvis];
    pelvis.mass_kg = density * rho_v;
    pelvis.rigid = rigid_mass(pelvis.mass_kg, Vec3(0.0), Mat3(2.0));
    pelvis.mass = pelvis.rigid;
    pelvis.mass += rigid_mass(0.5 * rho_v, Vec3(0.0), Mat3(0.0));
    RootState root;
    root.position_ned_m.z = 100.0;
    root.attitude = HumanDraws(5).attitude();
    const Vec3 a(0.4, -0.3, 0.0);
    const LimbState limbs;
    for (int i = 0; i < 480; ++i)
      move_root(body, root, limbs, limbs, {}, {a * (i * kMoved_s), a, a}, kMoved_s);
    const Vec3 velocity = root.attitude * root.velocity.linear();
    EXPECT_LT(glm::length(Vec3(velocity.x, velocity.y, 0.0) - 6.0 / (1.0 + 2.0 * density) * a),
              1e-8)
        << density;
    // And sinks or rises by its weight in water over all the mass that moves.
    EXPECT_NEAR(velocity.z, 2.0 * (density - 1.0) / (density + 0.5) * kGravity_m_s2, 1e-7);
  }
}

// Between converging walls of water, u = k (x, -y): what drifts follows x e^(kt), y e^(-kt), though
// its own current changes otherwise than the water's. A body stretched out flat in z feels no turn.
TEST(DiverWaterAcceleration, WhoFloatsFollowsTheWatersPathThroughAStrain) {
  Body body = without_drag(floating());
  for (SegmentBody& segment : body.segments) segment = {segment.joint_m};
  for (std::size_t i = 0; i < body.part_count; ++i)
    body.parts[i].volume_m3 = body.parts[i].suit_gas_m3 = 0.0;
  body.parts[0].start_m = -0.5 * body.parts[0].length_m * body.parts[0].segment_from_part[0];
  body.parts[0].volume_m3 = 0.1;
  SegmentBody& pelvis = body.segments[kPelvis];
  pelvis.mass_kg = body.water_kg_m3 * 0.1;
  pelvis.rigid = pelvis.mass = rigid_mass(pelvis.mass_kg, Vec3(0.0), Mat3(2.0));
  pelvis.mass += rigid_mass(0.5 * pelvis.mass_kg, Vec3(0.0), Mat3(0.0));
  const double k = 0.5;
  const auto miss_m = [&](double dt_s) {
    RootState root;
    root.position_ned_m = {0.5, 4.0, 100.0};
    root.velocity[0] = 0.5 * k, root.velocity[1] = -4.0 * k;
    const LimbState limbs;
    for (int i = 0; i < std::lround(4.0 / dt_s); ++i) {
      const Vec3 v = root.attitude * root.velocity.linear();
      const Vec3 half_way = root.position_ned_m + 0.5 * dt_s * v;
      const Vec3 change = k * Vec3(v.x, -v.y, 0.0);
      const Vec3 current = k * Vec3(half_way.x, -half_way.y, 0.0);
      move_root(body, root, limbs, limbs, {},
                {current - 0.5 * dt_s * change, change, k * k * Vec3(half_way.x, half_way.y, 0.0)},
                dt_s);
    }
    return glm::length(root.position_ned_m -
                       Vec3(0.5 * std::exp(4.0 * k), 4.0 * std::exp(-4.0 * k), 100.0));
  };
  const double coarse_m = miss_m(1.0 / 60.0), fine_m = miss_m(1.0 / 120.0);
  EXPECT_LT(fine_m, 1e-4);
  EXPECT_NEAR(coarse_m / fine_m, 4.0, 0.3);
}

// By way of a whole diver's step, in parts too: a swell of 8 s carries a diver who hovers, and what
// is no number is refused and the last value held.
TEST(DiverWaterAcceleration, ADiverIsCarriedByASwell) {
  const Body body = body_with(Gear{});
  const auto swell = [&](bool pulls, double dt_s) {
    HumanState state =
        start_at(body, {0.0, 0.0, 12.0}, {1.0, 0.0, 0.0, 0.0}, rotations_of(streamlined(body)));
    HumanInputs inputs;
    const double w = 2.0 * kPi / 8.0;
    double most = 0.0, least = 0.0;
    for (int i = 0; i * dt_s < 24.0; ++i) {
      // The water half way through the step, as a scene has it.
      const double t = (i + 0.5) * dt_s;
      const Vec3 a(0.0, 0.5 * w * std::cos(w * t), 0.0);
      inputs.current_ned_m_s = Vec3(0.0, 0.5 * std::sin(w * t), 0.0);
      if (pulls) inputs.current_ned_m_s -= 0.5 * dt_s * a;
      if (pulls) inputs.current_change_ned_m_s2 = inputs.water_acceleration_ned_m_s2 = a;
      state = step(body, state, inputs, dt_s);
      const double y = state.root.position_ned_m.y;
      if (t > 8.0) most = std::max(most, y), least = std::min(least, y);
    }
    return most - least;
  };
  // The water goes to and fro by 2 * 0.5 / w = 1.27 m; across it a diver of about its density goes
  // nearly all of that.
  const double carried_m = swell(true, kMoved_s), dragged_m = swell(false, kMoved_s);
  EXPECT_NEAR(carried_m, 1.27, 0.07);
  EXPECT_LT(dragged_m, carried_m - 0.05);
  EXPECT_NEAR(swell(true, 0.05), carried_m, 0.02);

  HumanInputs good;
  good.water_acceleration_ned_m_s2 = {0.2, 0.0, 0.0};
  const HumanState start = start_at(body, {0.0, 0.0, 12.0}, {1.0, 0.0, 0.0, 0.0});
  for (const double wrong : {static_cast<double>(NAN), static_cast<double>(INFINITY), -1e3}) {
    const HumanState state = step(body, start, good, kMoved_s);
    HumanInputs bad = good;
    bad.water_acceleration_ned_m_s2.z = bad.current_change_ned_m_s2.y = wrong;
    const HumanState after = step(body, state, bad, kMoved_s);
    EXPECT_EQ(after.refused_inputs, 2u);
    EXPECT_EQ(after.root.velocity, step(body, state, good, kMoved_s).root.velocity);
  }
}

}  // namespace
}  // namespace neritic::diver
