// Checks every promise of model.hpp on a loaded model: used by the loader's tests on real,
// broken and fuzzed files. Returns the first broken promise in words, nothing where all hold.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "engine/scene/model.hpp"

namespace neritic::test {

inline std::string broken_promise(const scene::Primitive& p, std::size_t n_materials) {
  const std::size_t n = p.positions.size();
  const auto fits = [n](const auto& list) { return list.empty() || list.size() == n; };
  if (p.normals.size() != n) return fmt::format("{} normals for {} positions", p.normals.size(), n);
  if (!fits(p.tangents) || !fits(p.uv0) || !fits(p.uv1) || !fits(p.colors) || !fits(p.joints) ||
      !fits(p.weights))
    return "an attribute of another length than the positions";
  if (p.joints.empty() != p.weights.empty()) return "joints without weights";
  const bool triangles = p.topology == scene::Topology::kTriangles;
  const std::size_t corners = triangles ? 3 : p.topology == scene::Topology::kLines ? 2 : 1;
  if (p.indices.size() % corners != 0) return "an incomplete last shape";
  for (const auto index : p.indices)
    if (index >= n) return fmt::format("index {} of {} vertices", index, n);
  if (p.material >= 0 && static_cast<std::size_t>(p.material) >= n_materials) return "a material";
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_finite(Vec3(p.positions[i]))) return "a position that is not finite";
    const float length = glm::length(p.normals[i]);
    if (!(std::abs(length - 1.0f) < 1e-4f) && !(length == 0.0f && !triangles))
      return fmt::format("a normal of length {}", length);
    if (!p.tangents.empty()) {
      if (!(std::abs(glm::length(Vec3f(p.tangents[i])) - 1.0f) < 1e-4f))
        return "a tangent's length";
      if (std::abs(p.tangents[i].w) != 1.0f) return "a tangent's handedness";
    }
    if (!p.weights.empty()) {
      const Vec4f w = p.weights[i];
      if (!(std::abs(w.x + w.y + w.z + w.w - 1.0f) < 1e-4f)) return "weights that do not sum to 1";
    }
    if (!p.colors.empty())
      for (int k = 0; k < 4; ++k)
        if (!(p.colors[i][k] >= 0.0f && p.colors[i][k] <= 1.0f)) return "a colour beyond 0 to 1";
    if (!p.uv0.empty() && !(std::isfinite(p.uv0[i].x) && std::isfinite(p.uv0[i].y)))
      return "a texture coordinate that is not finite";
  }
  for (const scene::MorphTarget& t : p.targets)
    if (!fits(t.positions) || !fits(t.normals)) return "a morph target's length";
  return {};
}

inline std::string broken_promise(const scene::Model& model) {
  const int n_nodes = static_cast<int>(model.nodes.size());
  for (const auto& mesh : model.meshes)
    for (const auto& primitive : mesh.primitives) {
      if (auto broken = broken_promise(primitive, model.materials.size()); !broken.empty())
        return mesh.name + ": " + broken;
      if (primitive.targets.size() != mesh.weights.size()) return "weights per morph target";
    }
  for (const auto& texture : model.textures)
    if (texture.image >= static_cast<int>(model.images.size())) return "a texture's image";
  for (const auto& m : model.materials)
    for (const auto* ref : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                            &m.occlusion_texture, &m.emissive_texture}) {
      if (!ref->present()) continue;
      if (ref->texture >= static_cast<int>(model.textures.size())) return "a material's texture";
      if (model.textures[ref->texture].image < 0) return "a material's texture without image";
      if (ref->uv_set != 0 && ref->uv_set != 1) return "a texture coordinate set";
    }
  for (const auto& image : model.images)
    if (image.channels != 4 || image.data.size() != std::size_t{image.width} * image.height * 4 ||
        image.empty())
      return "an image that is not RGBA";
  for (const auto& skin : model.skins) {
    if (skin.inverse_bind.size() != skin.joints.size()) return "inverse binds per joint";
    for (const int joint : skin.joints)
      if (joint < 0 || joint >= n_nodes) return "a skin's joint";
  }
  for (int i = 0; i < n_nodes; ++i) {
    const auto& node = model.nodes[i];
    for (const int child : node.children)
      if (child < 0 || child >= n_nodes || model.nodes[child].parent != i) return "a node's child";
    if (node.mesh >= static_cast<int>(model.meshes.size())) return "a node's mesh";
    if (node.skin >= static_cast<int>(model.skins.size())) return "a node's skin";
    if (node.light >= static_cast<int>(model.lights.size())) return "a node's light";
    if (node.skin < 0 || node.mesh < 0) continue;
    for (const auto& primitive : model.meshes[node.mesh].primitives)
      for (const auto& joints : primitive.joints)
        for (const auto joint : joints)
          if (joint >= model.skins[node.skin].joints.size()) return "a joint beyond the skin";
  }
  for (const int root : model.roots)
    if (root < 0 || root >= n_nodes || model.nodes[root].parent >= 0) return "a root";
  for (const auto& clip : model.clips)
    for (const auto& c : clip.channels) {
      const bool cubic = c.interpolation == scene::Channel::Interpolation::kCubic;
      if (c.node < 0 || c.node >= n_nodes || c.times_s.empty()) return "a channel";
      if (c.values.size() != c.times_s.size() * c.width * (cubic ? 3 : 1))
        return "a channel's values";
    }
  for (const auto& note : model.notes)
    if (note.find('\n') != note.npos) return "a note of two lines";
  return {};
}

}  // namespace neritic::test
