#include "tools/tradeoff/flatten.hpp"

#include "engine/scene/animation.hpp"
#include "sonar/backscatter.hpp"

namespace neritic::tools {
namespace {

using scene::Model;
using scene::ModelPose;
using scene::Primitive;

struct Vertex {
  Vec3 position, normal;
};

// A vertex with its morph targets applied, in the mesh's frame.
Vertex morphed(const Primitive& p, std::size_t i, const std::vector<float>& weights) {
  Vertex v{Vec3(p.positions[i]), Vec3(p.normals[i])};
  for (std::size_t t = 0; t < p.targets.size() && t < weights.size(); ++t) {
    if (!p.targets[t].positions.empty())
      v.position += double{weights[t]} * Vec3(p.targets[t].positions[i]);
    if (!p.targets[t].normals.empty())
      v.normal += double{weights[t]} * Vec3(p.targets[t].normals[i]);
  }
  return v;
}

Mat4 skin_matrix(const Primitive& p, std::size_t i, const std::vector<Mat4>& joints) {
  Mat4 m(0.0);
  for (int k = 0; k < 4; ++k)
    if (p.weights[i][k] > 0.0f) m += double{p.weights[i][k]} * joints[p.joints[i][k]];
  return m;
}

void add_primitive(Triangles& out, const Primitive& p, const std::vector<float>& weights,
                   const std::vector<Mat4>& joints, const Mat4& frame_from_mesh,
                   const Mat4& frame_from_model, const scene::Object& object) {
  if (p.topology != scene::Topology::kTriangles) return;
  const auto first = static_cast<std::uint32_t>(out.positions.size());
  const bool skinned = !joints.empty() && p.joints.size() == p.positions.size();
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    const Vertex v = morphed(p, i, weights);
    // A skin places its vertices by the joints alone; the node's own transform does not count
    // (glTF).
    const Mat4 m = skinned ? frame_from_model * skin_matrix(p, i, joints) : frame_from_mesh;
    const Vec3 normal = glm::transpose(glm::inverse(Mat3(m))) * v.normal;
    const double size = glm::length(normal);
    out.positions.emplace_back(Vec3(m * Vec4(v.position, 1.0)));
    out.normals.emplace_back(size > 0.0 ? normal / size : Vec3(0, 1, 0));
  }
  // A mirrored mesh turns its faces inside out; glTF says that the winding follows.
  const bool mirrored = glm::determinant(Mat3(skinned ? frame_from_model : frame_from_mesh)) < 0.0;
  const double backscatter = sonar::backscatter_strength(object);
  for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    const std::uint32_t a = p.indices[i], b = p.indices[i + 1], c = p.indices[i + 2];
    out.indices.insert(out.indices.end(),
                       {first + a, first + (mirrored ? c : b), first + (mirrored ? b : c)});
    out.classes.push_back(object.class_id);
    out.reflectivity.push_back(object.reflectivity);
    out.backscatter.push_back(backscatter);
  }
}

void add_node(Triangles& out, const Model& model, const ModelPose& pose, int index,
              const Mat4& frame_from_model, const scene::Object& object) {
  const scene::Node& node = model.nodes[static_cast<std::size_t>(index)];
  if (node.mesh >= 0) {
    const auto joints =
        node.skin >= 0 ? scene::joint_matrices(model, pose, node.skin) : std::vector<Mat4>();
    const auto& weights = pose.morph_weights[static_cast<std::size_t>(index)];
    const Mat4 frame_from_node =
        frame_from_model * pose.model_from_node[static_cast<std::size_t>(index)];
    const std::vector<Mat4> once{Mat4(1.0)};
    for (const Mat4& node_from_instance : node.instances.empty() ? once : node.instances)
      for (const Primitive& p : model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
        add_primitive(out, p, weights, joints, frame_from_node * node_from_instance,
                      frame_from_model, object);
  }
  for (const int child : node.children) add_node(out, model, pose, child, frame_from_model, object);
}

}  // namespace

Triangles flatten(const scene::Scene& scene, double time_s, const Pose& frame_from_world) {
  Triangles out;
  for (const scene::Object& object : scene.objects) {
    if (object.model < 0) continue;
    const Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    const ModelPose pose =
        scene::evaluate_pose(model, object.clip, object.clip_offset_s + time_s * object.clip_rate);
    for (std::size_t copy = 0; copy < object.instance_count(); ++copy)
      for (const int root : model.roots)
        add_node(out, model, pose, root,
                 to_matrix(frame_from_world) * scene.world_from_copy(object, copy, time_s), object);
  }
  return out;
}

}  // namespace neritic::tools
