// Projected Gauss-Seidel over the contacts of one body.
#include "engine/sim/contact_solver.hpp"

#include <algorithm>
#include <cmath>

#include "engine/sim/contact_memory.hpp"

namespace neritic::sim {
namespace {

constexpr int kMostRounds = 200;
// Rounds end when no contact's velocity changes by more than this share of the fastest approach.
constexpr double kTolerance = 1e-9;
// After these rounds a larger share is enough: what is left is load that moves between contacts
// on one line, which changes the motion no more.
constexpr int kManyRounds = 50;
constexpr double kLooseTolerance = 1e-5;
constexpr double kSmallestChange_m_s = 1e-13;

struct Patience {
  int most_rounds, many_rounds;
  double tolerance;
};
constexpr Patience kUsual{kMostRounds, kManyRounds, kTolerance};
constexpr Patience kPrecise{1000, 800, 1e-11};

// Depth beyond the slop is undone at this rate, up to this speed.
constexpr double kSlop_m = 1e-6;
constexpr double kPushRate_hz = 50.0;
constexpr double kMostPush_m_s = 2.0;
constexpr double kPushTolerance_m_s = 1e-9;
constexpr int kMostPushRounds = 50;

// Nearer than this share of the way it touches; or than this, which no real surface is flatter
// than: without it the corners of a box that slaps flat onto a floor would hit one after another by
// the last bits of their gaps, and the shorter the step the more so.
constexpr double kTouchShare = 0.01;
constexpr double kTogether_m = 1e-6;

// Whether it would be met within the time, and faster than what lies is.
bool is_hit(const BodyContact& contact, double approach_m_s, double dt_s, bool precise) {
  return approach_m_s < -(precise ? kPreciseHit_m_s : kBounce_m_s) &&
         contact.gap_m + approach_m_s * dt_s < 0.0;
}
bool touches(const BodyContact& contact, double approach_m_s, double dt_s) {
  return contact.gap_m <= std::max(-kTouchShare * approach_m_s * dt_s, kTogether_m);
}

// together: something is hit, and with it what is as good as met; precisely also what the hit
// presses down.
double target_of(const BodyContact& contact, double approach_m_s, double dt_s, bool together,
                 bool precise) {
  const bool fast = approach_m_s < -kBounce_m_s;
  const bool met = together && (fast || precise) && contact.gap_m < kTogether_m;
  const bool bounces = fast && contact.restitution > 0.0;
  if ((met || is_hit(contact, approach_m_s, dt_s, precise)) &&
      (bounces || touches(contact, approach_m_s, dt_s)))
    return bounces ? -contact.restitution * approach_m_s : 0.0;
  return -std::max(contact.gap_m, 0.0) / dt_s;
}

double approach_of(const BodyContact& contact, const Twist& velocity) {
  return glm::dot(contact.normal, velocity.linear + glm::cross(velocity.angular, contact.point_m));
}

// To and fro over the contacts: what the conjugate directions ask for, and the same for all.
double solve_round(std::vector<SolverContact>& contacts, Six& velocity) {
  double change_m_s = 0.0;
  const auto solve = [&](SolverContact& contact) {
    change_m_s = std::max(change_m_s, solve_normal(contact, contact.target_m_s, velocity));
    change_m_s = std::max(change_m_s, solve_friction(contact, velocity));
  };
  std::for_each(contacts.begin(), contacts.end(), solve);
  std::for_each(contacts.rbegin(), contacts.rend(), solve);
  return change_m_s;
}

// Kinetic energy that the impulses bring: their product with the mean of the speeds before and
// after.
double energy_gain(const std::vector<SolverContact>& contacts, const Six& free,
                   const Six& velocity) {
  Six mean = free;
  add_scaled(mean, velocity, 1.0);
  double twice = 0.0;
  for (const SolverContact& contact : contacts)
    twice += contact.impulse.x * dot_of(contact.normal.jacobian, mean) +
             contact.impulse.y * dot_of(contact.side.jacobian, mean) +
             contact.impulse.z * dot_of(contact.other.jacobian, mean);
  return 0.5 * twice;
}

// Rounds that did not come to an end may leave more energy than there was. With the bounds of
// friction held, every step of a round lowers one and the same convex function, which is 0 without
// impulses and no less than the energy gained: from there no rounds can gain any.
void solve_safely(std::vector<SolverContact>& contacts, double enough_m_s, Six& velocity) {
  for (SolverContact& contact : contacts) {
    contact.friction_bound = contact.friction * contact.impulse.x;
    contact.impulse = Vec3(0.0);
  }
  for (int round = 0; round < kMostRounds; ++round)
    if (solve_round(contacts, velocity) <= enough_m_s) return;
}

// The velocity that undoes depth within this step's motion, beside the velocity that was solved.
Six solve_push(SolverMemory& memory, std::span<const BodyContact> contacts, const Six& velocity,
               double dt_s) {
  std::vector<SolverContact>& rows = memory.rows;
  Six push{};
  const bool deep = std::any_of(contacts.begin(), contacts.end(),
                                [](const BodyContact& c) { return c.gap_m < -kSlop_m; });
  if (!deep) return push;
  const double rate_hz = std::min(kPushRate_hz, 1.0 / dt_s);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double gap_m = contacts[i].gap_m;
    const double left_m_s = dot_of(rows[i].normal.jacobian, velocity) + std::max(gap_m, 0.0) / dt_s;
    rows[i].target_m_s = gap_m < -kSlop_m ? std::min((-gap_m - kSlop_m) * rate_hz, kMostPush_m_s)
                                          : -std::max(left_m_s, 0.0);
    rows[i].impulse = Vec3(0.0);
    rows[i].friction = 0.0;
  }
  memory.conjugate.begin(rows.size());
  for (int round = 0; round < kMostPushRounds; ++round) {
    if (round > 0) memory.conjugate.advance(rows, push);
    if (solve_round(rows, push) < kPushTolerance_m_s) break;
  }
  return push;
}

}  // namespace

double time_to_hit(std::span<const BodyContact> contacts, const Twist& velocity, double dt_s,
                   bool precise) {
  double first_s = dt_s;
  for (const BodyContact& contact : contacts) {
    const double approach_m_s = approach_of(contact, velocity);
    if (is_hit(contact, approach_m_s, dt_s, precise) && !touches(contact, approach_m_s, dt_s))
      first_s = std::min(first_s, contact.gap_m / -approach_m_s);
  }
  return first_s;
}

bool meets_hard(std::span<const BodyContact> contacts, const Twist& velocity, double dt_s,
                bool precise) {
  return std::ranges::any_of(contacts, [&](const BodyContact& contact) {
    return is_hit(contact, approach_of(contact, velocity), dt_s, precise);
  });
}

ContactSolution solve_contacts(std::span<const BodyContact> contacts,
                               const InverseMass& inverse_mass, const Twist& free, double dt_s,
                               SolverMemory& memory) {
  ContactSolution solution;
  Six velocity = six_of(free);
  auto& [precise, rows, impulses, conjugate] = memory;
  const Patience& patience = precise ? kPrecise : kUsual;
  rows.clear();
  impulses.clear();
  double fastest_m_s = 0.0;
  bool bounces = false;
  const bool together = meets_hard(contacts, free, dt_s, precise);
  for (const BodyContact& contact : contacts) {
    SolverContact& row = rows.emplace_back(solver_contact(contact, inverse_mass));
    const double approach_m_s = dot_of(row.normal.jacobian, velocity);
    row.target_m_s = target_of(contact, approach_m_s, dt_s, together, precise);
    fastest_m_s = std::max(fastest_m_s, row.target_m_s - approach_m_s);
    bounces = bounces || row.target_m_s > 0.0;
  }
  const double enough_m_s = std::max(patience.tolerance * fastest_m_s, kSmallestChange_m_s);
  const double loose_m_s = std::max(kLooseTolerance * fastest_m_s, kSmallestChange_m_s);
  solution.converged = contacts.empty();
  conjugate.begin(rows.size());
  while (!solution.converged && solution.rounds < patience.most_rounds) {
    if (solution.rounds > 0) conjugate.advance(rows, velocity);
    ++solution.rounds;
    solution.converged = solve_round(rows, velocity) <=
                         (solution.rounds < patience.many_rounds ? enough_m_s : loose_m_s);
  }
  const bool loose = !solution.converged || solution.rounds >= patience.many_rounds;
  if (loose && !bounces && energy_gain(rows, six_of(free), velocity) > 0.0) {
    velocity = six_of(free);
    solve_safely(rows, enough_m_s, velocity);
  }
  for (const SolverContact& row : rows)
    impulses.push_back(
        {row.impulse.x, row.side_axis * row.impulse.y + row.other_axis * row.impulse.z});
  solution.impulses = impulses;
  solution.velocity = twist_of(velocity);
  solution.push = twist_of(solve_push(memory, contacts, velocity, dt_s));
  return solution;
}

}  // namespace neritic::sim
