#include "diver/water_forces.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// A part as it lies in the body and moves through the water, in its own axes at its start.
struct PartMotion {
  Mat3 body_from_part;
  Vec3 start_m;   // body axes
  Vec3 velocity;  // of the start, part axes: along, first, second
  Vec3 angular;   // part axes
};

PartMotion motion_of(const Part& part, const SegmentPose& pose, const Vec3& linear,
                     const Vec3& angular) {
  PartMotion m;
  m.body_from_part = pose.body_from_segment * part.segment_from_part;
  const Vec3 arm = pose.body_from_segment * part.start_m;
  m.start_m = pose.origin_m + arm;
  const Vec3 velocity = linear + glm::cross(angular, m.start_m) + pose.velocity_m_s +
                        glm::cross(pose.angular_rad_s, arm);
  m.velocity = velocity * m.body_from_part;  // the transpose
  m.angular = (angular + pose.angular_rad_s) * m.body_from_part;
  return m;
}

// Share of a strip that is under water.
double wetness(double depth_m, double radius_m) {
  return std::clamp(0.5 + 0.5 * depth_m / radius_m, 0.0, 1.0);
}

// Depth along a part: at its start, and more for each metre.
struct DepthLine {
  double at_start_m, slope;
  bool under(double length_m, double radius_m) const {
    return std::min(at_start_m, at_start_m + slope * length_m) >= radius_m;
  }
};
DepthLine depth_of(const PartMotion& m, const Immersion& immersion) {
  return {immersion.depth_m + glm::dot(immersion.down, m.start_m),
          glm::dot(immersion.down, m.body_from_part[0])};
}

// A number for each of a part's two directions across. GCC and Clang compute both numbers by one
// instruction, each to the bits that a double alone has.
using Across = double __attribute__((vector_size(16)));

// Drag of a part's strips in a direction across: the sums of c, c s and c s^2, where c is a strip's
// force by its speed and s its way from the part's start.
struct DragAcross {
  double c = 0.0, c_s = 0.0, c_ss = 0.0;
};
// Forces on one part in its axes about its start, and what their derivative consists of.
struct PartForces {
  Vec3 force{0.0}, moment{0.0};
  double drag_along = 0.0;
  DragAcross drag_first, drag_second;
  double power_w = 0.0;
};

PartForces strips_of(const Part& part, const PartMotion& m, const DepthLine& depth) {
  const double step_m = part.length_m / part.strips;
  const bool under = depth.under(part.length_m, part.radius_m);
  const Across start{m.velocity.y, m.velocity.z}, turn{m.angular.z, -m.angular.y};
  const Across drag{part.drag_first, part.drag_second};
  double wet_sum = 0.0, power_w = 0.0;
  Across force{}, moment{}, sum_c{}, sum_c_s{}, sum_c_ss{};
  for (int i = 0; i < part.strips; ++i) {
    const double s = (i + 0.5) * step_m;
    const Across v = start + turn * s, square = v * v;
    const double wet = under ? 1.0 : wetness(depth.at_start_m + depth.slope * s, part.radius_m);
    const double speed = part.flat ? std::abs(v[0]) : std::sqrt(square[0] + square[1]);
    const Across c = wet * step_m * speed * drag, c_s = c * s;
    const Across f = c * v, power = f * v;
    force -= f;
    moment += c_s * v;
    power_w -= power[0] + power[1];
    sum_c += c, sum_c_s += c_s, sum_c_ss += c_s * s;
    wet_sum += wet;
  }
  const double along = wet_sum * step_m * part.drag_along * std::abs(m.velocity.x);
  PartForces out;
  out.force = {-along * m.velocity.x, force[0], force[1]};
  out.moment = {0.0, moment[1], -moment[0]};
  out.power_w = power_w - along * m.velocity.x * m.velocity.x;
  out.drag_along = along;
  out.drag_first = {sum_c[0], sum_c_s[0], sum_c_ss[0]};
  out.drag_second = {sum_c[1], sum_c_s[1], sum_c_ss[1]};
  return out;
}

// m += a b^T, its upper triangle only.
void add_upper(Mat3& m, const Vec3& a, const Vec3& b) {
  m[0][0] += a.x * b.x, m[1][0] += a.x * b.y, m[2][0] += a.x * b.z;
  m[1][1] += a.y * b.y, m[2][1] += a.y * b.z, m[2][2] += a.z * b.z;
}
void add_outer(Mat3& m, const Vec3& a, const Vec3& b) {
  m[0] += b.x * a, m[1] += b.y * a, m[2] += b.z * a;
}
void mirror_upper(Mat3& m) {
  m[0][1] = m[1][0], m[0][2] = m[2][0], m[1][2] = m[2][1];
}

// The derivative of a part's forces about the body's origin, of a and c the upper triangles. A
// strip at s that is pulled along the unit axis n has the wrench (n, q + s t): q is n's moment
// about the origin where it acts at the part's start, and t what a metre farther adds.
void add_drag(const PartForces& f, const PartMotion& m, SpatialMass& drag) {
  const auto add_across = [&](const DragAcross& d, const Vec3& n, const Vec3& t) {
    const Vec3 q = glm::cross(m.start_m, n), moment = d.c * q + d.c_s * t;
    add_upper(drag.a, d.c * n, n);
    add_outer(drag.b, n, moment);
    add_upper(drag.c, q, moment);
    add_upper(drag.c, t, d.c_s * q + d.c_ss * t);
  };
  const Mat3& axes = m.body_from_part;
  const Vec3 q = glm::cross(m.start_m, axes[0]), moment = f.drag_along * q;
  add_upper(drag.a, f.drag_along * axes[0], axes[0]);
  add_outer(drag.b, axes[0], moment);
  add_upper(drag.c, q, moment);
  add_across(f.drag_first, axes[1], axes[2]);
  add_across(f.drag_second, axes[2], -axes[1]);
}

// m += factor a b^T.
void add_outer(Mat6& m, double factor, const Vec6& a, const Vec6& b) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) m(i, j) += factor * a[i] * b[j];
}

Vec6 wrench_at(const Vec3& force, const Vec3& position_m) {
  return vec6(force, glm::cross(position_m, force));
}

void add_edge(const Edge& edge, const Part& part, const PartMotion& m, const Immersion& immersion,
              WaterForces& out) {
  const double s = part.length_m;
  const double w = m.velocity.y + m.angular.z * s, u = -m.velocity.x;
  const Vec3 at = m.start_m + s * m.body_from_part[0];
  const double depth_m = immersion.depth_m + glm::dot(immersion.down, at);
  if (!(u > 0.0) || depth_m <= 0.0) return;
  const double m_a = edge.added_kg_m;
  const Vec6 n = wrench_at(m.body_from_part[1], at), t = wrench_at(-m.body_from_part[0], at);
  const Vec6 force = (m_a * -u * w) * n + (0.5 * m_a * w * w) * t;
  out.wrench = out.wrench + force;
  out.power_w -= 0.5 * m_a * w * w * u;
  // The wrench as matrix times velocity: half of the force on w turns it only, and takes nothing.
  add_outer(out.drag, 0.5 * m_a * u, n, n);
  add_outer(out.drag, 0.5 * m_a * w, n, t);
  add_outer(out.drag, -0.5 * m_a * w, t, n);
}

void add_blunt(const BluntDrag& blunt, const SegmentPose& pose, const Vec6& velocity,
               const Immersion& immersion, WaterForces& out) {
  if (blunt.half_rho_area <= 0.0) return;
  const Vec3 arm = pose.body_from_segment * blunt.position_m, at = pose.origin_m + arm;
  const Vec3 v = (velocity.linear() + glm::cross(velocity.angular(), at) + pose.velocity_m_s +
                  glm::cross(pose.angular_rad_s, arm)) *
                 pose.body_from_segment;
  constexpr double kRadius_m = 0.15;
  const double wet = wetness(immersion.depth_m + glm::dot(immersion.down, at), kRadius_m);
  const double across = std::sqrt(v.y * v.y + v.z * v.z), speed = std::hypot(v.x, across);
  if (!(speed > 0.0)) return;
  const double c =
      wet * blunt.half_rho_area * std::abs(v.x) * (1.0 + blunt.incidence * across / speed);
  const Vec3 force = -c * (pose.body_from_segment * v);
  out.wrench = out.wrench + wrench_at(force, at);
  out.power_w -= c * speed * speed;
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0);
    axis[i] = 1.0;
    const Vec6 unit = wrench_at(axis, at);
    add_outer(out.drag, c, unit, unit);
  }
}

}  // namespace

Mat6 matrix_of(const SpatialMass& m) {
  Mat6 out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const int row = static_cast<int>(i), column = static_cast<int>(j);
      out(i, j) = m.a[column][row];
      out(i, j + 3) = m.b[column][row];
      out(i + 3, j) = m.b[row][column];
      out(i + 3, j + 3) = m.c[column][row];
    }
  return out;
}

WaterForces water_forces(const Body& body, const Posture& posture, const Vec6& velocity,
                         const Immersion& immersion) {
  WaterForces out;
  SpatialMass drag;
  Vec3 force(0.0), moment(0.0);
  for (std::size_t i = 0; i < body.part_count; ++i) {
    const Part& part = body.parts[i];
    const PartMotion m =
        motion_of(part, posture[part.segment], velocity.linear(), velocity.angular());
    const PartForces f = strips_of(part, m, depth_of(m, immersion));
    const Vec3 part_force = m.body_from_part * f.force;
    force += part_force;
    moment += m.body_from_part * f.moment + glm::cross(m.start_m, part_force);
    out.power_w += f.power_w;
    add_drag(f, m, drag);
  }
  mirror_upper(drag.a);
  mirror_upper(drag.c);
  out.wrench = vec6(force, moment);
  out.drag = matrix_of(drag);
  for (const Edge& edge : body.edges) {
    if (edge.added_kg_m <= 0.0) continue;
    const Part& part = body.parts[edge.part];
    add_edge(edge, part,
             motion_of(part, posture[part.segment], velocity.linear(), velocity.angular()),
             immersion, out);
  }
  for (const BluntDrag& blunt : body.blunt)
    add_blunt(blunt, posture[blunt.segment], velocity, immersion, out);
  return out;
}

StaticForces static_forces(const Body& body, const Posture& posture, const Vec6& velocity,
                           const Immersion& immersion, const GasLoad& load) {
  Vec3 arm_sum(0.0), limb_sum(0.0);  // newtons down times where, and times limb velocity
  double force_sum = 0.0;
  const auto add = [&](double newtons_down, const SegmentPose& pose, const Vec3& at_segment_m) {
    const Vec3 arm = pose.body_from_segment * at_segment_m;
    force_sum += newtons_down;
    arm_sum += newtons_down * (pose.origin_m + arm);
    limb_sum += newtons_down * (pose.velocity_m_s + glm::cross(pose.angular_rad_s, arm));
  };
  const double lift_n_m3 = body.density_kg_m3(immersion.depth_m) * kGravity_m_s2;
  for (std::size_t i = 0; i < kSegments; ++i)
    if (body.segments[i].mass_kg > 0.0)
      add(kGravity_m_s2 * body.segments[i].mass_kg, posture[i], body.segments[i].mass_centre_m);
  const double gas_share = kSurfacePressure_pa / pressure_at(body, immersion.depth_m);
  for (std::size_t i = 0; i < body.part_count; ++i) {
    const Part& part = body.parts[i];
    const SegmentPose& pose = posture[part.segment];
    const Vec3 along = part.segment_from_part[0];
    const double lift_n = lift_n_m3 * (part.volume_m3 + gas_share * part.suit_gas_m3);
    const Vec3 start = pose.origin_m + pose.body_from_segment * part.start_m;
    const DepthLine depth{immersion.depth_m + glm::dot(immersion.down, start),
                          glm::dot(immersion.down, pose.body_from_segment * along)};
    if (depth.under(part.length_m, part.radius_m)) {
      add(-lift_n, pose, part.start_m + 0.5 * part.length_m * along);
      continue;
    }
    for (int k = 0; k < part.strips; ++k) {
      const double s = (k + 0.5) * part.length_m / part.strips;
      add(-lift_n / part.strips * wetness(depth.at_start_m + depth.slope * s, part.radius_m), pose,
          part.start_m + s * along);
    }
  }
  const SegmentPose& thorax = posture[kThorax];
  const auto add_gas = [&](double volume_m3, const Vec3& at_m) {
    const Vec3 at = thorax.origin_m + thorax.body_from_segment * at_m;
    constexpr double kRadius_m = 0.1;
    const double wet = wetness(immersion.depth_m + glm::dot(immersion.down, at), kRadius_m);
    add(-lift_n_m3 * volume_m3 * wet, thorax, at_m);
  };
  add_gas(load.lungs_m3, body.lungs_at_m);
  add_gas(load.jacket_m3, load.jacket_at_m);
  for (std::size_t i = 0; i < body.tank_count; ++i)
    add(kGravity_m_s2 * load.tank_kg[i], thorax, body.tanks[i].position_m);

  const Vec3 leaning = immersion.down - immersion.water_m_s2 / kGravity_m_s2;
  StaticForces out;
  out.wrench = vec6(force_sum * leaning, glm::cross(arm_sum, leaning));
  out.power_w = dot(out.wrench, velocity) + glm::dot(limb_sum, leaning);
  return out;
}

BodyMomentum momentum_of(const Body& body, const Posture& posture, const GasLoad& load) {
  BodyMomentum out;
  for (std::size_t i = 0; i < kSegments; ++i) {
    if (!body.moves[i]) continue;
    SpatialMass own = body.segments[i].mass;
    if (i == kThorax)
      for (std::size_t k = 0; k < body.tank_count; ++k)
        own += point_mass(load.tank_kg[k], body.tanks[k].position_m);
    const SegmentPose& pose = posture[i];
    const SpatialMass m = rotated(own, pose.body_from_segment);  // about the segment's origin
    const Vec3 linear = m.a * pose.velocity_m_s + m.b * pose.angular_rad_s;
    const Vec3 angular = pose.velocity_m_s * m.b + m.c * pose.angular_rad_s;
    out.linear += linear;
    out.angular += angular + glm::cross(pose.origin_m, linear);
    out.limb_energy_j +=
        0.5 * (glm::dot(linear, pose.velocity_m_s) + glm::dot(angular, pose.angular_rad_s));
    out.mass += shifted(m, pose.origin_m);
  }
  return out;
}

}  // namespace neritic::diver
