// A rigid body in water for tests: mass with added mass, weight and a wrench, stepped by
// semi-implicit Euler, with contacts. And the things it meets.
#pragma once

#include <vector>

#include "engine/sim/motion.hpp"

namespace neritic::sim::test {

using Mass = std::array<double, 36>;

// The mass matrix of a body with its centre of mass at the origin of its axes.
Mass mass_of(double mass_kg, const Vec3& inertia_kg_m2, const Vec3& added_kg = Vec3(0.0),
             const Vec3& added_kg_m2 = Vec3(0.0));
// Inverse by elimination.
InverseMass inverse_of(const Mass& mass);
double kinetic_energy(const Mass& mass, const Twist& velocity);
Twist times(const InverseMass& inverse, const Vec3& force_n, const Vec3& torque_nm);

struct Body {
  BodyShape shape;
  Mass mass{};
  InverseMass inverse_mass{};
  BodyMotion motion;
  Vec3 force_n{0.0};           // world axes
  Vec3 thrust_n{0.0};          // body axes
  Vec3 torque_nm{0.0};         // body axes
  double drag_n_s_m = 0.0;     // linear
  MotionReport report;         // of the last step
  double free_energy_j = 0.0;  // what it would have had without contacts
};
Body make_body(BodyShape shape, const Mass& mass, const Pose& pose);
// A cube of water's density turned solid: half size, mass, inertia, weight in water of one newton a
// kg.
Body make_box_body(const Vec3& half_m, double mass_kg, const Pose& pose);
void step(Body& body, const StaticWorld& world, double dt_s);
// Over all that was set in motion.
std::uint64_t motion_hash(const BodyMotion& motion);

struct Mesh {
  std::vector<Vec3f> vertices_m;
  std::vector<std::uint32_t> indices;
};
Mesh box_mesh(const Vec3& half_m, int cuts = 1);  // closed, each face cut into cuts^2 squares
Mesh sheet_mesh(double half_x_m, double half_z_m, int cuts);  // y = 0, faces up
StaticWorld world_of(const Mesh& mesh, const Placement& placement = {},
                     const Surface& surface = {});
// A horizontal seabed at y = 0, with cells of a metre.
StaticWorld flat_seabed(const Surface& surface = {}, const Vec3& at_m = Vec3(0.0));

}  // namespace neritic::sim::test
