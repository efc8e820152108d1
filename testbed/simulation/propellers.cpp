#include "testbed/simulation/propellers.hpp"

#include <algorithm>

#include "engine/scene/animation.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// A face that turns about +z drives water towards +z if its normal n has n_z and n (z x r) of the
// same sign, whichever side it faces. The sum over all faces is that of the blades: round parts add
// nothing.
double pitch_sense(const scene::Mesh& mesh) {
  double sum = 0.0;
  for (const scene::Primitive& primitive : mesh.primitives) {
    if (primitive.topology != scene::Topology::kTriangles) continue;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) {
        return Vec3(primitive.positions[primitive.indices[i + k]]);
      };
      const Vec3 a = corner(0), b = corner(1), c = corner(2);
      const Vec3 normal = glm::cross(b - a, c - a);
      const double area = glm::length(normal);
      if (!(area > 0.0)) continue;
      const Vec3 middle = (a + b + c) / 3.0;
      sum += normal.z * (normal.y * middle.x - normal.x * middle.y) / area;
    }
  }
  return sum < 0.0 ? -1.0 : 1.0;
}

}  // namespace

std::vector<DrawnPropeller> drawn_propellers(const scene::Model& model,
                                             const rov::Vehicle& vehicle) {
  std::vector<DrawnPropeller> out;
  for (std::uint32_t i = 0; i < vehicle.thruster_count; ++i) {
    const auto found =
        std::ranges::find(model.nodes, fmt::format("propeller_{}", i), &scene::Node::name);
    if (found == model.nodes.end() || found->matrix) continue;
    DrawnPropeller propeller{i, static_cast<int>(found - model.nodes.begin()), 1.0, found->rotation,
                             found->scale};
    if (found->mesh >= 0)
      propeller.sense = pitch_sense(model.meshes[static_cast<std::size_t>(found->mesh)]);
    // What drives water towards +z pushes along -z.
    const Vec3 push = -Vec3(scene::evaluate_node(model, propeller.node, -1, 0.0)[2]);
    if (glm::dot(vehicle.thrusters[i].direction, rov::ned_from_world(push)) < 0.0)
      propeller.sense = -propeller.sense;
    out.push_back(propeller);
  }
  return out;
}

PropellerState next_propellers(const rov::Vehicle& vehicle, std::span<const double> forces_n,
                               double water_kg_m3, double dt_s, const PropellerState& before) {
  PropellerState after = before;
  for (std::size_t i = 0; i < forces_n.size(); ++i)
    after.revolutions[i] +=
        dt_s * rov::propeller_hz(vehicle.thrusters[i], forces_n[i], water_kg_m3);
  return after;
}

scene::NodeKey drawn_turns(const std::vector<DrawnPropeller>& propellers,
                           const rov::Vehicle& vehicle, const rov::State& body, double water_kg_m3,
                           const PropellerState& state, double time_s) {
  const auto forces_n = rov::thruster_forces(vehicle, body, body.held);
  scene::NodeKey key{time_s, {}, {}};
  for (const DrawnPropeller& propeller : propellers) {
    const std::size_t i = propeller.thruster;
    key.rotations.push_back(propeller.rotation);
    key.scales.push_back(propeller.scale);
    key.turns.push_back(
        {propeller.sense * state.revolutions[i],
         propeller.sense * rov::propeller_hz(vehicle.thrusters[i], forces_n[i], water_kg_m3)});
  }
  return key;
}

}  // namespace neritic::testbed
