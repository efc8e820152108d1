// The materials of a GpuScene while it is made: textures, samplers, constants and their descriptor
// sets. Private to GpuScene; rendering thread only.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/render/gpu_scene.hpp"

namespace neritic::render {

struct GpuSceneMaterials {
  std::vector<GpuMaterial> materials;
  std::vector<gpu::Image> images;
  std::vector<GpuPicture> pictures;
  std::vector<gpu::Sampler> samplers;
  gpu::Buffer constants;
  std::unique_ptr<gpu::DescriptorArena> descriptors;
  bool has_emission = false;
  bool has_thin = false;  // a material lets diffuse light through
};

class MaterialBuilder {
 public:
  static Result<MaterialBuilder> create(gpu::Device& device, const scene::Scene& scene);

  // The GPU material of a primitive: with vertex colours it is another one than without. Uploads
  // its textures when first asked for. material -1: glTF's default.
  Result<std::uint32_t> material_of(std::size_t model_index, int material, bool vertex_colors);
  // The same glowing with the picture of a place, of which there is one image.
  Result<std::uint32_t> with_picture(std::size_t model_index, int material, bool vertex_colors,
                                     std::size_t place_index, const scene::PicturePlace& place);
  // Uploads the constants and writes the sets; nothing is added after it.
  Result<GpuSceneMaterials> finish(VkDescriptorSetLayout layout);

 private:
  struct TextureUse {
    std::uint32_t image = 0, sampler = 0;
  };
  struct MaterialTextures {
    TextureUse base_color, metal_rough, normal, occlusion, emissive, detail;
  };
  MaterialBuilder(gpu::Device& device, const scene::Scene& scene)
      : device_(&device), scene_(&scene) {}
  Status add_default_texture();
  Status add_image(const std::string& name, const ImageU8& pixels, bool srgb);
  Result<TextureUse> texture_use(std::size_t model_index, const scene::TextureRef& ref, bool srgb);
  Result<std::uint32_t> sampler_for(const scene::Sampler& sampler);
  Status add_material(std::size_t model_index, const scene::Material& material, bool vertex_colors);
  Result<std::uint32_t> add_picture(std::size_t place_index, const scene::PicturePlace& place);

  gpu::Device* device_;
  const scene::Scene* scene_;
  GpuSceneMaterials out_;
  std::vector<shared::MaterialData> data_;
  std::vector<MaterialTextures> textures_;
  std::map<std::tuple<std::size_t, int, bool>, std::uint32_t> images_, material_index_;
  std::vector<std::uint32_t> picture_images_;  // a picture's
  std::map<std::tuple<scene::Wrap, scene::Wrap, bool, bool, bool, bool>, std::uint32_t>
      sampler_index_;
};

}  // namespace neritic::render
