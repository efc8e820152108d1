// Meshes: attributes, morph targets and indices of every primitive, checked and completed. See
// gltf_stages.hpp. Source: Khronos glTF 2.0 section 3.7; KHR_mesh_quantization.
#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/scene/gltf_draco.hpp"
#include "engine/scene/gltf_geometry.hpp"
#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {
namespace {

constexpr int kMaxInfluenceSets = 4;  // JOINTS_0 to JOINTS_3: 16 influences a vertex

// Fails where a list that is there is not as long as the positions.
template <class T>
bool check_length(const std::vector<T>& list, std::size_t expected, Field field) {
  if (list.empty() && !field.present()) return true;
  if (field.report().failed()) return false;
  if (list.size() == expected) return true;
  field.refuse(fmt::format("{} elements", list.size()),
               fmt::format("{}, as in POSITION", expected));
  return false;
}

struct Influence {
  std::uint16_t joint;
  float weight;
};

// The four largest influences of all sets, their weights scaled to sum 1.
void keep_four(std::vector<Influence>& influences, std::array<std::uint16_t, 4>& joints,
               Vec4f& weights) {
  if (influences.size() > 4)
    std::stable_sort(influences.begin(), influences.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) sum += influences[k].weight;
  joints = {0, 0, 0, 0};
  weights = Vec4f(1.0f, 0.0f, 0.0f, 0.0f);  // a vertex without influences follows the first joint
  for (int k = 0; k < 4 && sum > 0.0; ++k) {
    weights[k] = static_cast<float>(influences[k].weight / sum);
    joints[k] = weights[k] > 0.0f ? influences[k].joint : std::uint16_t{0};
  }
}

void load_influences(Loading& loading, Field attributes, Primitive& out) {
  std::vector<std::vector<std::array<std::uint16_t, 4>>> joints;
  std::vector<std::vector<Vec4f>> weights;
  for (int set = 0; set < kMaxInfluenceSets; ++set) {
    const Field j = attributes[fmt::format("JOINTS_{}", set)];
    const Field w = attributes[fmt::format("WEIGHTS_{}", set)];
    if (!j.present() && !w.present()) break;
    if (j.present() != w.present()) {
      attributes.refuse(fmt::format("one of JOINTS_{} and WEIGHTS_{}", set, set),
                        "both or neither");
      return;
    }
    joints.push_back(loading.resources.joints(j));
    weights.push_back(loading.resources.vec4s(w, Integers::kAlwaysNormalized));
    if (!check_length(joints.back(), out.positions.size(), j)) return;
    if (!check_length(weights.back(), out.positions.size(), w)) return;
  }
  if (joints.empty()) return;
  out.joints.resize(out.positions.size());
  out.weights.resize(out.positions.size());
  std::vector<Influence> influences;
  for (std::size_t v = 0; v < out.positions.size(); ++v) {
    influences.clear();
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (int k = 0; k < 4; ++k)
        influences.push_back({joints[set][v][k], std::max(0.0f, weights[set][v][k])});
    keep_four(influences, out.joints[v], out.weights[v]);
  }
}

void load_attributes(Loading& loading, Field attributes, Primitive& out) {
  Resources& resources = loading.resources;
  const std::size_t n = out.positions.size();
  const auto read_uv = [&](const char* name, std::vector<Vec2f>& list) {
    list = resources.vec2s(attributes[name]);
    check_length(list, n, attributes[name]);
  };
  out.normals = resources.vec3s(attributes["NORMAL"]);
  check_length(out.normals, n, attributes["NORMAL"]);
  // "When normals are not specified, [...] the provided tangents (if present) MUST be ignored."
  if (!out.normals.empty()) out.tangents = resources.vec4s(attributes["TANGENT"]);
  if (!out.normals.empty()) check_length(out.tangents, n, attributes["TANGENT"]);
  read_uv("TEXCOORD_0", out.uv0);
  read_uv("TEXCOORD_1", out.uv1);
  out.colors = resources.colors(attributes["COLOR_0"]);
  check_length(out.colors, n, attributes["COLOR_0"]);
  if (!loading.report.failed()) load_influences(loading, attributes, out);
}

void load_targets(Loading& loading, Field targets, Primitive& out) {
  const std::size_t n = out.positions.size();
  for (std::size_t i = 0; i < targets.size() && !loading.report.failed(); ++i) {
    const Field field = targets.at(i);
    MorphTarget target;
    const auto read = [&](const char* name, bool has_base, std::vector<Vec3f>& list) {
      if (!field[name].present()) return;
      if (!has_base) {
        field[name].note_with("ignored, the primitive itself has no {}", name);
        return;
      }
      list = loading.resources.vec3s(field[name]);
      check_length(list, n, field[name]);
    };
    read("POSITION", true, target.positions);
    read("NORMAL", !out.normals.empty(), target.normals);
    out.targets.push_back(std::move(target));
  }
}

void load_indices(Loading& loading, Field field, Mode mode, Primitive& out) {
  std::vector<std::uint32_t> indices;
  if (field.present()) {
    indices = loading.resources.indices(field);
  } else {
    indices.resize(out.positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  const auto largest = std::max_element(indices.begin(), indices.end());
  if (largest != indices.end() && *largest >= out.positions.size()) {
    field.refuse(fmt::format("index {}", *largest),
                 fmt::format("an index below {}, the number of vertices", out.positions.size()));
    return;
  }
  out.topology = topology_of(mode);
  out.indices = to_list(mode, std::move(indices));
}

// Normals and tangents as the material needs them; the primitive is whole before.
void complete(const Material* material, Field normals, Primitive& p) {
  const bool triangles = p.topology == Topology::kTriangles;
  if (!p.normals.empty()) {
    if (const std::size_t n_off = repair_normals(p); n_off > 0)
      normals.note_with("{} of {} normals are not of length 1, they are made so", n_off,
                        p.normals.size());
  } else if (triangles) {
    make_flat_normals(p);
  } else {
    p.normals.assign(p.positions.size(), Vec3f(0.0f));
  }
  if (!p.tangents.empty())
    repair_tangents(p);
  else if (triangles && material && material->normal_texture.present())
    make_tangents(p, material->normal_texture);
  for (const Vec3f& position : p.positions) p.bounds.add(Vec3(position));
}

// False where the primitive has nothing to draw.
bool load_primitive(Loading& loading, Field field, Primitive& out) {
  const Field attributes = field["attributes"];
  out.material = field["material"].index(loading.model.materials.size(), "materials");
  const std::uint64_t mode = field["mode"].whole(4, 6);
  if (!attributes["POSITION"].present()) {
    field.note_with("no POSITION, nothing is drawn");
    return false;
  }
  unpack_draco(loading, field);
  out.positions = loading.resources.vec3s(attributes["POSITION"]);
  if (loading.report.failed()) return false;
  out.file_vertices = static_cast<std::uint32_t>(out.positions.size());
  load_attributes(loading, attributes, out);
  if (!loading.report.failed()) load_targets(loading, field["targets"], out);
  if (!loading.report.failed())
    load_indices(loading, field["indices"], static_cast<Mode>(mode), out);
  // Strips become up to three times as many indices, flat normals up to six vertices an index.
  if (!loading.report.failed()) loading.resources.charge(out.indices.size() * 64, field);
  if (loading.report.failed()) return false;
  complete(out.material < 0 ? nullptr : &loading.model.materials[out.material],
           attributes["NORMAL"], out);
  return true;
}

void load_default_weights(Field field, Mesh& mesh) {
  const std::size_t n_targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
  const Field weights = field["weights"];
  for (std::size_t i = 0; i < weights.size(); ++i)
    mesh.weights.push_back(weights.at(i).number_f(0.0f));
  if (weights.present() && mesh.weights.size() != n_targets)
    weights.note_with("{} weights for {} morph targets", mesh.weights.size(), n_targets);
  mesh.weights.resize(n_targets, 0.0f);
}

}  // namespace

void load_meshes(Loading& loading) {
  const Field meshes = loading.root["meshes"];
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Field field = meshes.at(i), primitives = field["primitives"];
    Mesh mesh;
    mesh.name = field["name"].text();
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      Primitive primitive;
      const bool drawn = load_primitive(loading, primitives.at(k), primitive);
      if (loading.report.failed()) return;
      if (drawn) mesh.primitives.push_back(std::move(primitive));
      const std::size_t n_targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
      if (drawn && mesh.primitives.back().targets.size() != n_targets) {
        primitives.at(k).refuse(
            fmt::format("{} morph targets", mesh.primitives.back().targets.size()),
            fmt::format("{}, as in the mesh's first primitive", n_targets));
        return;
      }
    }
    load_default_weights(field, mesh);
    if (loading.report.failed()) return;
    loading.model.meshes.push_back(std::move(mesh));
  }
}

}  // namespace neritic::scene::gltf
