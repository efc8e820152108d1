#include "tests/sim/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/hash.hpp"

namespace neritic::sim::test {

Mass mass_of(double mass_kg, const Vec3& inertia_kg_m2, const Vec3& added_kg,
             const Vec3& added_kg_m2) {
  Mass mass{};
  for (int i = 0; i < 3; ++i) {
    mass[static_cast<std::size_t>(7 * i)] = mass_kg + added_kg[i];
    mass[static_cast<std::size_t>(7 * (i + 3))] = inertia_kg_m2[i] + added_kg_m2[i];
  }
  return mass;
}

InverseMass inverse_of(const Mass& mass) {
  Mass left = mass;
  InverseMass right{};
  for (std::size_t i = 0; i < 6; ++i) right[7 * i] = 1.0;
  for (std::size_t pivot = 0; pivot < 6; ++pivot) {
    const double by = left[7 * pivot];
    for (std::size_t j = 0; j < 6; ++j) left[6 * pivot + j] /= by, right[6 * pivot + j] /= by;
    for (std::size_t row = 0; row < 6; ++row) {
      if (row == pivot) continue;
      const double factor = left[6 * row + pivot];
      for (std::size_t j = 0; j < 6; ++j) {
        left[6 * row + j] -= factor * left[6 * pivot + j];
        right[6 * row + j] -= factor * right[6 * pivot + j];
      }
    }
  }
  return right;
}

namespace {
std::array<double, 6> numbers_of(const Twist& t) {
  return {t.linear.x, t.linear.y, t.linear.z, t.angular.x, t.angular.y, t.angular.z};
}
}  // namespace

double kinetic_energy(const Mass& mass, const Twist& velocity) {
  const auto v = numbers_of(velocity);
  double twice = 0.0;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) twice += v[i] * mass[6 * i + j] * v[j];
  return 0.5 * twice;
}

Twist times(const InverseMass& inverse, const Vec3& force_n, const Vec3& torque_nm) {
  const auto wrench = numbers_of({force_n, torque_nm});
  std::array<double, 6> v{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) v[i] += inverse[6 * i + j] * wrench[j];
  return {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
}

Body make_body(BodyShape shape, const Mass& mass, const Pose& pose) {
  Body body;
  body.shape = std::move(shape);
  body.mass = mass;
  body.inverse_mass = inverse_of(mass);
  body.motion.world_from_body = pose;
  return body;
}

Body make_box_body(const Vec3& half_m, double mass_kg, const Pose& pose) {
  BodyShape shape;
  shape.add_box({}, half_m);
  const Vec3 square = half_m * half_m;
  const Vec3 inertia_kg_m2 =
      mass_kg / 3.0 * Vec3(square.y + square.z, square.x + square.z, square.x + square.y);
  Body body = make_body(std::move(shape), mass_of(mass_kg, inertia_kg_m2), pose);
  body.force_n = Vec3(0.0, -mass_kg, 0.0);
  return body;
}

void step(Body& body, const StaticWorld& world, double dt_s) {
  const Pose before = body.motion.world_from_body;
  const Quat body_from_world = glm::conjugate(before.rotation);
  const Vec3 drag_n = body.motion.velocity.linear * -body.drag_n_s_m;
  const Twist rate = times(body.inverse_mass,
                           body_from_world * body.force_n + body.thrust_n + drag_n, body.torque_nm);
  BodyMotion free;
  free.velocity = {body.motion.velocity.linear + rate.linear * dt_s,
                   body.motion.velocity.angular + rate.angular * dt_s};
  free.world_from_body = moved(before, free.velocity, dt_s);
  // As the turned body sees it.
  const Quat after_from_before = glm::conjugate(free.world_from_body.rotation) * before.rotation;
  free.velocity.linear = after_from_before * free.velocity.linear;
  body.free_energy_j = kinetic_energy(body.mass, free.velocity);
  body.motion = move_body(world, body.shape, body.inverse_mass, before, free, dt_s, &body.report);
}

std::uint64_t motion_hash(const BodyMotion& motion) {
  Hash64 hash;
  hash.add(motion.world_from_body.position_m);
  hash.add(motion.world_from_body.rotation);
  hash.add(motion.velocity);
  return hash.value();
}

Mesh sheet_mesh(double half_x_m, double half_z_m, int cuts) {
  Mesh mesh;
  for (int z = 0; z <= cuts; ++z)
    for (int x = 0; x <= cuts; ++x)
      mesh.vertices_m.emplace_back(half_x_m * (2.0 * x / cuts - 1.0), 0.0,
                                   half_z_m * (2.0 * z / cuts - 1.0));
  const auto at = [&](int x, int z) { return static_cast<std::uint32_t>(z * (cuts + 1) + x); };
  for (int z = 0; z < cuts; ++z)
    for (int x = 0; x < cuts; ++x) {
      const std::uint32_t nw = at(x, z), ne = at(x + 1, z), sw = at(x, z + 1),
                          se = at(x + 1, z + 1);
      mesh.indices.insert(mesh.indices.end(), {nw, sw, ne, ne, sw, se});
    }
  return mesh;
}

Mesh box_mesh(const Vec3& half_m, int cuts) {
  Mesh box;
  // Six sheets, each turned so that its up leads out.
  const Quat turns[6] = {glm::angleAxis(0.0, Vec3(1.0, 0.0, 0.0)),
                         glm::angleAxis(kPi, Vec3(1.0, 0.0, 0.0)),
                         glm::angleAxis(kPi / 2.0, Vec3(1.0, 0.0, 0.0)),
                         glm::angleAxis(-kPi / 2.0, Vec3(1.0, 0.0, 0.0)),
                         glm::angleAxis(kPi / 2.0, Vec3(0.0, 0.0, 1.0)),
                         glm::angleAxis(-kPi / 2.0, Vec3(0.0, 0.0, 1.0))};
  const Mesh face = sheet_mesh(1.0, 1.0, cuts);
  for (const Quat& turn : turns) {
    const auto base = static_cast<std::uint32_t>(box.vertices_m.size());
    for (const Vec3f& v : face.vertices_m) {
      const Vec3 p = turn * (Vec3(v) + Vec3(0.0, 1.0, 0.0));
      // To a grid of a millionth, so that corners of neighbouring faces are the same numbers.
      box.vertices_m.emplace_back(glm::round(p * 1e6) / 1e6 * half_m);
    }
    for (const std::uint32_t i : face.indices) box.indices.push_back(base + i);
  }
  return box;
}

StaticWorld world_of(const Mesh& mesh, const Placement& placement, const Surface& surface) {
  StaticWorldBuilder builder;
  const auto shape = builder.add_mesh(mesh.vertices_m, mesh.indices, "mesh");
  EXPECT_TRUE(shape.ok());
  builder.place(*shape, placement, surface);
  return builder.build();
}

StaticWorld flat_seabed(const Surface& surface, const Vec3& at_m) {
  StaticWorldBuilder builder;
  const std::vector<float> heights_m(41 * 41, 0.0f);
  const auto shape = builder.add_heights(41, 41, 1.0, heights_m, "seabed");
  EXPECT_TRUE(shape.ok());
  builder.place(*shape, {{at_m, Quat(1.0, 0.0, 0.0, 0.0)}}, surface);
  return builder.build();
}

}  // namespace neritic::sim::test
