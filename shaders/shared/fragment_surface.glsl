// From interpolated vertex outputs to a glTF surface. Needs material.glsl. GLSL only.
#ifndef NERITIC_FRAGMENT_SURFACE_GLSL
#define NERITIC_FRAGMENT_SURFACE_GLSL

// The shading normal in world axes, towards the side that is seen; detail is that of material_detail().
vec3 fragment_normal(vec3 normal, vec4 tangent, vec4 uv, vec3 detail) {
  vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0, 1.0, 0.0);
  if (!gl_FrontFacing) n = -n;
  if (!material_has(kMaterialNormalTexture)) return n;
  vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
  float size = dot(t, t);
  if (size < 1e-20) return n;
  t *= inversesqrt(size);
  vec3 b = cross(n, t) * (gl_FrontFacing ? tangent.w : -tangent.w);
  vec3 m = texture(normal_texture, mapped(material.normal_map, uv)).xyz * 2.0 - 1.0;
  m.xy = m.xy * material.normal_scale + detail.xy;
  return normalize(t * m.x + b * m.y + n * max(m.z, 1e-3));
}

// x: roughness, y: metallic, z: occlusion.
vec3 fragment_material(vec4 uv) {
  vec3 m = vec3(material.roughness, material.metallic, 1.0);
  if (material_has(kMaterialMetalRoughTexture))
    m.xy *= texture(metal_rough_texture, mapped(material.metal_rough_map, uv)).gb;
  if (material_has(kMaterialOcclusionTexture))
    m.z = 1.0 + material.occlusion_strength *
                    (texture(occlusion_texture, mapped(material.occlusion_map, uv)).r - 1.0);
  return m;
}

vec3 fragment_emissive(vec4 uv) {
  vec3 e = material.emissive;
  if (material_has(kMaterialEmissiveTexture))
    e *= texture(emissive_texture, mapped(material.emissive_map, uv)).rgb;
  return e;
}

#endif
