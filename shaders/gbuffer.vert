#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

// Vertex stage of the full G-buffer and of the forward pass for blended materials.
#include "shared/octahedral.h"
#include "shared/raster.h"

layout(constant_id = kSpecMotion) const bool kMotion = false;

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal;
layout(location = 2) in vec2 uv0;
layout(location = 3) in vec2 uv1;
layout(location = 4) in uint tangent;
layout(location = 5) in vec4 color;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kRasterInstances, scalar) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = kRasterNextInstances, scalar) readonly buffer NextInstances {
  NextInstance next_instances[];
};
layout(set = 0, binding = kRasterNextPositions, scalar) readonly buffer NextPositions {
  vec3 next_positions[];
};
layout(push_constant, scalar) uniform Push { RasterPush push; };

layout(location = 0) out vec3 out_normal;
layout(location = 1) flat out uint out_label;
layout(location = 2) out vec4 out_uv;
layout(location = 3) out vec4 out_tangent;
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec3 out_position;
layout(location = 6) out vec4 out_clip;
layout(location = 7) out vec4 out_next_clip;

void main() {
  Instance instance = instances[gl_InstanceIndex];
  vec4 p = vec4(position, 1.0);
  vec3 at = vec3(dot(instance.row0, p), dot(instance.row1, p), dot(instance.row2, p));
  gl_Position = views[gl_ViewIndex].clip_from_origin * vec4(at, 1.0);
  gl_PointSize = 1.0;
  vec3 r0 = instance.row0.xyz, r1 = instance.row1.xyz, r2 = instance.row2.xyz;
  vec3 n = octahedral_decode(normal);
  out_normal = vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
  out_label = instance.label;
  out_uv = vec4(uv0, uv1);
  out_color = color;
  out_position = at;
  out_tangent = vec4(0.0);
  if ((push.material_flags & kMaterialNormalTexture) != 0u) {
    vec2 e = vec2(float(tangent & 0xffffu), float(tangent >> 17)) / vec2(65535.0, 32767.0) * 2.0 - 1.0;
    vec3 t = octahedral_decode(e);
    out_tangent = vec4(dot(r0, t), dot(r1, t), dot(r2, t), (tangent & 0x10000u) != 0u ? 1.0 : -1.0);
  }
  if (kMotion) {
    NextInstance next = next_instances[gl_InstanceIndex];
    vec4 q = p;
    if (instance.deformed != 0xffffffffu)
      q.xyz = next_positions[instance.deformed + gl_VertexIndex];
    vec3 next_at = vec3(dot(next.row0, q), dot(next.row1, q), dot(next.row2, q));
    out_clip = gl_Position;
    out_next_clip = views[gl_ViewIndex].next_clip_from_origin * vec4(next_at, 1.0);
  } else {
    out_clip = vec4(0.0);
    out_next_clip = vec4(0.0);
  }
}
