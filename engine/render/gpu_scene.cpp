#include "engine/render/gpu_scene.hpp"

#include <algorithm>
#include <span>

#include "engine/core/parallel.hpp"
#include "engine/render/closed_surface.hpp"
#include "engine/render/gpu_scene_geometry.hpp"
#include "engine/render/gpu_scene_materials.hpp"

namespace neritic::render {

struct GpuScene::Parts {
  GpuSceneMaterials materials;
  GpuSceneGeometry geometry;
};

GpuScene::GpuScene() : parts_(std::make_unique<Parts>()) {}
GpuScene::~GpuScene() = default;

const gpu::Buffer& GpuScene::positions() const {
  return parts_->geometry.positions;
}
const gpu::Buffer& GpuScene::surfaces() const {
  return parts_->geometry.surfaces;
}
const gpu::Buffer& GpuScene::indices() const {
  return parts_->geometry.indices;
}
const gpu::Buffer& GpuScene::skin() const {
  return parts_->geometry.skin;
}
const gpu::Buffer& GpuScene::morphs() const {
  return parts_->geometry.morphs;
}
const std::vector<GpuMaterial>& GpuScene::materials() const {
  return parts_->materials.materials;
}
bool GpuScene::has_thin() const {
  return parts_->materials.has_thin;
}

bool GpuScene::has_emission() const {
  return parts_->materials.has_emission;
}

// Makes the groups of every model's primitives, then fills in the instances that show them.
class GpuSceneBuilder {
 public:
  GpuSceneBuilder(const scene::Scene& scene, GpuScene& out) : scene_(scene), out_(out) {}

  Status add_models(MaterialBuilder& materials, GeometryBuilder& geometry) {
    auto prepared = prepared_meshes();
    std::size_t next = 0;
    for (std::size_t m = 0; m < scene_.models.size(); ++m) {
      first_group_.emplace_back();
      for (const scene::Mesh& mesh : scene_.models[m]->meshes) {
        first_group_.back().push_back(out_.groups_.size());
        for (const scene::Primitive& p : mesh.primitives) {
          NERITIC_TRY(const std::uint32_t material,
                      materials.material_of(m, p.material, !p.colors.empty()));
          out_.groups_.push_back({geometry.add(p, material, std::move(prepared[next++])), {}});
          GpuPrimitive& added = out_.groups_.back().primitive;
          added.closed = may_be_closed(scene_.models[m]->materials, p.material, added) &&
                         is_closed(p.positions, p.indices);
        }
      }
    }
    return {};
  }

  // False where the answer is not needed: without sonars, and for surfaces with two sides.
  bool may_be_closed(std::span<const scene::Material> materials, int material,
                     const GpuPrimitive& primitive) const {
    if (scene_.sonars.empty() || primitive.deforms()) return false;
    if (primitive.topology != scene::Topology::kTriangles) return false;
    if (material < 0) return true;
    const scene::Material& m = materials[static_cast<std::size_t>(material)];
    return !m.double_sided && m.alpha_mode != scene::AlphaMode::kMask;
  }

  void add_appearances() {
    for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
      const scene::Object& object = scene_.objects[o];
      if (object.model < 0) continue;
      const scene::Model& model = *scene_.models[static_cast<std::size_t>(object.model)];
      std::vector<int> open(model.roots.rbegin(), model.roots.rend());
      while (!open.empty()) {
        const int n = open.back();
        open.pop_back();
        const scene::Node& node = model.nodes[static_cast<std::size_t>(n)];
        open.insert(open.end(), node.children.rbegin(), node.children.rend());
        if (node.mesh >= 0) add_node(o, object, model, n);
      }
    }
  }

 private:
  // Every model's primitives, in their order. On all cores: a start waits.
  std::vector<PreparedMesh> prepared_meshes() const {
    std::vector<const scene::Primitive*> all;
    for (const auto& model : scene_.models)
      for (const scene::Mesh& mesh : model->meshes)
        for (const scene::Primitive& p : mesh.primitives) all.push_back(&p);
    std::vector<PreparedMesh> out(all.size());
    each_on_cores(all.size(), [&](std::size_t i) { out[i] = prepare_mesh(*all[i]); });
    return out;
  }

  void add_node(std::size_t object_index, const scene::Object& object, const scene::Model& model,
                int n) {
    const scene::Node& node = model.nodes[static_cast<std::size_t>(n)];
    const std::size_t first =
        first_group_[static_cast<std::size_t>(object.model)][static_cast<std::size_t>(node.mesh)];
    const std::size_t count = model.meshes[static_cast<std::size_t>(node.mesh)].primitives.size();
    const int copies = static_cast<int>(object.copies.size());
    const int instances = static_cast<int>(node.instances.size());
    for (int c = copies ? 0 : -1; c < copies; ++c)
      for (int i = instances ? 0 : -1; i < instances; ++i) {
        Appearance a{static_cast<std::uint32_t>(object_index), static_cast<std::uint32_t>(n), c, i,
                     static_cast<std::uint16_t>(object.instance + std::max(c, 0))};
        for (std::size_t g = first; g < first + count; ++g) {
          out_.groups_[g].appearances.push_back(a);
          if (out_.groups_[g].primitive.topology == scene::Topology::kTriangles)
            out_.triangles_ += out_.groups_[g].primitive.index_count / 3;
        }
      }
  }

  const scene::Scene& scene_;
  GpuScene& out_;
  std::vector<std::vector<std::size_t>> first_group_;  // a model, a mesh
};

Result<std::unique_ptr<GpuScene>> GpuScene::create(gpu::Device& device, const scene::Scene& scene,
                                                   VkDescriptorSetLayout material_layout) {
  std::unique_ptr<GpuScene> out(new GpuScene);
  NERITIC_TRY(MaterialBuilder materials, MaterialBuilder::create(device, scene));
  GeometryBuilder geometry;
  GpuSceneBuilder builder(scene, *out);
  NERITIC_TRY_STATUS(builder.add_models(materials, geometry));
  builder.add_appearances();
  NERITIC_TRY(out->parts_->geometry, geometry.finish(device));
  NERITIC_TRY(out->parts_->materials, materials.finish(material_layout));
  return out;
}

}  // namespace neritic::render
