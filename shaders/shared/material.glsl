// A material's constants and textures (set 1), glTF 2.0 metallic-roughness. GLSL only.
#ifndef NERITIC_MATERIAL_GLSL
#define NERITIC_MATERIAL_GLSL

// A uniform block, not a storage buffer: helper invocations at triangle edges must read it too, or the
// derivatives there (so the mip level) are wrong. llvmpipe masks storage loads of helpers.
layout(set = 1, binding = kMaterialConstants, scalar) uniform Material { MaterialData material; };
layout(set = 1, binding = kMaterialBaseColor) uniform sampler2D base_color_texture;
layout(set = 1, binding = kMaterialMetalRough) uniform sampler2D metal_rough_texture;
layout(set = 1, binding = kMaterialNormal) uniform sampler2D normal_texture;
layout(set = 1, binding = kMaterialOcclusion) uniform sampler2D occlusion_texture;
layout(set = 1, binding = kMaterialEmissive) uniform sampler2D emissive_texture;

layout(constant_id = kSpecMaterial) const uint kMaterialFlags = ~0u;
bool material_has(uint flag) { return (kMaterialFlags & flag) != 0u; }

// uv: both sets, xy and zw.
vec2 mapped(TextureMapping map, vec4 uv) {
  vec3 p = vec3(map.uv_set == 0u ? uv.xy : uv.zw, 1.0);
  return vec2(dot(map.u, p), dot(map.v, p));
}

vec4 material_base_color(vec4 uv, vec4 vertex_color) {
  vec4 c = material.base_color;
  if (material_has(kMaterialVertexColor)) c *= vertex_color;
  if (material_has(kMaterialBaseColorTexture))
    c *= texture(base_color_texture, mapped(material.base_color_map, uv));
  return c;
}

#endif
