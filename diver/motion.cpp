#include "diver/motion.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr int kRounds = 2;
// Beyond these the water would have stopped a body long before; what is faster is cut to it.
constexpr double kMostSpeed_m_s = 50.0;
constexpr double kMostTurn_rad_s = 60.0;

Quat turned(const Quat& attitude, const Vec3& rotation_body) {
  const double angle = glm::length(rotation_body);
  const double k = angle < 1e-3 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Quat turn(std::cos(0.5 * angle), k * rotation_body.x, k * rotation_body.y,
                  k * rotation_body.z);
  return glm::normalize(attitude * turn);
}

Immersion immersion_of(const RootState& root, const WaterFlow& water) {
  const Quat body_from_ned = glm::conjugate(root.attitude);
  return {body_from_ned * Vec3(0.0, 0.0, 1.0), root.position_ned_m.z,
          body_from_ned * water.acceleration_m_s2};
}

// Momentum of the body about its origin, body axes.
Vec6 momentum_at(const BodyMomentum& m, const Vec6& velocity) {
  const Vec3 v = velocity.linear(), w = velocity.angular();
  return vec6(m.mass.a * v + m.mass.b * w + m.linear, v * m.mass.b + m.mass.c * w + m.angular);
}

// All forces on the body and what they give to it.
struct AllForces {
  Vec6 wrench;
  Mat6 drag;
  double power_w;
};
AllForces forces_on(const Body& body, const Posture& posture, const BodyMomentum& mass,
                    const RootState& root, const Vec6& velocity, const GasLoad& load,
                    const WaterFlow& flow) {
  const Immersion immersion = immersion_of(root, flow);
  const WaterForces water = water_forces(body, posture, velocity, immersion);
  const StaticForces still = static_forces(body, posture, velocity, immersion, load);
  AllForces out{water.wrench + still.wrench, water.drag, water.power_w + still.power_w};
  // Where the body meets other water on its way than that which speeds up.
  const Vec3 between = glm::conjugate(root.attitude) * (flow.acceleration_m_s2 - flow.change_m_s2);
  if (between != Vec3(0.0)) {
    out.wrench = out.wrench + vec6(mass.mass.a * between, between * mass.mass.b);
    out.power_w += glm::dot(momentum_at(mass, velocity).linear(), between);
  }
  return out;
}

double energy_at(const BodyMomentum& m, const Vec6& velocity) {
  const Vec6 limbs = vec6(m.linear, m.angular);
  return 0.5 * dot(momentum_at(m, velocity) + limbs, velocity) + m.limb_energy_j;
}

// The drag's rate: no eigenvalue of M^-1 D is above its trace.
double drag_rate(const Mat6& mass, const Mat6& drag) {
  double trace = 0.0;
  for (std::size_t j = 0; j < 6; ++j) {
    Vec6 column, x;
    for (std::size_t i = 0; i < 6; ++i) column[i] = drag(i, j);
    if (solve(mass, column, x)) trace += x[j];
  }
  return trace;
}

// The planar model solves for surge, heave and pitch only.
void keep_in_plane(Mat6& matrix, Vec6& rhs) {
  for (const std::size_t i : {1u, 3u, 5u}) {
    for (std::size_t j = 0; j < 6; ++j) matrix(i, j) = matrix(j, i) = i == j ? 1.0 : 0.0;
    rhs[i] = 0.0;
  }
}

Vec6 limited(const Vec6& velocity) {
  const double v = glm::length(velocity.linear()), w = glm::length(velocity.angular());
  return vec6(velocity.linear() * std::min(1.0, kMostSpeed_m_s / std::max(v, 1e-300)),
              velocity.angular() * std::min(1.0, kMostTurn_rad_s / std::max(w, 1e-300)));
}

Vec6 in_world(const Quat& attitude, const Vec6& v) {
  return vec6(attitude * v.linear(), attitude * v.angular());
}
Vec6 in_body(const Quat& attitude, const Vec6& v) {
  return in_world(glm::conjugate(attitude), v);
}

// Kinetic energy of a segment against the trunk, without the water that moves along.
double energy_of(const SegmentBody& segment, const SegmentPose& pose) {
  const Mat3 segment_from_body = glm::transpose(pose.body_from_segment);
  const Vec3 v = segment_from_body * pose.velocity_m_s, w = segment_from_body * pose.angular_rad_s;
  const SpatialMass& m = segment.rigid;
  return 0.5 * (glm::dot(v, m.a * v + 2.0 * (m.b * w)) + glm::dot(w, m.c * w));
}

double speeding_up_j(const Body& body, const Posture& before, const Posture& after) {
  double sum = 0.0;
  for (const std::size_t first : {kLeftUpperArm, kRightUpperArm, kLeftUpperLeg, kRightUpperLeg}) {
    double gained = 0.0;
    for (std::size_t i = first; i < first + 3; ++i)
      gained += energy_of(body.segments[i], after[i]) - energy_of(body.segments[i], before[i]);
    sum += std::max(0.0, gained);
  }
  return sum;
}

}  // namespace

LimbWork move_root(const Body& body, RootState& root, const LimbState& before,
                   const LimbState& after, const GasLoad& load, const WaterFlow& water,
                   double dt_s) {
  // Axes that move with the water are as good as any.
  const Vec6 current = vec6(water.current_m_s, Vec3(0.0));
  const RootState start = root;
  const Vec6 velocity = root.velocity - in_body(root.attitude, current);
  const Posture old_posture = posture_of(body, before.rotation, before.rate);
  const Posture posture = posture_of(body, after.rotation, after.rate);
  const BodyMomentum old_mass = momentum_of(body, old_posture, load);
  const BodyMomentum mass = momentum_of(body, posture, load);
  const AllForces old_forces = forces_on(body, old_posture, old_mass, start, velocity, load, water);
  const Mat6 mass_matrix = matrix_of(mass.mass);

  const double rate = drag_rate(mass_matrix, old_forces.drag) * dt_s;
  const double implicit = rate > 2.0 ? 1.0 - 1.0 / rate : 0.5;
  const Vec6 old_momentum = in_world(start.attitude, momentum_at(old_mass, velocity));
  const Vec6 old_wrench = in_world(start.attitude, old_forces.wrench);

  Vec6 next = velocity;
  AllForces forces{};
  Vec6 momentum = old_momentum;  // at the end, world axes, about the end's origin
  for (int round = 0; round < kRounds; ++round) {
    // The pose by the mean of both velocities.
    root.attitude = turned(start.attitude, 0.5 * dt_s * (velocity.angular() + next.angular()));
    const Vec3 way =
        0.5 * dt_s * (start.attitude * velocity.linear() + root.attitude * next.linear());
    root.position_ned_m =
        start.position_ned_m + way + dt_s * (water.current_m_s + 0.5 * dt_s * water.change_m_s2);
    forces = forces_on(body, posture, mass, root, next, load, water);
    // Moments are about the origin, which went that way.
    const Vec3 mean = 0.5 * (old_momentum.linear() + momentum.linear());
    Vec6 known = old_momentum + ((1.0 - implicit) * dt_s) * old_wrench -
                 vec6(Vec3(0.0), glm::cross(way, mean));
    Vec6 rhs = in_body(root.attitude, known) - vec6(mass.linear, mass.angular) +
               (implicit * dt_s) * (forces.wrench + forces.drag * next);
    Mat6 matrix = mass_matrix + (implicit * dt_s) * forces.drag;
    if (body.model == Model::kPlanar) keep_in_plane(matrix, rhs);
    Vec6 solved;
    if (!solve(matrix, rhs, solved)) break;
    next = limited(solved);
    momentum = in_world(root.attitude, momentum_at(mass, next));
  }
  root.velocity =
      next + in_body(root.attitude, vec6(water.current_m_s + dt_s * water.change_m_s2, Vec3(0.0)));
  const double gained = energy_at(mass, next) - energy_at(old_mass, velocity);
  return {gained / dt_s - (1.0 - implicit) * old_forces.power_w - implicit * forces.power_w,
          speeding_up_j(body, old_posture, posture) / dt_s};
}

WorldMomentum world_momentum(const Body& body, const RootState& root, const LimbState& limbs,
                             const GasLoad& load, const Vec3& about_ned_m) {
  const BodyMomentum m = momentum_of(body, posture_of(body, limbs.rotation, limbs.rate), load);
  const Vec6 p = in_world(root.attitude, momentum_at(m, root.velocity));
  return {p.linear(), p.angular() + glm::cross(root.position_ned_m - about_ned_m, p.linear())};
}

double kinetic_energy(const Body& body, const RootState& root, const LimbState& limbs,
                      const GasLoad& load) {
  return energy_at(momentum_of(body, posture_of(body, limbs.rotation, limbs.rate), load),
                   root.velocity);
}

}  // namespace neritic::diver
