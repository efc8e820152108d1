// One named node of a model as a model of its own: the node and what hangs below it, at the origin
// (its own turn and scale stay, its place and its parents' transforms go). Pure; any thread.
#include <algorithm>
#include <map>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"

namespace neritic::scene {
namespace {

std::vector<bool> below(const Model& model, int root) {
  std::vector<bool> kept(model.nodes.size(), false);
  std::vector<int> open{root};
  while (!open.empty()) {
    const auto node = static_cast<std::size_t>(open.back());
    open.pop_back();
    if (kept[node]) continue;
    kept[node] = true;
    open.insert(open.end(), model.nodes[node].children.begin(), model.nodes[node].children.end());
  }
  return kept;
}

// Moves an index of the old model to the new one, copying what it stands for on first use.
class Mover {
 public:
  Mover(const Model& from, Model& to) : from_(from), to_(to) {}

  int mesh(int old) {
    return move(meshes_, old, from_.meshes, to_.meshes, [&](Mesh& mesh) {
      for (Primitive& primitive : mesh.primitives)
        primitive.material = material(primitive.material);
    });
  }

 private:
  template <class T, class Fix>
  static int move(std::map<int, int>& moved, int old, const std::vector<T>& from,
                  std::vector<T>& to, Fix fix) {
    if (old < 0) return old;
    const auto [at, is_new] = moved.emplace(old, static_cast<int>(to.size()));
    if (is_new) {
      to.push_back(from[static_cast<std::size_t>(old)]);
      fix(to.back());
    }
    return at->second;
  }
  int material(int old) {
    return move(materials_, old, from_.materials, to_.materials, [&](Material& m) {
      for (TextureRef* ref :
           {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
            &m.occlusion_texture, &m.emissive_texture, &m.detail_texture})
        ref->texture = texture(ref->texture);
    });
  }
  int texture(int old) {
    return move(textures_, old, from_.textures, to_.textures, [&](Texture& t) {
      t.image = move(images_, t.image, from_.images, to_.images, [](ImageU8&) {});
    });
  }

  const Model& from_;
  Model& to_;
  std::map<int, int> meshes_, materials_, textures_, images_;
};

}  // namespace

Result<Model> model_of_node(const Model& model, const std::string& name) {
  const auto at = std::find_if(model.nodes.begin(), model.nodes.end(),
                               [&](const Node& node) { return node.name == name; });
  if (at == model.nodes.end()) {
    std::vector<std::string_view> names;
    for (const Node& node : model.nodes) names.push_back(node.name);
    return refusal(
        model.name, fmt::format("node \"{}\"", printable(name)),
        fmt::format("a node of the file (nearest: \"{}\")", printable(nearest(name, names))));
  }
  const int root = static_cast<int>(at - model.nodes.begin());
  const std::vector<bool> kept = below(model, root);

  Model part;
  part.name = model.name + "#" + name;
  part.lights = model.lights;
  part.skins = model.skins;
  part.clips = model.clips;
  part.notes = model.notes;
  part.nodes = model.nodes;  // indices of skins and clips stay valid
  part.roots = {root};
  Mover mover(model, part);
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    Node& node = part.nodes[i];
    node.mesh = kept[i] ? mover.mesh(node.mesh) : -1;
    if (!kept[i] || node.skin < 0) continue;
    for (const int joint : model.skins[static_cast<std::size_t>(node.skin)].joints)
      if (!kept[static_cast<std::size_t>(joint)])
        return refusal(model.name,
                       fmt::format("node \"{}\", which joints outside it move", printable(name)),
                       "the whole model");
  }
  Node& node = part.nodes[static_cast<std::size_t>(root)];
  if (node.parent >= 0)
    std::erase(part.nodes[static_cast<std::size_t>(node.parent)].children, root);
  node.parent = -1;
  node.translation_m = Vec3(0.0);
  if (node.matrix) (*node.matrix)[3] = Vec4(0.0, 0.0, 0.0, 1.0);
  return part;
}

}  // namespace neritic::scene
