#include "engine/render/gpu_scene_materials.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/core/log.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/render/halved.hpp"

namespace neritic::render {
namespace {

using shared::MaterialData;
// The places that shaders/shared/material.glsl counts on.
static_assert(sizeof(MaterialData) == 4 * 56 && offsetof(MaterialData, emissive) == 4 * 4 &&
              offsetof(MaterialData, metallic) == 4 * 7 &&
              offsetof(MaterialData, roughness) == 4 * 8 &&
              offsetof(MaterialData, reflectance) == 4 * 9 &&
              offsetof(MaterialData, normal_scale) == 4 * 10 &&
              offsetof(MaterialData, occlusion_strength) == 4 * 11 &&
              offsetof(MaterialData, alpha_cutoff) == 4 * 12 &&
              offsetof(MaterialData, base_color_map) == 4 * 13 &&
              offsetof(MaterialData, metal_rough_map) == 4 * 20 &&
              offsetof(MaterialData, normal_map) == 4 * 27 &&
              offsetof(MaterialData, occlusion_map) == 4 * 34 &&
              offsetof(MaterialData, emissive_map) == 4 * 41 &&
              offsetof(MaterialData, diffuse_transmission) == 4 * 48 &&
              offsetof(MaterialData, detail_map) == 4 * 49);

const std::vector<gpu::BindingDesc>& material_bindings() {
  static const std::vector<gpu::BindingDesc> bindings{
      {shared::kMaterialConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
      {shared::kMaterialBaseColor, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialMetalRough, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialNormal, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialOcclusion, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialEmissive, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
      {shared::kMaterialDetail, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
  return bindings;
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

std::uint32_t flags_of(const scene::Material& m, bool vertex_colors) {
  std::uint32_t flags = 0;
  const auto flag = [&](bool on, std::uint32_t bit) { flags |= on ? bit : 0u; };
  flag(m.base_color_texture.present(), shared::kMaterialBaseColorTexture);
  flag(m.metallic_roughness_texture.present(), shared::kMaterialMetalRoughTexture);
  flag(m.normal_texture.present(), shared::kMaterialNormalTexture);
  flag(m.occlusion_texture.present(), shared::kMaterialOcclusionTexture);
  flag(m.emissive_texture.present(), shared::kMaterialEmissiveTexture);
  flag(m.detail_texture.present(), shared::kMaterialDetailTexture);
  flag(m.unlit, shared::kMaterialUnlit);
  flag(vertex_colors, shared::kMaterialVertexColor);
  for (const scene::TextureRef* ref :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
        &m.occlusion_texture, &m.emissive_texture, &m.detail_texture})
    flag(ref->present() && ref->uv_set != 0, shared::kMaterialSecondUv);
  flag(m.alpha_mode == scene::AlphaMode::kMask, shared::kMaterialMask);
  flag(m.transmissive, shared::kMaterialTransmissive);
  flag(m.diffuse_transmission > 0.0f, shared::kMaterialThin);
  return flags;
}

// The image itself where no side is over limit, else halved into smaller until that is so.
const ImageU8& fitting(const ImageU8& image, std::uint32_t limit, bool srgb, ImageU8& smaller) {
  if (image.width <= limit && image.height <= limit) return image;
  smaller = halved(image, srgb);
  while (smaller.width > limit || smaller.height > limit) smaller = halved(smaller, srgb);
  return smaller;
}

}  // namespace

Result<gpu::SetLayout> create_material_layout(const gpu::Device& device) {
  return gpu::SetLayout::create(device, "material", material_bindings(),
                                VK_SHADER_STAGE_FRAGMENT_BIT);
}

Result<MaterialBuilder> MaterialBuilder::create(gpu::Device& device, const scene::Scene& scene) {
  MaterialBuilder builder(device, scene);
  NERITIC_TRY_STATUS(builder.add_default_texture());
  return builder;
}

Status MaterialBuilder::add_default_texture() {
  ImageU8 white(1, 1, 4, 255);
  NERITIC_TRY_STATUS(add_image("default white", white, false));
  NERITIC_TRY(auto sampler, gpu::Sampler::create(*device_, {.name = "default"}));
  out_.samplers.push_back(std::move(sampler));
  return {};
}

Status MaterialBuilder::add_image(const std::string& name, const ImageU8& whole, bool srgb) {
  const std::uint32_t limit = device_->limits().maxImageDimension2D;
  ImageU8 smaller;
  const ImageU8& pixels = fitting(whole, limit, srgb, smaller);
  if (pixels.width != whole.width || pixels.height != whole.height)
    log_warn("{}: {}x{} is halved to {}x{}, the device takes at most {} pixels a side", name,
             whole.width, whole.height, pixels.width, pixels.height, limit);
  gpu::ImageDesc desc;
  desc.name = name;
  desc.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = pixels.width;
  desc.height = pixels.height;
  for (std::uint32_t n = std::max(pixels.width, pixels.height); n > 1; n /= 2) ++desc.mips;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
               VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  NERITIC_TRY(auto image, gpu::Image::create(*device_, desc));
  NERITIC_TRY_STATUS(gpu::upload_image(*device_, image, std::as_bytes(std::span(pixels.data))));
  out_.images.push_back(std::move(image));
  return {};
}

Result<MaterialBuilder::TextureUse> MaterialBuilder::texture_use(std::size_t model_index,
                                                                 const scene::TextureRef& ref,
                                                                 bool srgb) {
  if (!ref.present()) return TextureUse{};
  const scene::Model& model = *scene_->models[model_index];
  const scene::Texture& texture = model.textures[static_cast<std::size_t>(ref.texture)];
  if (texture.image < 0) return TextureUse{};
  TextureUse use;
  const auto image_key = std::make_tuple(model_index, texture.image, srgb);
  if (const auto found = images_.find(image_key); found != images_.end()) {
    use.image = found->second;
  } else {
    use.image = static_cast<std::uint32_t>(out_.images.size());
    NERITIC_TRY_STATUS(add_image(fmt::format("{} image {}", model.name, texture.image),
                                 model.images[static_cast<std::size_t>(texture.image)], srgb));
    images_[image_key] = use.image;
  }
  NERITIC_TRY(use.sampler, sampler_for(texture.sampler));
  return use;
}

Result<std::uint32_t> MaterialBuilder::sampler_for(const scene::Sampler& s) {
  const auto key =
      std::make_tuple(s.wrap_u, s.wrap_v, s.mag_linear, s.min_linear, s.mip_linear, s.mipmapped);
  if (const auto found = sampler_index_.find(key); found != sampler_index_.end())
    return found->second;
  gpu::SamplerDesc desc;
  desc.name = "material sampler";
  desc.mag = s.mag_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  desc.min = s.min_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  desc.mip = s.mip_linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  desc.u = address_mode(s.wrap_u);
  desc.v = address_mode(s.wrap_v);
  desc.mipmapped = s.mipmapped;
  NERITIC_TRY(auto sampler, gpu::Sampler::create(*device_, desc));
  const auto index = static_cast<std::uint32_t>(out_.samplers.size());
  out_.samplers.push_back(std::move(sampler));
  sampler_index_[key] = index;
  return index;
}

Status MaterialBuilder::add_material(std::size_t model_index, const scene::Material& m,
                                     bool vertex_colors) {
  MaterialData data{};
  data.base_color = m.base_color;
  data.emissive = m.emissive;
  data.metallic = m.metallic;
  data.roughness = m.roughness;
  data.reflectance = std::min(m.reflectance, shared::kMaxReflectance);
  data.normal_scale = m.normal_scale;
  data.occlusion_strength = m.occlusion_strength;
  data.alpha_cutoff = m.alpha_cutoff;
  data.diffuse_transmission = m.diffuse_transmission;
  data.base_color_map = mapping_of(m.base_color_texture);
  data.metal_rough_map = mapping_of(m.metallic_roughness_texture);
  data.normal_map = mapping_of(m.normal_texture);
  data.occlusion_map = mapping_of(m.occlusion_texture);
  data.emissive_map = mapping_of(m.emissive_texture);
  data.detail_map = mapping_of(m.detail_texture);

  MaterialTextures textures;
  NERITIC_TRY(textures.base_color, texture_use(model_index, m.base_color_texture, true));
  NERITIC_TRY(textures.metal_rough, texture_use(model_index, m.metallic_roughness_texture, false));
  NERITIC_TRY(textures.normal, texture_use(model_index, m.normal_texture, false));
  NERITIC_TRY(textures.occlusion, texture_use(model_index, m.occlusion_texture, false));
  NERITIC_TRY(textures.emissive, texture_use(model_index, m.emissive_texture, true));
  NERITIC_TRY(textures.detail, texture_use(model_index, m.detail_texture, false));

  GpuMaterial material;
  material.flags = flags_of(m, vertex_colors);
  material.double_sided = m.double_sided;
  material.mask = m.alpha_mode == scene::AlphaMode::kMask;
  material.blend = m.alpha_mode == scene::AlphaMode::kBlend || m.transmissive;
  material.emissive = m.unlit || m.emissive != Vec3f(0.0f);
  out_.has_emission |= material.emissive;
  out_.has_thin |= m.diffuse_transmission > 0.0f;
  out_.materials.push_back(material);
  data_.push_back(data);
  textures_.push_back(textures);
  return {};
}

Result<std::uint32_t> MaterialBuilder::material_of(std::size_t model_index, int material,
                                                   bool vertex_colors) {
  const auto key = std::make_tuple(model_index, material, vertex_colors);
  if (const auto found = material_index_.find(key); found != material_index_.end())
    return found->second;
  const auto index = static_cast<std::uint32_t>(out_.materials.size());
  const scene::Material fallback;
  const scene::Model& model = *scene_->models[model_index];
  NERITIC_TRY_STATUS(add_material(
      model_index, material >= 0 ? model.materials[static_cast<std::size_t>(material)] : fallback,
      vertex_colors));
  material_index_[key] = index;
  return index;
}

Result<std::uint32_t> MaterialBuilder::add_picture(std::size_t place_index,
                                                   const scene::PicturePlace& place) {
  for (std::uint32_t i = 0; i < out_.pictures.size(); ++i)
    if (out_.pictures[i].place == place_index) return i;
  picture_images_.push_back(static_cast<std::uint32_t>(out_.images.size()));
  ImageU8 black(place.width, place.height, 4, 0);
  for (std::size_t alpha = 3; alpha < black.data.size(); alpha += 4) black.data[alpha] = 255;
  NERITIC_TRY_STATUS(
      add_image(fmt::format("picture of {} {}", scene_->objects[place.object].name, place.name),
                black, true));
  out_.pictures.push_back({.place = static_cast<std::uint32_t>(place_index)});
  return static_cast<std::uint32_t>(out_.pictures.size() - 1);
}

Result<std::uint32_t> MaterialBuilder::with_picture(std::size_t model_index, int material,
                                                    bool vertex_colors, std::size_t place_index,
                                                    const scene::PicturePlace& place) {
  scene::Material glowing =
      scene_->models[model_index]->materials[static_cast<std::size_t>(material)];
  glowing.emissive = Vec3f(1.0f);
  glowing.emissive_texture = {};
  NERITIC_TRY(const std::uint32_t picture, add_picture(place_index, place));
  NERITIC_TRY(const std::uint32_t sampler,
              sampler_for({scene::Wrap::kClampToEdge, scene::Wrap::kClampToEdge}));
  NERITIC_TRY_STATUS(add_material(model_index, glowing, vertex_colors));
  textures_.back().emissive = {picture_images_[picture], sampler};
  GpuMaterial& added = out_.materials.back();
  added.flags |= shared::kMaterialEmissiveTexture;
  added.picture = picture;
  return static_cast<std::uint32_t>(out_.materials.size() - 1);
}

Result<GpuSceneMaterials> MaterialBuilder::finish(VkDescriptorSetLayout layout) {
  // Each material's constants at an offset that any device accepts (at most 256).
  constexpr std::size_t kStride = (sizeof(MaterialData) + 255) / 256 * 256;
  std::vector<std::byte> bytes(kStride * data_.size());
  for (std::size_t i = 0; i < data_.size(); ++i)
    std::memcpy(bytes.data() + i * kStride, &data_[i], sizeof(MaterialData));
  NERITIC_TRY(out_.constants,
              gpu::Buffer::create(*device_, {"material constants", bytes.size(),
                                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  if (!bytes.empty()) NERITIC_TRY_STATUS(gpu::upload_buffer(*device_, out_.constants, bytes));
  out_.descriptors = std::make_unique<gpu::DescriptorArena>(*device_, "materials");
  for (std::size_t i = 0; i < data_.size(); ++i) {
    NERITIC_TRY(const VkDescriptorSet set,
                out_.descriptors->allocate(layout, fmt::format("material {}", i)));
    const MaterialTextures& t = textures_[i];
    const auto texture = [&](std::uint32_t binding, const TextureUse& use) {
      return gpu::bound_texture(binding, out_.images[use.image].view(),
                                out_.samplers[use.sampler].handle());
    };
    const gpu::BoundResource resources[] = {
        gpu::bound_buffer(shared::kMaterialConstants, out_.constants.handle(), i * kStride,
                          sizeof(MaterialData)),
        texture(shared::kMaterialBaseColor, t.base_color),
        texture(shared::kMaterialMetalRough, t.metal_rough),
        texture(shared::kMaterialNormal, t.normal),
        texture(shared::kMaterialOcclusion, t.occlusion),
        texture(shared::kMaterialEmissive, t.emissive),
        texture(shared::kMaterialDetail, t.detail)};
    gpu::write_descriptors(*device_, set, material_bindings(), resources);
    out_.materials[i].set = set;
  }
  for (std::size_t i = 0; i < out_.pictures.size(); ++i)
    out_.pictures[i].image = &out_.images[picture_images_[i]];
  return std::move(out_);
}

}  // namespace neritic::render
