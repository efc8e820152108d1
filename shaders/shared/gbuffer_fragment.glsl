// The fragment stage of a camera's G-buffer: what shading in compute needs, and labels. Compiled with
// and without NERITIC_EMISSIVE and NERITIC_MOTION, and with NERITIC_SHAPE without what only shading
// needs: an output without an attachment would be paid for all the same.
#include "shared/octahedral.h"
#include "shared/raster.h"
#include "shared/material.glsl"
#include "shared/fragment_surface.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) flat in uint label;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 color;
layout(location = 5) in vec3 position;
#ifdef NERITIC_MOTION
layout(location = 6) in vec4 clip;
layout(location = 7) in vec4 next_clip;
layout(push_constant, scalar) uniform Push { RasterPush push; };
#endif

layout(location = 0) out vec2 out_normal;
layout(location = 1) out uvec2 out_label;
#ifndef NERITIC_SHAPE
layout(location = 2) out vec4 out_albedo;
layout(location = 3) out vec4 out_material;
#endif
#ifdef NERITIC_EMISSIVE
layout(location = 4) out vec3 out_emissive;
#endif
#ifdef NERITIC_MOTION
#if defined(NERITIC_EMISSIVE)
layout(location = 5) out vec2 out_motion;
#elif defined(NERITIC_SHAPE)
layout(location = 2) out vec2 out_motion;
#else
layout(location = 4) out vec2 out_motion;
#endif
#endif

void main() {
  take_material();
  vec4 base = material_base_color(uv, color);
  vec3 detail = material_detail(uv);
  base.rgb *= 1.0 + detail.z;
  out_normal = octahedral_encode(fragment_normal(normal, tangent, uv, detail));
  out_label = uvec2(label & 0xffffu, label >> 16);
#ifndef NERITIC_SHAPE
  vec3 m = fragment_material(uv);
  bool unlit = material_has(kMaterialUnlit);
  out_albedo = vec4(unlit ? vec3(0.0) : sqrt(max(base.rgb, vec3(0.0))),
                    material_has(kMaterialThin) ? 1.0 - material.diffuse_transmission : 1.0);
  out_material = vec4(m, unlit ? 1.0 : material.reflectance);
#endif
#ifdef NERITIC_EMISSIVE
  out_emissive = unlit ? base.rgb : fragment_emissive(uv);
#endif
#ifdef NERITIC_MOTION
  vec2 now = clip.xy / clip.w;
  // A point level with the eye or behind it has no place in the next picture: NaN.
  vec2 next = next_clip.w > 0.0 ? next_clip.xy / next_clip.w : vec2(uintBitsToFloat(0x7fc00000u));
  out_motion = (next - now) * 0.5 * push.target_size;
#endif
  // Last: what is discarded no longer helps its neighbours to their textures' derivatives.
  if (material_has(kMaterialMask) && base.a < material.alpha_cutoff) discard;
}
