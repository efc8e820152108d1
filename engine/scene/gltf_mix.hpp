// Materials of extensions as metallic-roughness ones, pictures and all: specular-glossiness is
// solved for base colour, metalness and roughness; transmission becomes the base colour's alpha.
// Pure but for the model that is loaded.
#pragma once

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {

// Metallic-roughness of a specular-glossiness colour, all linear.
struct SolvedColor {
  Vec3f base{0.0f};
  float metallic = 0.0f;
};
SolvedColor solve_specular(const Vec3f& diffuse, const Vec3f& specular);

void mix_pictures(Loading& loading);

}  // namespace neritic::scene::gltf
