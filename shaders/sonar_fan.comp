#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Range and bearing to a fan seen from above: port left, ahead up. Four samples a pixel, so that far
// cells' edges are smooth. Colours as the sonar's panel picture has them (sonar/panel.cpp): copper.
#include "shared/sonar_fan.h"

layout(local_size_x = kSonarFanGroup, local_size_y = kSonarFanGroup) in;

layout(set = 0, binding = kSonarFanSums, scalar) readonly buffer Sums { uint sums[]; };
layout(set = 0, binding = kSonarFanScale, scalar) readonly buffer Scale { float full_scale; };
layout(set = 0, binding = kSonarFanPicture, rgba8) writeonly uniform image2DArray picture;
layout(push_constant, scalar) uniform Push { SonarFanPush c; };

const vec3 kStops[6] = vec3[](vec3(0.055, 0.035, 0.022), vec3(0.30, 0.125, 0.045),
                              vec3(0.62, 0.285, 0.075), vec3(0.89, 0.52, 0.16),
                              vec3(0.99, 0.80, 0.42), vec3(1.0, 0.975, 0.88));

vec3 copper(float value) {
  float at = clamp(value, 0.0, 1.0) * 5.0;
  uint i = min(uint(at), 4u);
  return mix(kStops[i], kStops[i + 1], at - float(i));
}

// The echo at metres to starboard and ahead; negative: outside the fan.
float echo(vec2 metres) {
  float bin = (length(metres) - c.range_min_m) * c.bins_per_m;
  if (bin < 0.0 || bin >= c.n_range) return -1.0;
  const float kTurn = 6.28318530718;
  float off = atan(metres.x, metres.y) - c.azimuth_middle_rad;
  off -= kTurn * round(off / kTurn);
  if (abs(off) >= c.azimuth_half_rad) return -1.0;
  uint column = min(uint((off + c.azimuth_half_rad) * c.bins_per_rad), c.n_azimuth - 1);
  uint cell = sums[uint(bin) * c.n_azimuth + column];
  return c.is_power != 0 ? sqrt(uintBitsToFloat(cell)) : float(cell);
}

void main() {
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= c.width || at.y >= c.height) return;
  float sum = 0.0, inside = 0.0;
  for (int k = 0; k < 4; ++k) {
    vec2 px = vec2(at) + vec2(0.25 + 0.5 * float(k & 1), 0.25 + 0.5 * float(k >> 1));
    float value = echo(vec2(c.left_m, c.top_m) + vec2(px.x, -px.y) * c.m_per_px);
    if (value < 0.0) continue;
    sum += value;
    inside += 1.0;
  }
  float part = inside > 0.0 && full_scale > 0.0 ? c.gain * sum / inside / full_scale : 0.0;
  vec3 rgb = copper(part > 0.0 ? pow(part, c.gamma) : 0.0);
  float alpha = inside / 4.0;
  if (c.is_opaque != 0) {
    rgb = mix(kStops[0], rgb, alpha);
    alpha = 1.0;
  }
  imageStore(picture, ivec3(at, 0), vec4(rgb, alpha));
}
