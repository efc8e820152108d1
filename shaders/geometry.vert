#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

// Vertex stage of the geometry G-buffer (depth, normal, label): all that a sonar needs.
#include "shared/octahedral.h"
#include "shared/raster.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };
layout(set = 0, binding = kRasterInstances, scalar) readonly buffer Instances { Instance instances[]; };

layout(location = 0) out vec3 out_normal;
layout(location = 1) flat out uint out_label;

void main() {
  Instance instance = instances[gl_InstanceIndex];
  vec4 p = vec4(position, 1.0);
  vec3 at = vec3(dot(instance.row0, p), dot(instance.row1, p), dot(instance.row2, p));
  gl_Position = views[gl_ViewIndex].clip_from_origin * vec4(at, 1.0);
  gl_PointSize = 1.0;
  // The cofactor matrix turns normals rightly under any affine map (it is det * inverse transpose).
  vec3 r0 = instance.row0.xyz, r1 = instance.row1.xyz, r2 = instance.row2.xyz;
  vec3 n = octahedral_decode(normal);
  out_normal = vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
  out_label = instance.label;
}
