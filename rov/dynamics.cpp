#include "rov/dynamics.hpp"

#include <algorithm>

namespace neritic::rov {
namespace {

// R^T e_3: where down is, in body axes. For a unit quaternion; in the stages of an integrator it is
// one to within the square of the step.
Vec3 down_in_body(const Quat& q) {
  return {2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x),
          1.0 - 2.0 * (q.x * q.x + q.y * q.y)};
}

// q' = 1/2 q (x) [0, w].
Quat attitude_rate(const Quat& q, const Vec3& w) {
  return {-0.5 * (q.x * w.x + q.y * w.y + q.z * w.z), 0.5 * (q.w * w.x + q.y * w.z - q.z * w.y),
          0.5 * (q.w * w.y + q.z * w.x - q.x * w.z), 0.5 * (q.w * w.z + q.x * w.y - q.y * w.x)};
}

}  // namespace

Vec6 through_water(const Quat& attitude, const Vec6& velocity, const Vec3& current) {
  if (current == Vec3(0.0)) return velocity;
  return velocity - vec6(glm::conjugate(attitude) * current, Vec3(0.0));
}

Vec6 over_ground(const Quat& attitude, const Vec6& relative, const Vec3& current) {
  if (current == Vec3(0.0)) return relative;
  return relative + vec6(glm::conjugate(attitude) * current, Vec3(0.0));
}

Vec6 static_wrench(const Vehicle& v, const WaterMotion& motion, const Inputs& inputs) {
  const Vec3 down = down_in_body(motion.attitude);
  Vec6 out =
      vec6((v.weight_n - v.buoyancy_n) * down,
           glm::cross(v.weight_n * v.gravity_centre_m - v.buoyancy_n * v.buoyancy_centre_m, down));
  if (!v.tether) return out;
  const Vec3 arm = v.tether->attachment_m;
  const Vec3 at = motion.position_ned_m + motion.attitude * arm;
  const Vec3 velocity =
      motion.attitude * (motion.velocity.linear() + glm::cross(motion.velocity.angular(), arm)) +
      motion.current_ned_m_s;
  const Vec3 pull =
      glm::conjugate(motion.attitude) *
      tether_force_n(*v.tether, inputs.tether_anchor_ned_m, at, velocity, motion.current_ned_m_s);
  return out + vec6(pull, glm::cross(arm, pull));
}

Vec6 water_wrench(const Vehicle& v, const Quat& attitude, const Inputs& inputs) {
  const Vec3 &a_ned = inputs.water_acceleration_ned_m_s2, &b_ned = inputs.current_change_ned_m_s2;
  if (a_ned == Vec3(0.0) && b_ned == Vec3(0.0)) return {};
  const Quat body_from_ned = glm::conjugate(attitude);
  const Vec3 a = body_from_ned * a_ned, pull = v.displaced_kg * a;
  // M_A a - M b = M (a - b) - M_RB a.
  return v.mass * vec6(a - body_from_ned * b_ned, Vec3(0.0)) - v.rigid_mass * vec6(a, Vec3(0.0)) +
         vec6(pull, glm::cross(v.buoyancy_centre_m, pull));
}

WaterMotion motion_rate(const Vehicle& v, const WaterMotion& motion, const Vec6& wrench,
                        const Inputs& inputs) {
  const Vec6& nu = motion.velocity;
  const Vec6 momentum = v.mass * nu;
  const Vec3 linear = nu.linear(), angular = nu.angular();
  Vec6 force =
      wrench + static_wrench(v, motion, inputs) + water_wrench(v, motion.attitude, inputs) -
      v.linear_damping * nu -
      vec6(glm::cross(angular, momentum.linear()),
           glm::cross(angular, momentum.angular()) + glm::cross(linear, momentum.linear()));
  for (std::size_t i = 0; i < 6; ++i) force[i] -= v.quadratic_damping[i] * std::abs(nu[i]) * nu[i];
  return {motion.attitude * linear + motion.current_ned_m_s,
          attitude_rate(motion.attitude, angular), v.inverse_mass * force,
          inputs.current_change_ned_m_s2};
}

double followed_command(const Vehicle& vehicle, const Inputs& inputs, std::size_t i) {
  if (inputs.failed_thrusters >> i & 1u) return 0.0;
  return std::clamp(inputs.thruster_n[i], vehicle.thrusters[i].min_n, vehicle.thrusters[i].max_n);
}

std::array<double, kMaxThrusters> thruster_forces(const Vehicle& vehicle, const State& state,
                                                  const Inputs& inputs) {
  std::array<double, kMaxThrusters> forces{};
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i)
    forces[i] = force_of(vehicle.lag, state.lag[i], followed_command(vehicle, inputs, i));
  return forces;
}

Vec6 thruster_wrench(const Vehicle& vehicle, const std::array<double, kMaxThrusters>& forces_n) {
  Vec6 sum;
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i)
    for (std::size_t k = 0; k < 6; ++k) sum[k] += vehicle.thruster_wrench[i][k] * forces_n[i];
  return sum;
}

StateRate derivative(const Vehicle& vehicle, const State& state, const Inputs& inputs) {
  const WaterMotion motion{state.position_ned_m, state.attitude,
                           through_water(state.attitude, state.velocity, inputs.current_ned_m_s),
                           inputs.current_ned_m_s};
  const Vec6 wrench =
      inputs.wrench + thruster_wrench(vehicle, thruster_forces(vehicle, state, inputs));
  const WaterMotion rate = motion_rate(vehicle, motion, wrench, inputs);
  StateRate out{rate.position_ned_m, rate.attitude, rate.velocity};
  // nu = nu_r + R^T v_c, and (R^T v_c)' = R^T v_c' - w x R^T v_c.
  const Quat body_from_ned = glm::conjugate(state.attitude);
  const Vec3 current = body_from_ned * inputs.current_ned_m_s;
  out.velocity = out.velocity - vec6(glm::cross(state.velocity.angular(), current), Vec3(0.0)) +
                 vec6(body_from_ned * inputs.current_change_ned_m_s2, Vec3(0.0));
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i)
    out.lag[i] = lag_rate(vehicle.lag, state.lag[i], followed_command(vehicle, inputs, i));
  return out;
}

double kinetic_energy(const Vehicle& vehicle, const State& state, const Vec3& current) {
  const Vec6 nu = through_water(state.attitude, state.velocity, current);
  return 0.5 * dot(nu, vehicle.mass * nu);
}

double potential_energy(const Vehicle& v, const State& state) {
  const Vec3 down = down_in_body(state.attitude);
  const Vec3 arm = v.weight_n * v.gravity_centre_m - v.buoyancy_n * v.buoyancy_centre_m;
  return -(v.weight_n - v.buoyancy_n) * state.position_ned_m.z - glm::dot(arm, down) + arm.z;
}

}  // namespace neritic::rov
