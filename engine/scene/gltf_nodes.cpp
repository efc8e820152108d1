// Nodes, skins and the default scene. See gltf_stages.hpp. Source: Khronos glTF 2.0 sections 3.5
// and 3.7.3; EXT_mesh_gpu_instancing.
#include <algorithm>
#include <cmath>

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {
namespace {

// Numbers of transforms stay below this, so that products of a few hundred of them stay finite.
double bounded(double value) {
  constexpr double kLimit = 1e15;
  return std::clamp(value, -kLimit, kLimit);
}

void load_transform(Field field, Node& out) {
  const auto t = field["translation"].numbers<3>({0.0, 0.0, 0.0});
  const auto r = field["rotation"].numbers<4>({0.0, 0.0, 0.0, 1.0});
  const auto s = field["scale"].numbers<3>({1.0, 1.0, 1.0});
  out.translation_m = Vec3(bounded(t[0]), bounded(t[1]), bounded(t[2]));
  out.rotation = unit_or_identity(Quat(r[3], r[0], r[1], r[2]));
  out.scale = Vec3(bounded(s[0]), bounded(s[1]), bounded(s[2]));
  if (!field["matrix"].present()) return;
  const auto m = field["matrix"].numbers<16>({});
  out.matrix.emplace(1.0);
  for (int i = 0; i < 16; ++i) (*out.matrix)[i / 4][i % 4] = bounded(m[i]);
}

void load_instances(Loading& loading, Field field, Node& out) {
  const Field attributes = field.extension("EXT_mesh_gpu_instancing")["attributes"];
  if (!attributes.present()) return;
  const auto translations = loading.resources.vec3s(attributes["TRANSLATION"]);
  const auto rotations =
      loading.resources.vec4s(attributes["ROTATION"], Integers::kAlwaysNormalized);
  const auto scales = loading.resources.vec3s(attributes["SCALE"]);
  const std::size_t n = std::max({translations.size(), rotations.size(), scales.size()});
  for (const std::size_t length : {translations.size(), rotations.size(), scales.size()})
    if (length != 0 && length != n)
      attributes.refuse(fmt::format("attributes of {} and {} instances", length, n),
                        "one number for all");
  if (loading.report.failed() || !loading.resources.charge(n * sizeof(Mat4), attributes)) return;
  for (std::size_t i = 0; i < n; ++i) {
    Node instance;
    if (!translations.empty()) instance.translation_m = Vec3(translations[i]);
    if (!rotations.empty()) {
      const Vec4f& r = rotations[i];
      instance.rotation = unit_or_identity(Quat(r.w, r.x, r.y, r.z));
    }
    if (!scales.empty()) instance.scale = Vec3(scales[i]);
    Mat4 matrix = glm::mat4_cast(instance.rotation);
    for (int k = 0; k < 3; ++k) matrix[k] *= instance.scale[k];
    matrix[3] = Vec4(instance.translation_m, 1.0);
    out.instances.push_back(matrix);
  }
}

Node load_node(Loading& loading, Field field) {
  Node out;
  const Field root = loading.root;
  out.name = field["name"].text();
  load_transform(field, out);
  out.mesh = field["mesh"].index(loading.model.meshes.size(), "meshes");
  out.skin = field["skin"].index(root["skins"].size(), "skins");
  out.light =
      field.extension("KHR_lights_punctual")["light"].index(loading.model.lights.size(), "lights");
  const Field children = field["children"], weights = field["weights"];
  const std::size_t n_nodes = root["nodes"].size();
  for (std::size_t i = 0; i < children.size(); ++i)
    out.children.push_back(children.at(i).index(n_nodes, "nodes"));
  for (std::size_t i = 0; i < weights.size(); ++i)
    out.weights.push_back(weights.at(i).number_f(0.0f));
  const std::size_t n_targets = out.mesh < 0 ? 0 : loading.model.meshes[out.mesh].weights.size();
  if (weights.present()) out.weights.resize(n_targets, 0.0f);
  if (out.mesh >= 0 && !loading.report.failed()) load_instances(loading, field, out);
  if (out.mesh < 0) out.skin = -1;
  return out;
}

void link_parents(Loading& loading) {
  auto& nodes = loading.model.nodes;
  const Field fields = loading.root["nodes"];
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
      const int child = nodes[i].children[k];
      if (nodes[child].parent >= 0) {
        fields.at(i)["children"].at(k).refuse(
            fmt::format("node {} as the child of nodes {} and {}", child, nodes[child].parent, i),
            "one parent");
        return;
      }
      nodes[child].parent = static_cast<int>(i);
    }
  // With one parent each, whoever the roots do not reach is part of a loop.
  std::vector<int> open;
  std::size_t n_reached = 0;
  std::vector<bool> reached(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent < 0) open.push_back(static_cast<int>(i));
  for (; !open.empty(); ++n_reached) {
    const int node = open.back();
    open.pop_back();
    reached[node] = true;
    open.insert(open.end(), nodes[node].children.begin(), nodes[node].children.end());
  }
  if (n_reached == nodes.size()) return;
  const auto looped = std::find(reached.begin(), reached.end(), false) - reached.begin();
  fields.at(looped).refuse("a node that is its own ancestor", "a tree");
}

// The largest joint that each mesh uses, -1 where it uses none. Once a mesh: many nodes may share
// it.
std::vector<int> largest_joints(const Model& model) {
  std::vector<int> out(model.meshes.size(), -1);
  for (std::size_t m = 0; m < out.size(); ++m)
    for (const Primitive& primitive : model.meshes[m].primitives)
      for (const auto& joints : primitive.joints)
        for (const std::uint16_t joint : joints) out[m] = std::max<int>(out[m], joint);
  return out;
}

// The mesh's joints must be the skin's.
void check_joints(Loading& loading, std::size_t node_index, const std::vector<int>& largest) {
  Node& node = loading.model.nodes[node_index];
  const int n_joints = static_cast<int>(loading.model.skins[node.skin].joints.size());
  const Field field = loading.root["nodes"].at(node_index);
  if (largest[node.mesh] >= n_joints)
    field["skin"].refuse(fmt::format("joint {} in the mesh", largest[node.mesh]),
                         fmt::format("joints of skin {}, which has {}", node.skin, n_joints));
  if (largest[node.mesh] >= 0) return;
  field.note_with("a skin on a mesh without joints is ignored");
  node.skin = -1;
}

}  // namespace

void load_nodes(Loading& loading) {
  const Field nodes = loading.root["nodes"];
  for (std::size_t i = 0; i < nodes.size() && !loading.report.failed(); ++i)
    loading.model.nodes.push_back(load_node(loading, nodes.at(i)));
  if (!loading.report.failed()) link_parents(loading);
}

void load_skins(Loading& loading) {
  const Field skins = loading.root["skins"];
  const std::size_t n_nodes = loading.model.nodes.size();
  for (std::size_t i = 0; i < skins.size() && !loading.report.failed(); ++i) {
    const Field field = skins.at(i), joints = field["joints"];
    Skin skin;
    skin.name = field["name"].text();
    field["skeleton"].index(n_nodes, "nodes");
    for (std::size_t k = 0; k < joints.size(); ++k)
      skin.joints.push_back(joints.at(k).index(n_nodes, "nodes"));
    if (skin.joints.empty()) field.refuse("no joints", "one or more");
    const Field inverse_bind = field["inverseBindMatrices"];
    if (inverse_bind.present()) skin.inverse_bind = loading.resources.matrices(inverse_bind);
    if (inverse_bind.present() && skin.inverse_bind.size() < skin.joints.size())
      inverse_bind.refuse(fmt::format("{} matrices", skin.inverse_bind.size()),
                          fmt::format("one for each of {} joints", skin.joints.size()));
    skin.inverse_bind.resize(skin.joints.size(), Mat4(1.0));
    loading.model.skins.push_back(std::move(skin));
  }
  const std::vector<int> largest = largest_joints(loading.model);
  for (std::size_t i = 0; i < loading.model.nodes.size() && !loading.report.failed(); ++i)
    if (loading.model.nodes[i].skin >= 0) check_joints(loading, i, largest);
}

void load_roots(Loading& loading) {
  Model& model = loading.model;
  const Field scenes = loading.root["scenes"];
  const int chosen = loading.root["scene"].index(scenes.size(), "scenes");
  if (scenes.size() == 0) {  // a library of nodes: show all of them
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      if (model.nodes[i].parent < 0) model.roots.push_back(static_cast<int>(i));
    return;
  }
  // Without a default the first scene is shown, as common viewers do.
  const Field nodes = scenes.at(std::max(chosen, 0))["nodes"];
  std::vector<bool> seen(model.nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int node = nodes.at(i).index(model.nodes.size(), "nodes");
    if (node < 0) return;
    if (model.nodes[node].parent >= 0) {
      nodes.at(i).refuse(fmt::format("node {}, a child of node {}", node, model.nodes[node].parent),
                         "nodes without a parent");
      return;
    }
    if (!seen[node]) model.roots.push_back(node);
    seen[node] = true;
  }
}

}  // namespace neritic::scene::gltf
