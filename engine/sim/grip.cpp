#include "engine/sim/grip.hpp"

namespace neritic::sim {
namespace {

// A block of the inverse mass, row by row as it is stored.
Mat3 block(const InverseMass& m, std::size_t row, std::size_t column) {
  Mat3 out(0.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out[static_cast<int>(k)][static_cast<int>(i)] = m[6 * (row + i) + column + k];
  return out;
}

}  // namespace

Vec3 point_velocity(const BodyMotion& body, const Vec3& at_m) {
  return body.world_from_body.rotation *
         (body.velocity.linear + glm::cross(body.velocity.angular, at_m));
}

Vec3 grip_impulse(const InverseMass& inverse_mass, const BodyMotion& body, const Held& held) {
  const Mat3 r = cross_matrix(held.at_m), rt = glm::transpose(r);
  // [1, -r] M^-1 [1, -r]^T, and -r^T = r.
  const Mat3 k = block(inverse_mass, 0, 0) + block(inverse_mass, 0, 3) * rt * -1.0 +
                 r * -1.0 * block(inverse_mass, 3, 0) + r * block(inverse_mass, 3, 3) * rt +
                 Mat3(1.0 / held.mass_kg);
  const Vec3 apart = held.velocity_m_s - point_velocity(body, held.at_m);
  const Quat& q = body.world_from_body.rotation;
  return q * (glm::inverse(k) * (glm::conjugate(q) * apart));
}

Twist given_by(const InverseMass& inverse_mass, const Vec3& at_m, const Vec3& impulse) {
  const Vec3 turn = glm::cross(at_m, impulse);
  return {block(inverse_mass, 0, 0) * impulse + block(inverse_mass, 0, 3) * turn,
          block(inverse_mass, 3, 0) * impulse + block(inverse_mass, 3, 3) * turn};
}

void hold(const InverseMass& inverse_mass, const Vec3& impulse_n_s, double dt_s, BodyMotion& body,
          Held& held) {
  const Quat q = body.world_from_body.rotation;
  const auto [linear, angular] = given_by(inverse_mass, held.at_m, glm::conjugate(q) * impulse_n_s);
  body.world_from_body = moved(body.world_from_body, {0.5 * linear, 0.5 * angular}, dt_s);
  // Velocities stay those of the old axes turned along: seen from the body they keep their numbers.
  body.velocity.linear += linear;
  body.velocity.angular += angular;
  held.velocity_m_s -= impulse_n_s / held.mass_kg;
}

}  // namespace neritic::sim
