// Forward shading of blended and transmissive materials, over the shaded picture. Premultiplied output. With
// NERITIC_TINTED a second output says how much of what lies behind passes, by channel; else its mean is alpha's.
#include "shared/lighting.h"
#include "shared/material.glsl"
#include "shared/fragment_surface.glsl"

layout(constant_id = kSpecMultiview) const bool kMultiview = true;
layout(constant_id = kSpecForwardGlow) const uint kGlowSamples = 4;
layout(constant_id = kSpecForwardTerms) const uint kTerms = ~0u;
layout(constant_id = kSpecForwardLamps) const uint kLamps = kMaxLamps;

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 color;
layout(location = 5) in vec3 position;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kRasterLighting, scalar) uniform Light { Lighting light; };

bool light_has(uint term) {
  return (kTerms & term) != 0u;
}
uint lamp_count() {
  return kLamps;
}
uint glow_samples() {
  return kGlowSamples;
}

#include "shared/surface.glsl"
float lamp_seen(uint lamp, vec3 position, vec3 normal) { return 1.0; }

#ifdef NERITIC_TINTED
layout(location = 0, index = 0) out vec4 out_color;
layout(location = 0, index = 1) out vec4 out_passing;
#else
layout(location = 0) out vec4 out_color;
#endif

void main() {
  take_material();
  int view = kMultiview ? gl_ViewIndex : 0;
  vec4 base = material_base_color(uv, color);
  vec3 detail = material_detail(uv);
  base.rgb *= 1.0 + detail.z;
  vec3 along = position - views[view].eye;
  float distance_m = max(length(along), 1e-6);
  along /= distance_m;
  vec3 m = fragment_material(uv);
  vec3 radiance;
  float own = base.a;
  vec3 passing = vec3(1.0 - base.a);
  if (material_has(kMaterialUnlit)) {
    radiance = base.rgb * light.emissive_scale;
  } else {
    Surface s = Surface(position, fragment_normal(normal, tangent, uv, detail), base.rgb, m.x, m.y, m.z, material.reflectance,
                        material_has(kMaterialThin) ? material.diffuse_transmission : 0.0);
    if (material_has(kMaterialTransmissive)) {
      // A thin pane: what is neither reflected nor scattered diffusely passes straight on.
      vec2 share = even_reflectance(s.roughness, clamp(dot(s.normal, -along), 0.0, 1.0));
      passing *= base.rgb * (1.0 - m.y) * (1.0 - dielectric_f0(s) * share.x - share.y);
      s.albedo *= mix(base.a, 1.0, m.y);
      own = 1.0;
    }
    radiance = shade_surface(s, -along, kAllSeen) + fragment_emissive(uv) * light.emissive_scale;
  }
  Sight sight = look_through(light.origin_depth_m - views[view].eye.y, along, distance_m);
  vec3 glow = lamp_glow(views[view].eye, along, distance_m);
  vec3 arriving = radiance * sight.transmittance * own + (sight.added + glow) * (1.0 - passing);
  float mean = (passing.r + passing.g + passing.b) / 3.0;
  out_color = vec4(min(arriving * light.exposure, vec3(60000.0)), 1.0 - mean);
#ifdef NERITIC_TINTED
  out_passing = vec4(passing, mean);
#endif
}
