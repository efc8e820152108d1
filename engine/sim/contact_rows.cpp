// Rows of a contact and the steps of a round.
#include "engine/sim/contact_rows.hpp"

#include "engine/sim/plane_axes.hpp"

namespace neritic::sim {

SolverRow::SolverRow(const Vec3& point_m, const Vec3& direction, const InverseMass& inverse_mass)
    : jacobian(six_of({direction, glm::cross(point_m, direction)})) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) response[i] += inverse_mass[6 * i + j] * jacobian[j];
  mobility = dot_of(jacobian, response);
  inertia = mobility > 0.0 ? 1.0 / mobility : 0.0;
}

SolverContact::SolverContact(const BodyContact& contact, const Vec3& side_, const Vec3& other_,
                             const InverseMass& inverse_mass)
    : normal(contact.point_m, contact.normal, inverse_mass),
      side(contact.point_m, side_, inverse_mass),
      other(contact.point_m, other_, inverse_mass),
      side_axis(side_),
      other_axis(other_),
      friction(contact.friction) {
  const double mean = 0.5 * (side.mobility + other.mobility);
  const double apart = 0.5 * (side.mobility - other.mobility);
  const double mixed = dot_of(side.jacobian, other.response);
  slip_mobility = mean + std::sqrt(apart * apart + mixed * mixed);
  slip_inertia = slip_mobility > 0.0 ? 1.0 / slip_mobility : 0.0;
}

SolverContact solver_contact(const BodyContact& contact, const InverseMass& inverse_mass) {
  const PlaneAxes across = plane_axes(contact.normal);
  return {contact, across.x, across.y, inverse_mass};
}

double solve_normal(SolverContact& contact, double target_m_s, Six& velocity) {
  const double mobility = contact.normal.mobility;
  if (!(mobility > 0.0)) return 0.0;
  const double wrong_m_s = dot_of(contact.normal.jacobian, velocity) - target_m_s;
  const double impulse = std::max(contact.impulse.x - wrong_m_s * contact.normal.inertia, 0.0);
  const double change = impulse - contact.impulse.x;
  if (change == 0.0) return 0.0;
  contact.impulse.x = impulse;
  add_scaled(velocity, contact.normal.response, change);
  return std::abs(change) * mobility;
}

double solve_friction(SolverContact& contact, Six& velocity) {
  if (!(contact.slip_mobility > 0.0) || contact.friction == 0.0) return 0.0;
  const double most = contact.friction_bound.value_or(contact.friction * contact.impulse.x);
  Vec2 impulse(contact.impulse.y, contact.impulse.z);
  if (most == 0.0 && impulse == Vec2(0.0)) return 0.0;  // nothing presses there
  impulse -=
      Vec2(dot_of(contact.side.jacobian, velocity), dot_of(contact.other.jacobian, velocity)) *
      contact.slip_inertia;
  const double size_2 = glm::dot(impulse, impulse);
  if (size_2 > most * most) impulse *= most / std::sqrt(size_2);  // what sticks needs no root
  const Vec2 change = impulse - Vec2(contact.impulse.y, contact.impulse.z);
  contact.impulse.y = impulse.x;
  contact.impulse.z = impulse.y;
  add_scaled(velocity, contact.side.response, change.x);
  add_scaled(velocity, contact.other.response, change.y);
  return glm::length(change) * contact.slip_mobility;
}

void Conjugate::advance(std::vector<SolverContact>& contacts, Six& velocity) {
  double size = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 step = contacts[i].impulse - last_[i];
    size += step.x * step.x * contacts[i].normal.mobility +
            (step.y * step.y + step.z * step.z) * contacts[i].slip_mobility;
  }
  const double ratio = size_ > 0.0 ? size / size_ : 0.0;
  size_ = size;
  const double go = ratio <= 1.05 ? std::min(ratio, 1.0) : 0.0;  // else begin anew
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SolverContact& contact = contacts[i];
    const Vec3 more = go * way_[i];
    way_[i] = more + (contact.impulse - last_[i]);
    contact.impulse += more;
    last_[i] = contact.impulse;
    add_scaled(velocity, contact.normal.response, more.x);
    add_scaled(velocity, contact.side.response, more.y);
    add_scaled(velocity, contact.other.response, more.z);
  }
}

}  // namespace neritic::sim
