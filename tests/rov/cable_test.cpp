// The cable against closed forms (catenary, critical angle, hanging chain), an integration of its
// equilibrium along the line, and at extremes.
#include "rov/cable.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace neritic::rov {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// A cable between fixed ends, or with a free or loaded one.
struct Rig {
  Cable cable;
  double length_m = 50.0;
  Vec3 top{0.0}, end{0.0};
  Mat3 end_mass{1e9};  // fixed
  Vec3 end_velocity{0.0};
  Vec3 current{0.0};
  double end_weight_n = 0.0;
  std::vector<CableContact> contacts{};
  std::vector<CableNode> nodes{};
  CableWork work{};

  void hang() {
    nodes.resize(cable.segments - 1);
    hang_cable(cable, length_m, top, end, nodes);
  }
  CablePull step(double dt_s) {
    CableEnds ends;
    ends.top_before_ned_m = ends.top_after_ned_m = top;
    Vec3 free = end_velocity;
    if (end_mass[0][0] > 0.0 && end_mass[0][0] < 1e8)
      free += dt_s * Vec3(0.0, 0.0, end_weight_n) / end_mass[0][0];
    ends.end_free_velocity_m_s = free;
    ends.end_before_velocity_m_s = end_velocity;
    ends.end_free_ned_m = end + dt_s * free;
    ends.end_mass_kg = end_mass;
    const std::vector<Vec3> currents(cable.segments + 1, current);
    const CablePull pull = step_cable(cable, length_m, ends, currents, contacts, dt_s, nodes, work);
    end_velocity = pull.end_velocity_m_s;
    end += dt_s * end_velocity;
    return pull;
  }
  CablePull settle(double dt_s, int steps) {
    CablePull pull;
    for (int i = 0; i < steps; ++i) pull = step(dt_s);
    return pull;
  }
};

Rig sinking(std::uint32_t segments) {
  Rig rig;
  rig.cable.segments = segments;
  rig.cable.net_weight_n_m = 1.0;
  rig.cable.stiffness_n = 1e7;
  rig.top = Vec3(0.0, 0.0, 5.0);
  rig.end = Vec3(40.0, 0.0, 8.0);
  return rig;
}

// The horizontal pull over the weight a metre, by bisection of 2 a sinh(d / 2 a) = sqrt(L^2 - h^2).
double catenary_a(double wide_m, double high_m, double length_m) {
  const double flat_m = std::sqrt(length_m * length_m - high_m * high_m);
  double low = 1e-3 * wide_m, high = 1e6 * wide_m;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2.0 * a * std::sinh(0.5 * wide_m / a) > flat_m ? low : high) = a;
  }
  return low;
}

TEST(RovCable, AtRestItHangsAsACatenaryAndPullsAsOne) {
  const double a = catenary_a(40.0, 3.0, 50.0);
  const double lowest_x = 20.0 + a * std::atanh(3.0 / 50.0);
  double last = 0.5;
  for (const std::uint32_t segments : {8u, 16u, 32u, 64u}) {
    Rig rig = sinking(segments);
    rig.cable.net_weight_n_m = -2.0;  // it starts as an arch
    rig.cable.diameter_m = 0.02;
    rig.hang();
    rig.cable.net_weight_n_m = 1.0;
    const CablePull pull = rig.settle(1.0, 400);
    // The end's force on the body: back along the line, a w across, up or down by what hangs there.
    const Vec3 force = pull.impulse_n_s / 1.0;
    const double expected = std::hypot(a, a * std::sinh((40.0 - lowest_x) / a));
    const double error = std::abs(glm::length(force) / expected - 1.0);
    EXPECT_LT(error, std::max(0.35 * last, 2e-4)) << segments;  // of second order: a quarter
    EXPECT_NEAR(-force.x, a, 0.02 * a) << segments;
    last = error;
    // Its lowest point.
    double deepest = 0.0;
    for (const CableNode& node : rig.nodes) deepest = std::max(deepest, node.position_ned_m.z);
    const double sag = 5.0 + a * (std::cosh(lowest_x / a) - 1.0);
    EXPECT_NEAR(deepest, sag, 4.0 / segments) << segments;
  }
}

TEST(RovCable, ItBeginsInItsCatenary) {
  Rig rig = sinking(32);
  rig.hang();
  const std::vector<CableNode> start = rig.nodes;
  rig.settle(1.0, 200);
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_LT(glm::distance(start[i].position_ned_m, rig.nodes[i].position_ned_m), 0.05) << i;
}

TEST(RovCable, TowedWithAFreeEndItStreamsAtTheCriticalAngle) {
  Rig rig = sinking(16);
  rig.end_mass = Mat3(0.0);
  rig.current = Vec3(0.8, 0.0, 0.0);
  rig.hang();
  const CablePull pull = rig.settle(1.0, 600);
  // w cos(a) = 1/2 rho C_n d U^2 sin(a)^2, a from the horizontal.
  const double drag = 0.5 * 1028.0 * 1.2 * 0.0076 * 0.64;
  const double c = (-1.0 + std::sqrt(1.0 + 4.0 * drag * drag)) / (2.0 * drag);
  const double angle = std::acos(c);
  const Vec3 way = rig.end - rig.top;
  EXPECT_NEAR(std::atan2(way.z, way.x), angle, 1e-3);
  EXPECT_NEAR(way.y, 0.0, 1e-9);
  const double along = std::sin(angle) + 0.5 * 1028.0 * kPi * 0.01 * 0.0076 * std::pow(0.8 * c, 2);
  // Half a segment hangs at the top itself.
  EXPECT_NEAR(pull.top_n, 50.0 * (1.0 - 0.5 / 16.0) * along, 0.005 * 50.0 * along);
}

// From the end's force up the line by Runge and Kutta's method, in steps far finer than segments:
// where the top would be.
Vec3 integrated_top(const Rig& rig, const Vec3& end_force_n) {
  const Cable& c = rig.cable;
  const auto load = [&](const Vec3& along) {
    const Vec3 t = glm::dot(rig.current, along) * along, n = rig.current - t;
    return Vec3(0.0, 0.0, c.net_weight_n_m) +
           0.5 * c.water_kg_m3 * c.diameter_m *
               (c.normal_drag * glm::length(n) * n + kPi * c.tangential_drag * glm::length(t) * t);
  };
  // Tension that the line above bears: what the body pulls, then the line's own load.
  Vec3 tension = -end_force_n, at = rig.end;
  const int steps = 4000;
  const double ds = rig.length_m / steps;
  for (int i = 0; i < steps; ++i) {
    const auto rate = [&](const Vec3& t) { return load(glm::normalize(t)); };
    const Vec3 k1 = rate(tension), k2 = rate(tension + 0.5 * ds * k1),
               k3 = rate(tension + 0.5 * ds * k2), k4 = rate(tension + ds * k3);
    const Vec3 next = tension + ds / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    at -= ds * glm::normalize(0.5 * (tension + next));
    tension = next;
  }
  return at;
}

TEST(RovCable, InACurrentItIsInEquilibriumAlongAllOfTheLine) {
  double errors[2];
  int k = 0;
  for (const std::uint32_t segments : {16u, 64u}) {
    Rig rig = sinking(segments);
    rig.cable.net_weight_n_m = 0.2;
    rig.current = Vec3(0.1, 0.5, 0.0);  // mostly across the line
    rig.hang();
    const CablePull pull = rig.settle(1.0, 800);
    errors[k++] = glm::distance(integrated_top(rig, pull.impulse_n_s / 1.0), rig.top);
  }
  EXPECT_LT(errors[0], 0.5);
  EXPECT_LT(errors[1], 0.1 * errors[0]);  // of second order: a sixteenth
}

TEST(RovCable, HangingInTheAirItSwingsAsAChainDoes) {
  // Bernoulli's chain: the slowest swing is j01 / 2 sqrt(g / L), J0(j01) = 0.
  Rig rig = sinking(32);
  rig.cable.water_kg_m3 = 0.0;
  rig.cable.net_weight_n_m = 1.0;
  rig.cable.damping_n_s = 0.0;
  rig.length_m = 10.0;
  rig.end_mass = Mat3(0.0);
  rig.nodes.resize(31);
  const double j01 = 2.404825557695773;
  const auto mode = [&](double below_m) {
    return 0.05 * std::cyl_bessel_j(0.0, j01 * std::sqrt(1.0 - below_m / 10.0));
  };
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    const double s = 10.0 * static_cast<double>(i + 1) / 32.0;
    rig.nodes[i].position_ned_m = rig.top + Vec3(mode(s), 0.0, s);
  }
  rig.end = rig.top + Vec3(mode(10.0), 0.0, 10.0);
  const double dt_s = 1.0 / 480.0;
  double last_x = rig.end.x;
  std::vector<double> crossings;
  for (int i = 1; crossings.size() < 3 && i < 20'000; ++i) {
    rig.step(dt_s);
    if ((last_x > 0.0) != (rig.end.x > 0.0))
      crossings.push_back((i - rig.end.x / (rig.end.x - last_x)) * dt_s);
    last_x = rig.end.x;
  }
  ASSERT_EQ(crossings.size(), 3u);
  const double expected_s = 2.0 * kPi / (0.5 * j01 * std::sqrt(9.80665 / 10.0));
  EXPECT_NEAR(crossings[2] - crossings[0], expected_s, 0.01 * expected_s);
}

TEST(RovCable, ABodyHangsOnItByItsWeightHoweverLightAndStiff) {
  for (const double mass_kg : {1e-3, 10.0, 1e4})
    for (const double stiffness_n : {1e3, 1e9}) {
      Rig rig = sinking(8);
      rig.cable.net_weight_n_m = 0.0;
      rig.cable.stiffness_n = stiffness_n;
      rig.end_mass = Mat3(mass_kg);
      rig.end_weight_n = mass_kg;
      rig.end = rig.top + Vec3(0.0, 0.0, 30.0);
      rig.hang();
      CablePull pull;
      for (int i = 0; i < 600; ++i) pull = rig.step(i < 300 ? 1.0 / 60.0 : 100.0);
      EXPECT_NEAR(pull.end_n, mass_kg, 1e-3 * mass_kg) << stiffness_n;
      EXPECT_NEAR(rig.end.z - rig.top.z, 50.0 * (1.0 + mass_kg / stiffness_n),
                  1e-3 * (50.0 + 50.0 * mass_kg / stiffness_n));
    }
}

TEST(RovCable, ItNeverPushes) {
  Rig rig = sinking(4);
  rig.cable.net_weight_n_m = 0.0;
  rig.end = rig.top + Vec3(10.0, 0.0, 0.0);
  rig.end_mass = Mat3(20.0);
  rig.hang();
  rig.end_velocity = Vec3(-3.0, 0.0, 0.0);
  const CablePull pull = rig.step(1.0 / 60.0);
  EXPECT_EQ(pull.most_n, 0.0);
}

TEST(RovCable, LyingOnTheFloorItPressesByItsWeightAndRubs) {
  // All of it slack on a floor at 10 m, its end towed along: the pull is friction of what slides.
  Rig rig = sinking(10);
  rig.cable.normal_drag = rig.cable.tangential_drag = 0.0;
  rig.length_m = 20.0;
  rig.top = Vec3(0.0, 0.0, 10.0);
  rig.end = Vec3(20.0, 0.0, 10.0);
  rig.nodes.resize(9);
  for (std::size_t i = 0; i < 9; ++i)
    rig.nodes[i].position_ned_m = Vec3(2.0 * static_cast<double>(i + 1), 0.0, 10.0);
  rig.end_mass = Mat3(0.0);
  const auto floor = [&] {
    rig.contacts.clear();
    for (std::uint32_t s = 0; s < 10; ++s)
      for (const double share : {0.0, 1.0}) {
        const Vec3 a = s == 0 ? rig.top : rig.nodes[s - 1].position_ned_m;
        const Vec3 b = s == 9 ? rig.end : rig.nodes[s].position_ned_m;
        const Vec3 at = a + share * (b - a);
        rig.contacts.push_back({s, share, Vec3(0.0, 0.0, -1.0), 10.0 - at.z, 0.4});
      }
  };
  CablePull pull;
  for (int i = 0; i < 240; ++i) floor(), pull = rig.step(1.0 / 240.0);
  EXPECT_GE(pull.touching, 9u);
  for (const CableNode& node : rig.nodes) {
    EXPECT_NEAR(node.position_ned_m.z, 10.0, 1e-4);
    EXPECT_LT(glm::length(node.velocity_ned_m_s), 1e-3);
  }
  // Pushed across, it slides until friction, 0.4 of its weight, has stopped it.
  for (CableNode& node : rig.nodes) node.velocity_ned_m_s.y = 0.5;
  rig.nodes.front().velocity_ned_m_s.y = 0.0;
  const double before = rig.nodes[7].position_ned_m.y;
  for (int i = 0; i < 480; ++i) floor(), rig.step(1.0 / 240.0);
  EXPECT_GT(rig.nodes[7].position_ned_m.y - before, 0.003);
  EXPECT_LT(glm::length(rig.nodes[7].velocity_ned_m_s), 2e-3);
}

TEST(RovCable, TheSameBitsAgainAndStepsOfAnyLengthAreFinite) {
  for (const double dt_s : {1e-9, 1e-3, 1.0, 1e4}) {
    Rig a = sinking(16), b = sinking(16);
    a.hang(), b.hang();
    a.current = b.current = Vec3(3.0, -2.0, 1.0);
    for (int i = 0; i < 20; ++i) {
      const CablePull pull = a.step(dt_s);
      if (dt_s <= 1.0) {
        EXPECT_TRUE(pull.converged) << dt_s << " step " << i;
      }
      b.step(dt_s);
    }
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
      EXPECT_EQ(a.nodes[i].position_ned_m, b.nodes[i].position_ned_m);
      EXPECT_LT(glm::length(a.nodes[i].position_ned_m), 200.0) << dt_s;
    }
  }
}

TEST(RovCable, BothEndsInOnePlaceOrAStraightOrOneSegmentDoNoHarm) {
  for (const double far_m : {0.0, 1e-12, 50.0, 50.0 * (1.0 + 1e-12), 500.0})
    for (const std::uint32_t segments : {1u, 2u, 128u}) {
      Rig rig = sinking(segments);
      rig.end = rig.top + Vec3(0.0, far_m, 0.0);
      rig.hang();
      for (int i = 0; i < 30; ++i) {
        const CablePull pull = rig.step(1.0 / 60.0);
        ASSERT_TRUE(pull.converged) << far_m << " " << segments;
        ASSERT_TRUE(std::isfinite(pull.most_n));
      }
    }
}

TEST(RovCable, WhatIsNoNumberLeavesItAsItWas) {
  Rig rig = sinking(8);
  rig.hang();
  const std::vector<CableNode> before = rig.nodes;
  rig.current = Vec3(kNoNumber, 0.0, 0.0);
  const CablePull pull = rig.step(1.0 / 60.0);
  EXPECT_FALSE(pull.converged);
  EXPECT_EQ(pull.impulse_n_s, Vec3(0.0));
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(rig.nodes[i].position_ned_m, before[i].position_ned_m);
}

TEST(RovCable, FaultsNameTheKey) {
  Cable cable;
  EXPECT_TRUE(check_cable(cable).ok());
  cable.segments = 0;
  EXPECT_THAT(check_cable(cable).error().message, testing::HasSubstr("tether.segments: found 0"));
  cable = {};
  cable.net_weight_n_m = -10.0;
  EXPECT_THAT(check_cable(cable).error().message, testing::HasSubstr("tether.net_weight_n_m"));
  cable = {};
  cable.stiffness_n = kNoNumber;
  EXPECT_THAT(check_cable(cable).error().message, testing::HasSubstr("tether.stiffness_n"));
}

TEST(RovCable, AWinchKeepsItsTensionWithinATenth) {
  EXPECT_EQ(winch_rate_m_s(20.0, 20.0, 0.5), 0.0);
  EXPECT_EQ(winch_rate_m_s(21.9, 20.0, 0.5), 0.0);
  EXPECT_EQ(winch_rate_m_s(100.0, 20.0, 0.5), 0.5);
  EXPECT_EQ(winch_rate_m_s(0.0, 20.0, 0.5), -0.5);
}

}  // namespace
}  // namespace neritic::rov
