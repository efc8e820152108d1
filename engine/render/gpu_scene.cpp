#include "engine/render/gpu_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <map>
#include <tuple>

#include "engine/gpu/frames.hpp"
#include "shared/octahedral.h"

namespace neritic::render {
namespace {

using shared::MaterialData;

const std::vector<gpu::BindingDesc>& material_bindings() {
  static const std::vector<gpu::BindingDesc> bindings{
      {shared::kMaterialConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
      {shared::kMaterialBaseColor, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialMetalRough, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialNormal, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialOcclusion, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialEmissive, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
  return bindings;
}

std::uint32_t pack_normal(const Vec3f& n) {
  const float size = glm::length(n);
  const Vec3f unit = size > 1e-20f && std::isfinite(size) ? n / size : Vec3f(0.0f, 1.0f, 0.0f);
  return glm::packSnorm2x16(shared::octahedral_encode(unit));
}

// Octahedral x in the low 16 bits, sign of the bitangent in bit 16, y in the upper 15
// (gbuffer.vert).
std::uint32_t pack_tangent(const Vec4f& t) {
  const float size = glm::length(Vec3f(t));
  if (!(size > 1e-20f) || !std::isfinite(size)) return 0x80008000u | 0x10000u;
  const Vec2f e = shared::octahedral_encode(Vec3f(t) / size) * 0.5f + 0.5f;
  const auto x = static_cast<std::uint32_t>(std::lround(glm::clamp(e.x, 0.0f, 1.0f) * 65535.0f));
  const auto y = static_cast<std::uint32_t>(std::lround(glm::clamp(e.y, 0.0f, 1.0f) * 32767.0f));
  return x | (t.w > 0.0f ? 0x10000u : 0u) | y << 17;
}

shared::TextureMapping mapping_of(const scene::TextureRef& ref) {
  return {ref.transform_u, ref.transform_v, static_cast<std::uint32_t>(ref.uv_set)};
}

VkSamplerAddressMode address_mode(scene::Wrap wrap) {
  switch (wrap) {
    case scene::Wrap::kMirroredRepeat:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case scene::Wrap::kClampToEdge:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

}  // namespace

Result<gpu::SetLayout> create_material_layout(const gpu::Device& device) {
  return gpu::SetLayout::create(device, "material", material_bindings(),
                                VK_SHADER_STAGE_FRAGMENT_BIT);
}

// Gathers the CPU side of a GpuScene, then uploads it in one go.
class GpuSceneBuilder {
 public:
  GpuSceneBuilder(gpu::Device& device, const scene::Scene& scene, VkDescriptorSetLayout layout)
      : device_(device), scene_(scene), layout_(layout), out_(new GpuScene) {}

  Result<std::unique_ptr<GpuScene>> build() {
    NERITIC_TRY_STATUS(add_default_texture());
    for (std::size_t m = 0; m < scene_.models.size(); ++m) NERITIC_TRY_STATUS(add_model(m));
    add_appearances();
    NERITIC_TRY_STATUS(upload_streams());
    NERITIC_TRY_STATUS(write_materials());
    return std::move(out_);
  }

 private:
  struct TextureUse {
    std::uint32_t image = 0, sampler = 0;
  };
  struct MaterialTextures {
    TextureUse base_color, metal_rough, normal, occlusion, emissive;
  };

  Status add_default_texture() {
    ImageU8 white(1, 1, 4, 255);
    NERITIC_TRY_STATUS(add_image("default white", white, false));
    NERITIC_TRY(auto sampler, gpu::Sampler::create(device_, {.name = "default"}));
    out_->samplers_.push_back(std::move(sampler));
    return {};
  }

  Status add_image(const std::string& name, const ImageU8& pixels, bool srgb) {
    gpu::ImageDesc desc;
    desc.name = name;
    desc.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    desc.width = pixels.width;
    desc.height = pixels.height;
    const std::uint32_t limit = device_.limits().maxImageDimension2D;
    if (pixels.width > limit || pixels.height > limit)
      return failure(ErrorCode::kUnsupported, "{}: texture of {}x{}, the device takes at most {}",
                     name, pixels.width, pixels.height, limit);
    for (std::uint32_t n = std::max(pixels.width, pixels.height); n > 1; n /= 2) ++desc.mips;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    NERITIC_TRY(auto image, gpu::Image::create(device_, desc));
    NERITIC_TRY_STATUS(gpu::upload_image(device_, image, std::as_bytes(std::span(pixels.data))));
    out_->images_.push_back(std::move(image));
    return {};
  }

  Result<TextureUse> texture_use(std::size_t model_index, const scene::TextureRef& ref, bool srgb) {
    if (!ref.present()) return TextureUse{};
    const scene::Model& model = *scene_.models[model_index];
    const scene::Texture& texture = model.textures[static_cast<std::size_t>(ref.texture)];
    if (texture.image < 0) return TextureUse{};
    TextureUse use;
    const auto image_key = std::make_tuple(model_index, texture.image, srgb);
    if (const auto found = images_.find(image_key); found != images_.end()) {
      use.image = found->second;
    } else {
      use.image = static_cast<std::uint32_t>(out_->images_.size());
      NERITIC_TRY_STATUS(add_image(fmt::format("{} image {}", model.name, texture.image),
                                   model.images[static_cast<std::size_t>(texture.image)], srgb));
      images_[image_key] = use.image;
    }
    NERITIC_TRY(use.sampler, sampler_for(texture.sampler));
    return use;
  }

  Result<std::uint32_t> sampler_for(const scene::Sampler& s) {
    const auto key =
        std::make_tuple(s.wrap_u, s.wrap_v, s.mag_linear, s.min_linear, s.mip_linear, s.mipmapped);
    if (const auto found = samplers_.find(key); found != samplers_.end()) return found->second;
    gpu::SamplerDesc desc;
    desc.name = "material sampler";
    desc.mag = s.mag_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    desc.min = s.min_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    desc.mip = s.mip_linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    desc.u = address_mode(s.wrap_u);
    desc.v = address_mode(s.wrap_v);
    desc.mipmapped = s.mipmapped;
    NERITIC_TRY(auto sampler, gpu::Sampler::create(device_, desc));
    const auto index = static_cast<std::uint32_t>(out_->samplers_.size());
    out_->samplers_.push_back(std::move(sampler));
    samplers_[key] = index;
    return index;
  }

  Status add_material(std::size_t model_index, const scene::Material& m, bool vertex_colors) {
    MaterialData data{};
    data.base_color = m.base_color;
    data.emissive = m.emissive;
    data.metallic = m.metallic;
    data.roughness = m.roughness;
    data.normal_scale = m.normal_scale;
    data.occlusion_strength = m.occlusion_strength;
    data.alpha_cutoff = m.alpha_cutoff;
    data.base_color_map = mapping_of(m.base_color_texture);
    data.metal_rough_map = mapping_of(m.metallic_roughness_texture);
    data.normal_map = mapping_of(m.normal_texture);
    data.occlusion_map = mapping_of(m.occlusion_texture);
    data.emissive_map = mapping_of(m.emissive_texture);
    const auto flag = [&](bool on, std::uint32_t bit) { data.flags |= on ? bit : 0u; };
    flag(m.base_color_texture.present(), shared::kMaterialBaseColorTexture);
    flag(m.metallic_roughness_texture.present(), shared::kMaterialMetalRoughTexture);
    flag(m.normal_texture.present(), shared::kMaterialNormalTexture);
    flag(m.occlusion_texture.present(), shared::kMaterialOcclusionTexture);
    flag(m.emissive_texture.present(), shared::kMaterialEmissiveTexture);
    flag(m.unlit, shared::kMaterialUnlit);
    flag(vertex_colors, shared::kMaterialVertexColor);
    flag(m.alpha_mode == scene::AlphaMode::kMask, shared::kMaterialMask);

    MaterialTextures textures;
    NERITIC_TRY(textures.base_color, texture_use(model_index, m.base_color_texture, true));
    NERITIC_TRY(textures.metal_rough,
                texture_use(model_index, m.metallic_roughness_texture, false));
    NERITIC_TRY(textures.normal, texture_use(model_index, m.normal_texture, false));
    NERITIC_TRY(textures.occlusion, texture_use(model_index, m.occlusion_texture, false));
    NERITIC_TRY(textures.emissive, texture_use(model_index, m.emissive_texture, true));

    GpuMaterial material;
    material.flags = data.flags;
    material.double_sided = m.double_sided;
    material.mask = m.alpha_mode == scene::AlphaMode::kMask;
    material.blend = m.alpha_mode == scene::AlphaMode::kBlend;
    out_->has_emission_ |= m.unlit || m.emissive != Vec3f(0.0f);
    out_->has_blended_ |= material.blend;
    out_->has_masked_ |= material.mask;
    out_->materials_.push_back(material);
    material_data_.push_back(data);
    material_textures_.push_back(textures);
    return {};
  }

  // The GPU material of a primitive: with vertex colours it is another one than without.
  Result<std::uint32_t> material_of(std::size_t model_index, int material, bool vertex_colors) {
    const auto key = std::make_tuple(model_index, material, vertex_colors);
    if (const auto found = material_index_.find(key); found != material_index_.end())
      return found->second;
    const auto index = static_cast<std::uint32_t>(out_->materials_.size());
    const scene::Material fallback;
    const scene::Model& model = *scene_.models[model_index];
    NERITIC_TRY_STATUS(add_material(
        model_index, material >= 0 ? model.materials[static_cast<std::size_t>(material)] : fallback,
        vertex_colors));
    material_index_[key] = index;
    return index;
  }

  Status add_model(std::size_t model_index) {
    const scene::Model& model = *scene_.models[model_index];
    first_group_.emplace_back();
    for (const scene::Mesh& mesh : model.meshes) {
      first_group_.back().push_back(out_->groups_.size());
      for (const scene::Primitive& primitive : mesh.primitives)
        NERITIC_TRY_STATUS(add_primitive(model_index, primitive));
    }
    return {};
  }

  Status add_primitive(std::size_t model_index, const scene::Primitive& p) {
    DrawGroup group;
    GpuPrimitive& g = group.primitive;
    g.topology = p.topology;
    g.first_index = static_cast<std::uint32_t>(index_data_.size());
    g.index_count = static_cast<std::uint32_t>(p.indices.size());
    g.first_vertex = static_cast<std::uint32_t>(position_data_.size());
    g.vertex_count = static_cast<std::uint32_t>(p.positions.size());
    NERITIC_TRY(g.material, material_of(model_index, p.material, !p.colors.empty()));
    index_data_.insert(index_data_.end(), p.indices.begin(), p.indices.end());
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
      position_data_.push_back({p.positions[i], pack_normal(p.normals[i])});
      shared::VertexSurface s{};
      if (!p.uv0.empty()) s.uv0 = p.uv0[i];
      if (!p.uv1.empty()) s.uv1 = p.uv1[i];
      s.tangent = pack_tangent(p.tangents.empty() ? Vec4f(0.0f) : p.tangents[i]);
      s.color = p.colors.empty() ? ~0u : glm::packUnorm4x8(p.colors[i]);
      surface_data_.push_back(s);
    }
    if (!p.joints.empty()) {
      g.first_skin = static_cast<std::uint32_t>(skin_data_.size());
      for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const auto& j = p.joints[i];
        skin_data_.push_back(
            {j[0] | std::uint32_t{j[1]} << 16, j[2] | std::uint32_t{j[3]} << 16, p.weights[i]});
      }
    }
    g.first_morph = static_cast<std::uint32_t>(morph_data_.size());
    g.morph_targets = static_cast<std::uint32_t>(p.targets.size());
    for (const scene::MorphTarget& target : p.targets)
      for (std::size_t i = 0; i < p.positions.size(); ++i)
        morph_data_.push_back({target.positions.empty() ? Vec3f(0.0f) : target.positions[i],
                               target.normals.empty() ? Vec3f(0.0f) : target.normals[i]});
    if (!p.bounds.empty()) {
      g.center_m = (p.bounds.min + p.bounds.max) * 0.5;
      g.radius_m = glm::length(p.bounds.max - p.bounds.min) * 0.5;
    }
    out_->groups_.push_back(std::move(group));
    return {};
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
          out_->groups_[g].appearances.push_back(a);
          if (out_->groups_[g].primitive.topology == scene::Topology::kTriangles)
            out_->triangles_ += out_->groups_[g].primitive.index_count / 3;
        }
      }
  }

  template <class T>
  Result<gpu::Buffer> filled(const char* name, const std::vector<T>& data,
                             VkBufferUsageFlags usage) {
    NERITIC_TRY(auto buffer,
                gpu::Buffer::create(device_, {name, data.size() * sizeof(T),
                                              usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
    if (!data.empty())
      NERITIC_TRY_STATUS(gpu::upload_buffer(device_, buffer, std::as_bytes(std::span(data))));
    return buffer;
  }

  Status upload_streams() {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    NERITIC_TRY(out_->positions_,
                filled("positions", position_data_, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | kStorage));
    NERITIC_TRY(out_->surfaces_,
                filled("surfaces", surface_data_, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
    NERITIC_TRY(out_->indices_, filled("indices", index_data_, VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    NERITIC_TRY(out_->skin_, filled("skin", skin_data_, kStorage));
    NERITIC_TRY(out_->morphs_, filled("morphs", morph_data_, kStorage));
    return {};
  }

  Status write_materials() {
    // Each material's constants at an offset that any device accepts (at most 256).
    constexpr std::size_t kStride = (sizeof(MaterialData) + 255) / 256 * 256;
    std::vector<std::byte> bytes(kStride * material_data_.size());
    for (std::size_t i = 0; i < material_data_.size(); ++i)
      std::memcpy(bytes.data() + i * kStride, &material_data_[i], sizeof(MaterialData));
    NERITIC_TRY(out_->material_constants_,
                filled("material constants", bytes, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT));
    out_->descriptors_ = std::make_unique<gpu::DescriptorArena>(device_);
    for (std::size_t i = 0; i < material_data_.size(); ++i) {
      NERITIC_TRY(const VkDescriptorSet set, out_->descriptors_->allocate(layout_));
      const MaterialTextures& t = material_textures_[i];
      const auto texture = [&](std::uint32_t binding, const TextureUse& use) {
        return gpu::bound_texture(binding, out_->images_[use.image].view(),
                                  out_->samplers_[use.sampler].handle());
      };
      const gpu::BoundResource resources[] = {
          gpu::bound_buffer(shared::kMaterialConstants, out_->material_constants_.handle(),
                            i * kStride, sizeof(MaterialData)),
          texture(shared::kMaterialBaseColor, t.base_color),
          texture(shared::kMaterialMetalRough, t.metal_rough),
          texture(shared::kMaterialNormal, t.normal),
          texture(shared::kMaterialOcclusion, t.occlusion),
          texture(shared::kMaterialEmissive, t.emissive)};
      gpu::write_descriptors(device_, set, material_bindings(), resources);
      out_->materials_[i].set = set;
    }
    return {};
  }

  gpu::Device& device_;
  const scene::Scene& scene_;
  VkDescriptorSetLayout layout_;
  std::unique_ptr<GpuScene> out_;
  std::vector<shared::VertexPosition> position_data_;
  std::vector<shared::VertexSurface> surface_data_;
  std::vector<std::uint32_t> index_data_;
  std::vector<shared::SkinVertex> skin_data_;
  std::vector<shared::MorphDelta> morph_data_;
  std::vector<MaterialData> material_data_;
  std::vector<MaterialTextures> material_textures_;
  std::map<std::tuple<std::size_t, int, bool>, std::uint32_t> images_, material_index_;
  std::map<std::tuple<scene::Wrap, scene::Wrap, bool, bool, bool, bool>, std::uint32_t> samplers_;
  std::vector<std::vector<std::size_t>> first_group_;  // a model, a mesh
};

Result<std::unique_ptr<GpuScene>> GpuScene::create(gpu::Device& device, const scene::Scene& scene,
                                                   VkDescriptorSetLayout material_layout) {
  return GpuSceneBuilder(device, scene, material_layout).build();
}

}  // namespace neritic::render
