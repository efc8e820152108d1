#include "engine/render/gpu_scene.hpp"

#include <algorithm>
#include <map>
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
std::span<GpuPicture> GpuScene::pictures() {
  return parts_->materials.pictures;
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
  GpuSceneBuilder(const scene::Scene& scene, std::span<const scene::PicturePlace> places,
                  GpuScene& out)
      : scene_(scene), places_(places), out_(out) {}

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
          from_.push_back({m, &p});
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

  Status add_appearances(MaterialBuilder& materials) {
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
        if (node.mesh >= 0) NERITIC_TRY_STATUS(add_node(materials, o, object, model, n));
      }
    }
    return {};
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

  // The group in which an object's appearances of one of the models' primitives are: that group, or
  // one like it whose material shows the object's own picture.
  Result<std::size_t> group_for(MaterialBuilder& materials, std::size_t group,
                                std::size_t object_index) {
    const auto [m, primitive] = from_[group];
    if (places_.empty() || primitive->material < 0) return group;
    const std::string& name =
        scene_.models[m]->materials[static_cast<std::size_t>(primitive->material)].picture;
    if (name.empty()) return group;
    const auto place = std::ranges::find_if(places_, [&](const scene::PicturePlace& p) {
      return p.object == object_index && p.name == name;
    });
    if (place == places_.end()) return group;
    const auto [own, is_new] = own_groups_.try_emplace({group, object_index}, out_.groups_.size());
    if (!is_new) return own->second;
    DrawGroup added{out_.groups_[group].primitive, {}};
    NERITIC_TRY(added.primitive.material,
                materials.with_picture(m, primitive->material, !primitive->colors.empty(),
                                       static_cast<std::size_t>(place - places_.begin()), *place));
    out_.groups_.push_back(std::move(added));
    return own->second;
  }

  Status add_node(MaterialBuilder& materials, std::size_t object_index, const scene::Object& object,
                  const scene::Model& model, int n) {
    const scene::Node& node = model.nodes[static_cast<std::size_t>(n)];
    const std::size_t first =
        first_group_[static_cast<std::size_t>(object.model)][static_cast<std::size_t>(node.mesh)];
    const std::size_t count = model.meshes[static_cast<std::size_t>(node.mesh)].primitives.size();
    const int copies = static_cast<int>(object.copies.size());
    const int instances = static_cast<int>(node.instances.size());
    std::vector<std::size_t> groups;
    for (std::size_t g = first; g < first + count; ++g) {
      NERITIC_TRY(const std::size_t group, group_for(materials, g, object_index));
      groups.push_back(group);
    }
    for (int c = copies ? 0 : -1; c < copies; ++c)
      for (int i = instances ? 0 : -1; i < instances; ++i) {
        Appearance a{static_cast<std::uint32_t>(object_index), static_cast<std::uint32_t>(n), c, i,
                     static_cast<std::uint16_t>(object.instance + std::max(c, 0))};
        for (const std::size_t g : groups) {
          out_.groups_[g].appearances.push_back(a);
          if (out_.groups_[g].primitive.topology == scene::Topology::kTriangles)
            out_.triangles_ += out_.groups_[g].primitive.index_count / 3;
        }
      }
    return {};
  }

  const scene::Scene& scene_;
  const std::span<const scene::PicturePlace> places_;
  GpuScene& out_;
  std::vector<std::vector<std::size_t>> first_group_;                  // a model, a mesh
  std::vector<std::pair<std::size_t, const scene::Primitive*>> from_;  // a group: model, primitive
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> own_groups_;  // by group and object
};

Result<std::unique_ptr<GpuScene>> GpuScene::create(gpu::Device& device, const scene::Scene& scene,
                                                   VkDescriptorSetLayout material_layout,
                                                   std::span<const scene::PicturePlace> places) {
  std::unique_ptr<GpuScene> out(new GpuScene);
  NERITIC_TRY(MaterialBuilder materials, MaterialBuilder::create(device, scene));
  GeometryBuilder geometry;
  GpuSceneBuilder builder(scene, places, *out);
  NERITIC_TRY_STATUS(builder.add_models(materials, geometry));
  NERITIC_TRY_STATUS(builder.add_appearances(materials));
  NERITIC_TRY(out->parts_->geometry, geometry.finish(device));
  NERITIC_TRY(out->parts_->materials, materials.finish(material_layout));
  return out;
}

}  // namespace neritic::render
