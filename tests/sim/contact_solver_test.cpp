#include <gtest/gtest.h>

#include "engine/core/random.hpp"
#include "engine/sim/contact_memory.hpp"
#include "tests/sim/bodies.hpp"

namespace neritic::sim {
namespace {

using test::inverse_of, test::kinetic_energy, test::mass_of;

constexpr double kDt_s = 1.0 / 240.0;
constexpr double kRadius_m = 0.15;
const Vec3 kInertia(0.09);  // 2/5 m r^2 of a ball of 10 kg, r = 0.15 m

// Solutions lie in it until the next one.
SolverMemory solver_memory;

BodyContact under_a_ball(double friction, double restitution) {
  return {Vec3(0.0, -kRadius_m, 0.0), Vec3(0.0, 1.0, 0.0), 0.0, friction, restitution};
}

TEST(ContactSolver, ABallBouncesWithTheClosedFormsImpulse) {
  // J = (1 + e) m v, v' = e v.
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia));
  for (const double e : {0.0, 0.3, 0.8, 1.0}) {
    const BodyContact contact = under_a_ball(0.0, e);
    const auto solution = solve_contacts(std::span(&contact, 1), inverse, {Vec3(0.0, -2.0, 0.0)},
                                         kDt_s, solver_memory);
    EXPECT_NEAR(solution.impulses[0].normal_n_s, (1.0 + e) * 10.0 * 2.0, 1e-12) << e;
    EXPECT_NEAR(solution.velocity.linear.y, e * 2.0, 1e-13) << e;
  }
}

TEST(ContactSolver, AddedMassCountsInTheDirectionItIsAddedIn) {
  // Normal along y, where the water adds 6 kg; the other axes' added mass does not matter.
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia, Vec3(3.0, 6.0, 15.0)));
  const BodyContact contact = under_a_ball(0.0, 0.5);
  const auto solution =
      solve_contacts(std::span(&contact, 1), inverse, {Vec3(1.0, -2.0, 0.5)}, kDt_s, solver_memory);
  EXPECT_NEAR(solution.impulses[0].normal_n_s, 1.5 * 16.0 * 2.0, 1e-12);
  EXPECT_NEAR(solution.velocity.linear.x, 1.0, 1e-15);
  EXPECT_NEAR(solution.velocity.linear.z, 0.5, 1e-15);
}

TEST(ContactSolver, ObliqueNormalsMeetTheFullMassMatrix) {
  // J = -(1 + e) n.v / (n^T M^-1 n) for a force through the origin (e.g. Featherstone 2008, 11.7).
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia, Vec3(3.0, 6.0, 15.0)));
  const Vec3 n = glm::normalize(Vec3(1.0, 2.0, -0.5)), v(-1.0, -2.0, 0.7);
  const BodyContact contact{-kRadius_m * n, n, 0.0, 0.0, 0.4};
  const auto solution = solve_contacts(std::span(&contact, 1), inverse, {v}, kDt_s, solver_memory);
  const double mobility = n.x * n.x / 13.0 + n.y * n.y / 16.0 + n.z * n.z / 25.0;
  EXPECT_NEAR(solution.impulses[0].normal_n_s, -1.4 * glm::dot(n, v) / mobility, 1e-11);
}

TEST(ContactSolver, ASlidingBallLosesMuGAndSpinsUpAsTheTextbookSays) {
  // While it slides: v falls by mu g dt, spin grows by mu m g r / I dt, a step.
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia));
  constexpr double kMu = 0.2, kG = 9.82;
  const BodyContact contact = under_a_ball(kMu, 0.0);
  const auto solution = solve_contacts(std::span(&contact, 1), inverse,
                                       {Vec3(3.0, -kG * kDt_s, 0.0)}, kDt_s, solver_memory);
  EXPECT_NEAR(solution.velocity.linear.x, 3.0 - kMu * kG * kDt_s, 1e-12);
  EXPECT_NEAR(solution.velocity.angular.z, -kMu * 10.0 * kG * kRadius_m / 0.09 * kDt_s, 1e-12);
  EXPECT_NEAR(solution.velocity.linear.y, 0.0, 1e-13);
}

TEST(ContactSolver, FrictionStopsAndNeverTurnsRound) {
  const InverseMass inverse = inverse_of(mass_of(10.0, Vec3(1e9)));
  const BodyContact contact = under_a_ball(5.0, 0.0);
  const auto solution = solve_contacts(std::span(&contact, 1), inverse, {Vec3(0.01, -0.5, 0.02)},
                                       kDt_s, solver_memory);
  EXPECT_LT(glm::length(solution.velocity.linear), 1e-9);
}

TEST(ContactSolver, SlidingFrictionOpposesTheSlipAtTheConesEdge) {
  // Unequal masses along x and z: a pyramid, or a cone cut short, would push sideways.
  const InverseMass inverse = inverse_of(mass_of(10.0, Vec3(1e9), Vec3(0.0, 5.0, 40.0)));
  const BodyContact contact = under_a_ball(0.3, 0.0);
  const auto solution =
      solve_contacts(std::span(&contact, 1), inverse, {Vec3(2.0, -0.1, 1.0)}, kDt_s, solver_memory);
  const Vec3 slip(solution.velocity.linear.x, 0.0, solution.velocity.linear.z);
  const Vec3 friction = solution.impulses[0].friction_n_s;
  EXPECT_NEAR(glm::length(friction), 0.3 * solution.impulses[0].normal_n_s, 1e-12);
  EXPECT_NEAR(glm::dot(glm::normalize(friction), glm::normalize(slip)), -1.0, 1e-9);
}

TEST(ContactSolver, AContactAheadStopsTheBodyJustThere) {
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia));
  BodyContact contact = under_a_ball(0.0, 0.0);
  contact.gap_m = 0.002;
  const auto fast =
      solve_contacts(std::span(&contact, 1), inverse, {Vec3(0.0, -2.0, 0.0)}, kDt_s, solver_memory);
  EXPECT_NEAR(fast.velocity.linear.y * kDt_s, -0.002, 1e-15);
  const auto slow =
      solve_contacts(std::span(&contact, 1), inverse, {Vec3(0.0, -0.4, 0.0)}, kDt_s, solver_memory);
  EXPECT_EQ(slow.velocity.linear.y, -0.4);
  EXPECT_FALSE(slow.acted());
}

TEST(ContactSolver, DepthIsUndoneByAPushThatCarriesNoEnergy) {
  const InverseMass inverse = inverse_of(mass_of(10.0, kInertia));
  BodyContact contact = under_a_ball(0.0, 0.0);
  contact.gap_m = -0.01;
  const auto solution = solve_contacts(std::span(&contact, 1), inverse, {}, kDt_s, solver_memory);
  EXPECT_EQ(solution.velocity.linear, Vec3(0.0));
  EXPECT_GT(solution.push.linear.y, 0.1);
  EXPECT_LE(solution.push.linear.y * kDt_s, 0.01);
  contact.gap_m = -5.0;
  EXPECT_NEAR(
      solve_contacts(std::span(&contact, 1), inverse, {}, kDt_s, solver_memory).push.linear.y, 2.0,
      1e-9);
}

// A random symmetric positive definite matrix with the spread of masses that is asked for.
test::Mass random_mass(std::uint64_t seed, double ratio) {
  test::Mass mass{};
  const auto uniform = [&](std::uint64_t i) { return random_uniform({seed, 1, 0}, i) * 2.0 - 1.0; };
  std::array<double, 36> root{};
  for (std::size_t i = 0; i < 36; ++i) root[i] = uniform(i);
  for (std::size_t i = 0; i < 6; ++i) {
    const double weight = std::pow(ratio, random_uniform({seed, 2, 0}, i));
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        mass[6 * a + b] += weight * root[6 * i + a] * root[6 * i + b];
  }
  for (std::size_t i = 0; i < 6; ++i) mass[7 * i] += 0.1;
  return mass;
}

TEST(ContactSolver, NeverAddsEnergyNorApproachWhateverTheMassAndTheContacts) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const test::Mass mass = random_mass(seed, seed % 2 == 0 ? 10.0 : 1000.0);
    const auto uniform = [&](std::uint64_t i) {
      return random_uniform({seed, 3, 0}, i) * 2.0 - 1.0;
    };
    std::vector<BodyContact> contacts;
    for (std::uint64_t c = 0; c < 1 + seed % 6; ++c) {
      // Normals within a half space, else nothing may move at all.
      const Vec3 n = glm::normalize(Vec3(uniform(20 * c), 1.5, uniform(20 * c + 1)));
      contacts.push_back({Vec3(uniform(20 * c + 2), uniform(20 * c + 3), uniform(20 * c + 4)), n,
                          0.0, std::abs(uniform(20 * c + 5)), 0.0});
    }
    const Twist free{Vec3(uniform(900), uniform(901) - 1.0, uniform(902)),
                     Vec3(uniform(903), uniform(904), uniform(905))};
    const auto solution = solve_contacts(contacts, inverse_of(mass), free, kDt_s, solver_memory);
    EXPECT_LE(kinetic_energy(mass, solution.velocity),
              kinetic_energy(mass, free) * (1.0 + 1e-9) + 1e-12)
        << seed;
    if (!solution.converged) continue;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Vec3 at =
          solution.velocity.linear + glm::cross(solution.velocity.angular, contacts[c].point_m);
      EXPECT_GT(glm::dot(at, contacts[c].normal), -2e-3) << seed;
      EXPECT_GE(solution.impulses[c].normal_n_s, 0.0);
      EXPECT_LE(glm::length(solution.impulses[c].friction_n_s),
                contacts[c].friction * solution.impulses[c].normal_n_s * (1.0 + 1e-9) + 1e-12);
    }
  }
}

TEST(ContactSolver, MassesOfOneToAThousandDoNotSinkIn) {
  // A box on its four corners, a thousand times harder to move along one axis.
  const InverseMass inverse =
      inverse_of(mass_of(1.0, Vec3(0.01), Vec3(0.0, 1000.0, 0.0), Vec3(10.0, 0.0, 0.0)));
  std::vector<BodyContact> contacts;
  for (int i = 0; i < 4; ++i)
    contacts.push_back(
        {Vec3(i & 1 ? 0.2 : -0.2, -0.1, i & 2 ? 0.3 : -0.3), Vec3(0.0, 1.0, 0.0), 0.0, 0.5, 0.0});
  const auto solution = solve_contacts(
      contacts, inverse, {Vec3(0.1, -1.0, 0.05), Vec3(0.1, 0.2, -0.1)}, kDt_s, solver_memory);
  for (const BodyContact& contact : contacts) {
    const Vec3 at =
        solution.velocity.linear + glm::cross(solution.velocity.angular, contact.point_m);
    EXPECT_GT(at.y, -1e-4);
  }
}

}  // namespace
}  // namespace neritic::sim
