#version 460
#extension GL_GOOGLE_include_directive : require

// A bubble less than a pixel wide, which has one light all over. Premultiplied output.
#include "shared/particle_fragment.glsl"

layout(location = 2) flat in vec4 body;
layout(location = 4) flat in vec4 flatness;
layout(location = 5) flat in vec3 upright;

void main() {
  vec2 from = from_streak();
  vec2 screen =
      vec2(flatness.z * from.x - flatness.w * from.y, flatness.w * from.x + flatness.z * from.y);
  vec2 spot =
      vec2(dot(screen, vec2(-upright.y, upright.x)), dot(screen, upright.xy) / upright.z) / shape.y;
  float cover = clamp(0.5 + (1.0 - length(spot)) * shape.y / 1.5, 0.0, 1.0);
  out_color = body * clamp(cover * shape.z, 0.0, 1.0);
}
