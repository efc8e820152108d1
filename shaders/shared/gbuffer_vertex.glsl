// Vertex stage of the full G-buffer and of the forward pass for blended materials.
#include "shared/raster_vertex.glsl"

layout(constant_id = kSpecMotion) const bool kMotion = false;
layout(constant_id = kSpecMaterial) const uint kMaterialFlags = ~0u;

layout(location = 2) in vec2 uv0;
layout(location = 3) in vec2 uv1;
layout(location = 4) in uint tangent;
layout(location = 5) in vec4 color;
layout(location = kInstanceLabel) in uvec2 label_deformed;
// Fed in the pipelines with motion only; without it the shader never reads them.
layout(location = kNextInstanceRow0) in vec4 next_row0;
layout(location = kNextInstanceRow1) in vec4 next_row1;
layout(location = kNextInstanceRow2) in vec4 next_row2;

layout(set = 0, binding = kRasterNextPositions, scalar) readonly buffer NextPositions {
  vec3 next_positions[];
};

layout(location = 2) out vec4 out_uv;
layout(location = 3) out vec4 out_tangent;
layout(location = 4) out vec4 out_color;
layout(location = 5) out vec3 out_position;
layout(location = 6) out vec4 out_clip;
layout(location = 7) out vec4 out_next_clip;

void main() {
  vec3 at = place_vertex();
  vec4 turned = placed_normal();
  out_normal = turned.xyz;
  out_label = label_deformed.x;
  // A driver fetches only the data that the material uses.
  out_uv = vec4((kMaterialFlags & kMaterialTextures) != 0u ? uv0 : vec2(0.0), (kMaterialFlags & kMaterialSecondUv) != 0u ? uv1 : vec2(0.0));
  out_color = (kMaterialFlags & kMaterialVertexColor) != 0u ? color : vec4(1.0);
  out_position = at;
  out_tangent = vec4(0.0);
  if ((kMaterialFlags & kMaterialNormalTexture) != 0u) {
    vec2 e = vec2(float(tangent & 0xffffu), float(tangent >> 17)) / vec2(65535.0, 32767.0) * 2.0 - 1.0;
    vec3 t = octahedral_decode(e);
    float sign = (tangent & 0x10000u) != 0u ? 1.0 : -1.0;
    out_tangent = vec4(dot(row0.xyz, t), dot(row1.xyz, t), dot(row2.xyz, t), sign * turned.w);
  }
  if (kMotion) {
    vec4 q = vec4(position, 1.0);
    if (label_deformed.y != 0xffffffffu)
      q.xyz = next_positions[label_deformed.y + gl_VertexIndex];
    vec3 next_at = vec3(dot(next_row0, q), dot(next_row1, q), dot(next_row2, q));
    out_clip = gl_Position;
    out_next_clip = views[view_index()].next_clip_from_origin * vec4(next_at, 1.0);
  } else {
    out_clip = vec4(0.0);
    out_next_clip = vec4(0.0);
  }
}
