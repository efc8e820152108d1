// The stages of loading one glTF file, in the order in which load_gltf runs them. Each reads its
// part of the JSON into the model; the first failure lands in the report. One thread, apart from
// the pictures, which other threads decode meanwhile.
#pragma once

#include <memory>
#include <vector>

#include "engine/scene/gltf_accessor.hpp"
#include "engine/scene/gltf_images.hpp"
#include "engine/scene/gltf_json.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene::gltf {

// Pictures of extensions that finish_images works into a material's own.
struct MixedPictures {
  // KHR_materials_pbrSpecularGlossiness.
  bool specular_glossiness = false;
  Vec3f specular{1.0f};
  float glossiness = 1.0f;
  TextureRef specular_texture;
  // KHR_materials_transmission.
  float transmission = 0.0f;
  TextureRef transmission_texture;
};

// Shared by the stages.
struct Loading {
  Field root;
  Report& report;
  Resources& resources;
  ImageDecoder& images;
  Model& model;
  std::vector<MixedPictures> mixed = {};  // one a material
};

// asset.version, minVersion and extensions: refuses what is not supported by name, notes what is
// ignored.
void check_asset(Loading& loading);
// Textures and samplers, then materials; hands the pictures that materials use to the decoder.
void load_materials(Loading& loading);
// Waits for the pictures; textures whose picture is missing or broken leave their materials. Then
// works the mixed pictures in.
void finish_images(Loading& loading);
void load_meshes(Loading& loading);
void load_lights(Loading& loading);
// Nodes with their hierarchy (no loops, one parent each), skins, and the default scene's roots.
void load_nodes(Loading& loading);
void load_skins(Loading& loading);
void load_roots(Loading& loading);
void load_clips(Loading& loading);

}  // namespace neritic::scene::gltf
