// A material's constants and textures (set 1), glTF 2.0 metallic-roughness. GLSL only.
#ifndef NERITIC_MATERIAL_GLSL
#define NERITIC_MATERIAL_GLSL
#include "shared/even.glsl"

// A uniform block, not a storage buffer: helper invocations at triangle edges must read it too, or the
// derivatives there (so the mip level) are wrong. llvmpipe masks storage loads of helpers.
layout(set = 1, binding = kMaterialConstants, scalar) uniform Material { MaterialData material_data; };
layout(set = 1, binding = kMaterialConstants, scalar) uniform MaterialWords { float material_words[56]; };
layout(set = 1, binding = kMaterialBaseColor) uniform sampler2D base_color_texture;
layout(set = 1, binding = kMaterialMetalRough) uniform sampler2D metal_rough_texture;
layout(set = 1, binding = kMaterialNormal) uniform sampler2D normal_texture;
layout(set = 1, binding = kMaterialOcclusion) uniform sampler2D occlusion_texture;
layout(set = 1, binding = kMaterialEmissive) uniform sampler2D emissive_texture;
layout(set = 1, binding = kMaterialDetail) uniform sampler2D detail_texture;

layout(constant_id = kSpecMaterial) const uint kMaterialFlags = ~0u;
bool material_has(uint flag) { return (kMaterialFlags & flag) != 0u; }

// A number of MaterialData by its place, a constant: each lane reads another one of its row.
float material_word(uint i) { return from_lane(material_words[(i & ~7u) + lane()], i & 7u); }
vec3 material_vec3(uint i) { return vec3(material_word(i), material_word(i + 1u), material_word(i + 2u)); }
TextureMapping material_mapping(uint i) {
  return TextureMapping(material_vec3(i), material_vec3(i + 3u), floatBitsToUint(material_word(i + 6u)));
}

MaterialData material;
// main() begins with this. In the order of MaterialData; what is not used costs nothing.
void take_material() {
  if (!by_lanes()) {
    material = material_data;
    return;
  }
  material.base_color = vec4(material_vec3(0u), material_word(3u));
  material.emissive = material_vec3(4u);
  material.metallic = material_word(7u);
  material.roughness = material_word(8u);
  material.reflectance = material_word(9u);
  material.normal_scale = material_word(10u);
  material.occlusion_strength = material_word(11u);
  material.alpha_cutoff = material_word(12u);
  material.base_color_map = material_mapping(13u);
  material.metal_rough_map = material_mapping(20u);
  material.normal_map = material_mapping(27u);
  material.occlusion_map = material_mapping(34u);
  material.emissive_map = material_mapping(41u);
  material.diffuse_transmission = material_word(48u);
  material.detail_map = material_mapping(49u);
}

// uv: both sets, xy and zw.
vec2 mapped(TextureMapping map, vec4 uv) {
  vec3 p = vec3(map.uv_set == 0u ? uv.xy : uv.zw, 1.0);
  return vec2(dot(map.u, p), dot(map.v, p));
}

// Added to a detail texture's mip level: without it grain is blurred at grazing sights, where it is seen best.
const float kDetailBias = -0.5;

// The detail texture adds what close views show: xy is added to the tangent-space normal, z is the relative change of
// the base colour. All are 0 on average.
vec3 material_detail(vec4 uv) {
  if (!material_has(kMaterialDetailTexture)) return vec3(0.0);
  return texture(detail_texture, mapped(material.detail_map, uv), kDetailBias).xyz * 2.0 - 1.0;
}

vec4 material_base_color(vec4 uv, vec4 vertex_color) {
  vec4 c = material.base_color;
  if (material_has(kMaterialVertexColor)) c *= vertex_color;
  if (material_has(kMaterialBaseColorTexture))
    c *= texture(base_color_texture, mapped(material.base_color_map, uv));
  return c;
}

#endif
