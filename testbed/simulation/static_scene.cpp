#include "testbed/simulation/static_scene.hpp"

#include <map>
#include <tuple>

#include "engine/scene/animation.hpp"

namespace neritic::testbed {
namespace {

using scene::Collision;
using scene::Model;
using scene::ModelPose;
using scene::Primitive;

// Triangles of one thing, in its own frame.
struct ThingMesh {
  std::vector<Vec3f> vertices_m;
  std::vector<std::uint32_t> indices;
};

// A model at rest as triangles: what clips could move stands as the file has it, skins and morphs
// included.
class RestMesh {
 public:
  RestMesh(const Model& model, const Mat4& thing_from_model)
      : model_(model),
        pose_(scene::evaluate_pose(model, -1, 0.0)),
        thing_from_model_(thing_from_model) {
    for (const int root : model.roots) add_node(root);
  }
  ThingMesh take() { return std::move(mesh_); }

 private:
  void add_node(int index) {
    const auto at = static_cast<std::size_t>(index);
    const scene::Node& node = model_.nodes[at];
    if (node.mesh >= 0) {
      joints_ =
          node.skin >= 0 ? scene::joint_matrices(model_, pose_, node.skin) : std::vector<Mat4>();
      const std::vector<Mat4> once{Mat4(1.0)};
      for (const Mat4& node_from_instance : node.instances.empty() ? once : node.instances)
        for (const Primitive& p : model_.meshes[static_cast<std::size_t>(node.mesh)].primitives)
          add_primitive(p, pose_.morph_weights[at],
                        thing_from_model_ * pose_.model_from_node[at] * node_from_instance);
    }
    for (const int child : node.children) add_node(child);
  }

  void add_primitive(const Primitive& p, const std::vector<float>& weights,
                     const Mat4& thing_from_mesh) {
    if (p.topology != scene::Topology::kTriangles) return;
    const auto first = static_cast<std::uint32_t>(mesh_.vertices_m.size());
    const bool skinned = !joints_.empty() && p.joints.size() == p.positions.size();
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
      Vec3 at(p.positions[i]);
      for (std::size_t t = 0; t < p.targets.size() && t < weights.size(); ++t)
        if (!p.targets[t].positions.empty())
          at += double{weights[t]} * Vec3(p.targets[t].positions[i]);
      // A skin places its vertices by the joints alone (glTF).
      const Mat4 m = skinned ? thing_from_model_ * joint_blend(p, i) : thing_from_mesh;
      mesh_.vertices_m.emplace_back(Vec3(m * Vec4(at, 1.0)));
    }
    for (const std::uint32_t index : p.indices) mesh_.indices.push_back(first + index);
  }

  Mat4 joint_blend(const Primitive& p, std::size_t i) const {
    Mat4 m(0.0);
    for (int k = 0; k < 4; ++k)
      if (p.weights[i][k] > 0.0f) m += double{p.weights[i][k]} * joints_[p.joints[i][k]];
    return m;
  }

  const Model& model_;
  ModelPose pose_;
  Mat4 thing_from_model_;
  std::vector<Mat4> joints_;  // of the node at hand
  ThingMesh mesh_;
};

Mat4 scaling(const Vec3& scale) {
  Mat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
  return m;
}

// The matrix as a turn, a move and one scale; nothing where it is more than that.
std::optional<sim::Placement> rigid_placement(const Mat4& m) {
  const Mat3 linear(m);
  const double scale = glm::length(linear[0]);
  if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
  const Mat3 turn = linear / scale;
  const Mat3 off = glm::transpose(turn) * turn - Mat3(1.0);
  for (int i = 0; i < 3; ++i)
    if (!(glm::length(off[i]) < 1e-6)) return std::nullopt;
  if (glm::determinant(turn) < 0.0) return std::nullopt;
  return sim::Placement{{Vec3(m[3]), glm::normalize(glm::quat_cast(turn))}, scale};
}

class StaticSceneBuilder {
 public:
  explicit StaticSceneBuilder(const scene::Scene& scene) : scene_(scene) {}

  Status add(const scene::Object& object) {
    if (object.copies.empty()) {
      NERITIC_TRY(const auto shape, shape_of(object, scaling(object.scale)));
      builder_.place(shape, {scene_.world_from(object.mount), 1.0}, surface(object, 0));
      return {};
    }
    for (std::size_t i = 0; i < object.copies.size(); ++i) NERITIC_TRY_STATUS(add_copy(object, i));
    return {};
  }
  sim::StaticWorld build() { return builder_.build(); }

 private:
  Status add_copy(const scene::Object& object, std::size_t i) {
    const Pose world_from_object = scene_.world_from(object.mount);
    if (const auto place = rigid_placement(object.copies[i])) {
      NERITIC_TRY(const auto shape, shape_of(object, Mat4(1.0)));
      builder_.place(shape, {world_from_object * place->world_from_thing, place->scale},
                     surface(object, i));
      return {};
    }
    NERITIC_TRY(const auto shape, make(object, object.copies[i]));
    builder_.place(shape, {world_from_object, 1.0}, surface(object, i));
    return {};
  }

  static sim::Surface surface(const scene::Object& object, std::size_t copy) {
    sim::Surface surface;
    surface.label = static_cast<std::uint32_t>(object.instance + copy);
    return surface;
  }

  Result<std::uint32_t> make(const scene::Object& object, const Mat4& thing_from_model) {
    const Model& model = *scene_.models[static_cast<std::size_t>(object.model)];
    const std::string name = fmt::format("{}: object {}", scene_.path, object.name);
    if (object.collision == Collision::kMesh && is_seabed(model, thing_from_model))
      return make_seabed(*model.heights, thing_from_model, name);
    const ThingMesh mesh = RestMesh(model, thing_from_model).take();
    if (object.collision == Collision::kMesh)
      return builder_.add_mesh(mesh.vertices_m, mesh.indices, name);
    const std::vector<Vec3> points(mesh.vertices_m.begin(), mesh.vertices_m.end());
    return builder_.add_hull(points, name);
  }

  // A terrain is a grid of heights, solid below, unless it is scaled otherwise in x than in z.
  static bool is_seabed(const Model& model, const Mat4& m) {
    return model.heights && m == scaling(Vec3(m[0][0], m[1][1], m[0][0])) && m[0][0] > 0.0;
  }
  Result<std::uint32_t> make_seabed(const scene::Heightfield& field, const Mat4& m,
                                    const std::string& name) {
    std::vector<float> heights_m(field.heights_m);
    for (float& height_m : heights_m) height_m = static_cast<float>(height_m * m[1][1]);
    return builder_.add_heights(field.columns, field.rows, field.cell_m * m[0][0], heights_m, name);
  }

  // One shape for all that look alike.
  Result<std::uint32_t> shape_of(const scene::Object& object, const Mat4& thing_from_model) {
    const auto key = std::tuple(object.model, object.collision, thing_from_model[0][0],
                                thing_from_model[1][1], thing_from_model[2][2]);
    if (const auto known = shapes_.find(key); known != shapes_.end()) return known->second;
    NERITIC_TRY(const auto shape, make(object, thing_from_model));
    shapes_[key] = shape;
    return shape;
  }

  const scene::Scene& scene_;
  sim::StaticWorldBuilder builder_;
  std::map<std::tuple<int, Collision, double, double, double>, std::uint32_t> shapes_;
};

}  // namespace

bool stands_still(const scene::Scene& scene, const scene::Object& object) {
  if (object.mount.track || object.mount.afloat || object.dynamics || object.human ||
      !object.inputs.empty())
    return false;
  if (object.mount.object < 0) return true;
  const scene::Object& by = scene.objects[static_cast<std::size_t>(object.mount.object)];
  return (object.mount.joint < 0 || by.clip < 0) && stands_still(scene, by);
}

std::vector<Vec3> rest_points(const scene::Model& model, const Vec3& scale) {
  const ThingMesh mesh = RestMesh(model, scaling(scale)).take();
  return {mesh.vertices_m.begin(), mesh.vertices_m.end()};
}

Result<sim::StaticWorld> static_world_of(const scene::Scene& scene) {
  StaticSceneBuilder builder(scene);
  for (const scene::Object& object : scene.objects)
    if (object.collision != Collision::kNone && object.model >= 0 && stands_still(scene, object))
      NERITIC_TRY_STATUS(builder.add(object));
  return builder.build();
}

}  // namespace neritic::testbed
