#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Skins and morphs one primitive: positions and normals now, positions at the next frame's time where
// motion is asked for.
#include "shared/octahedral.h"
#include "shared/raster.h"
#include "shared/affine.glsl"

layout(local_size_x = kDeformGroup) in;

layout(set = 0, binding = kDeformPositions, scalar) readonly buffer Positions { VertexPosition source[]; };
layout(set = 0, binding = kDeformSkin, scalar) readonly buffer Skin { SkinVertex skin[]; };
layout(set = 0, binding = kDeformJoints, scalar) readonly buffer Joints { mat4 joints[]; };
layout(set = 0, binding = kDeformMorphs, scalar) readonly buffer Morphs { MorphDelta morphs[]; };
layout(set = 0, binding = kDeformWeights, scalar) readonly buffer Weights { float weights[]; };
layout(set = 0, binding = kDeformOut, scalar) writeonly buffer Out { VertexPosition result[]; };
layout(set = 0, binding = kDeformNextOut, scalar) writeonly buffer NextOut { vec3 next_result[]; };
layout(push_constant, scalar) uniform Push { DeformPush push; };

mat4 blended(uint vertex, uint first_joint) {
  SkinVertex s = skin[push.first_skin + vertex];
  return s.weights.x * joints[first_joint + (s.joints01 & 0xffffu)] +
         s.weights.y * joints[first_joint + (s.joints01 >> 16)] +
         s.weights.z * joints[first_joint + (s.joints23 & 0xffffu)] +
         s.weights.w * joints[first_joint + (s.joints23 >> 16)];
}

void main() {
  uint vertex = gl_GlobalInvocationID.x;
  if (vertex >= push.vertex_count) return;
  VertexPosition v = source[push.first_source + vertex];
  for (uint time = 0u; time <= push.next; ++time) {
    vec3 p = v.position;
    vec3 n = octahedral_decode(unpackSnorm2x16(v.normal));
    for (uint t = 0u; t < push.morph_targets; ++t) {
      float w = weights[push.first_weight + time * push.weight_stride + t];
      MorphDelta d = morphs[push.first_morph + t * push.vertex_count + vertex];
      p += w * d.position;
      n += w * d.normal;
    }
    if (push.first_skin != 0xffffffffu) {
      mat4 m = blended(vertex, push.first_joint + time * push.joint_stride);
      p = (m * vec4(p, 1.0)).xyz;
      mat3 a = mat3(m);
      mat3 rows = transpose(a);
      n = turned_normal(rows[0], rows[1], rows[2], n).xyz;
    }
    if (time == 0u) {
      float size = dot(n, n);
      n = size > 1e-30 ? n * inversesqrt(size) : vec3(0.0, 1.0, 0.0);
      result[push.first_out + vertex] = VertexPosition(p, packSnorm2x16(octahedral_encode(n)));
    } else {
      next_result[push.first_out + vertex] = p;
    }
  }
}
