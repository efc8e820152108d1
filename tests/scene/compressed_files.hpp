// glTF files with compressed meshes and pictures, made by the libraries' own encoders.
#pragma once

#include "engine/scene/image_file.hpp"
#include "tests/scene/gltf_builder.hpp"

namespace neritic::test {

// A bump of 10 x 10 vertices over the unit square with normals and texture coordinates. Its normal:
Vec3 bump_normal(const Vec3f& position);
scene::GltfBuilder plain_bump();
scene::GltfBuilder draco_bump(bool edgebreaker);
// filter: of the normals (OCTAHEDRAL) or positions (EXPONENTIAL), or NONE.
scene::GltfBuilder meshopt_bump(const std::string& filter);

// Lossless: 5 x 3 pixels with alpha; else 64 x 64, red 200 and a gradient of green.
std::vector<std::uint8_t> webp_file(bool lossless);
// A quad with that picture through EXT_texture_webp, beside a fall-back of another size.
scene::GltfBuilder webp_quad(bool lossless);

}  // namespace neritic::test
