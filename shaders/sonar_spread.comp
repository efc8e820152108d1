#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Spreads a field along range (the pulse) or across columns into beams (the beam's pattern): taps of a
// kernel, amplitudes where the field is coherent, powers where not.
#include "shared/sonar_receiver.glsl"

layout(constant_id = kReceiverSpecAxis) const uint kAxis = 0;
layout(constant_id = kReceiverSpecShift) const uint kShift = 0;
layout(constant_id = kReceiverSpecWrap) const uint kWrap = 0;
layout(set = 0, binding = kReceiverIn, rg32f) readonly uniform image2DArray field;
layout(set = 0, binding = kReceiverTaps) uniform texture2D taps;
layout(set = 0, binding = kReceiverOut, rg32f) writeonly uniform image2DArray result;

vec2 column_at(int column, int row) {
  int n = int(c.columns);
  if (kWrap != 0) {  // a kernel reaches less than once round
    column += column < 0 ? n : 0;
    column -= column >= n ? n : 0;
  }
  vec2 value = imageLoad(field, ivec3(clamp(column, 0, n - 1), row, 0)).rg;
  return column >= 0 && column < n ? value : vec2(0.0);
}

void main() {
  c = pushed;
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= int(c.out_columns) || at.y >= int(c.rows)) return;
  vec2 sum = vec2(0.0);
  float part = 0.0;
  if (kAxis == 1) {
    int low = max(0, -(at.y + c.first)), high = min(int(c.taps), int(c.rows) - at.y - c.first);
    for (int k = low; k < high; ++k)
      sum += texelFetch(taps, ivec2(k, 0), 0).r * imageLoad(field, ivec3(at.x, at.y + c.first + k, 0)).rg;
  } else {
    int start = at.x * int(c.stride) + c.first;
    float turned = 0.0;
    if (kShift != 0) {
      float bearing = c.first_bearing_rad + c.bearing_step_rad * float(at.x);
      turned = c.first_shift + c.shift * float(at.y) + c.shift_right * cos(bearing) + c.shift_back * sin(bearing);
    }
    float whole = floor(turned);
    part = turned - whole;
    start += int(whole);
    int kernel = min(at.x, textureSize(taps, 0).y - 1);  // a beam's own, or all beams' one
    for (int k = 0; k < int(c.taps); ++k) {
      vec2 value = column_at(start + k, at.y);
      if (kShift != 0) value = mix(value, column_at(start + k + 1, at.y), part);
      sum += texelFetch(taps, ivec2(k, kernel), 0).r * value;
    }
  }
  // Neighbouring columns are independent: amplitudes mixed so have less power on average than either.
  if (kShift != 0 && kAxis == 0 && kCoherent != 0)
    sum *= inversesqrt(1.0 - 2.0 * part * (1.0 - part) * (1.0 - c.tap_correlation));
  imageStore(result, ivec3(at, 0), vec4(sum, 0.0, 0.0));
}
