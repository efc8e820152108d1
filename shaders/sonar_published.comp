#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The published algorithm turned round: for each (theta, phi) cell, every pixel whose direction lies in
// it, from the last in row-major order to the first; a range bin of the cell counts once, with the
// last pixel's value. One thread owns a column (kLanes is 1), so nothing races.
#include "shared/sonar_common.glsl"

// Scratch: 1 + the row that counted there last.

// First pixel row below the direction of elevation tan_phi at the pixel column whose distance from the
// axis is 1 / cos = sec. Neighbouring cells share the expression, so no pixel is lost or counted twice.
int first_row_below(float tan_phi, float sec) {
  float v = floor(c.cy - 0.5 - c.fy * sec * tan_phi) + 1.0;
  return int(clamp(v, 0.0, float(c.height)));
}

float sec_of(int u) {
  float tx = (float(u) + 0.5 - c.cx) / c.fx;
  return sqrt(1.0 + tx * tx);
}

void add_pixel(ivec3 at, SonarColumn s, uint column, uint stamp) {
  vec4 surface = surface_at(at);
  float planar = planar_metres(surface.w);
  if (planar <= 0.0) return;
  vec3 n = normal_of(surface);
  if (!(dot(n, n) > 0.0)) return;
  float tx = (float(at.x) + 0.5 - c.cx) / c.fx, ty = (c.cy - (float(at.y) + 0.5)) / c.fy;
  float length_of = sqrt(1.0 + tx * tx + ty * ty);
  vec3 right = cross(s.forward, s.up);
  if (planar * (s.forward.y + tx * right.y + ty * s.up.y) > c.surface_m) return;  // sound does not leave the water
  float along = tx * dot(n, right) + ty * dot(n, s.up) + dot(n, s.forward);
  float bin = (planar * length_of - c.range_min_m) * c.bins_per_m;
  if (!(bin >= 0.0 && bin < float(c.n_range))) return;
  uint cell = uint(bin) * c.n_azimuth + column;
  if (scratch_at(cell) == stamp) return;  // a later pixel has that cell of the volume
  set_scratch(cell, stamp);
  float strength = min(facing(-along / length_of), 1.0);
  if (strength > 0.0) add_return(cell, strength, at);
}

void main() {
  c = pushed;
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  for (uint row = c.first_row; row < c.end_row && s.first_pixel < s.end_pixel; ++row) {
    vec2 edges = texelFetch(rows, ivec2(row, 0), 0).zw;
    float low = edges.x, high = edges.y;
    // The cell's rows in its outermost and innermost pixel columns bound those in between.
    float sec_a = sec_of(s.first_pixel), sec_b = sec_of(s.end_pixel - 1);
    float sec_in = s.first_pixel < int(c.cx) && s.end_pixel > int(c.cx) ? 1.0 : min(sec_a, sec_b);
    float sec_out = max(sec_a, sec_b);
    int v_first = max(min(first_row_below(high, sec_in), first_row_below(high, sec_out)), int(c.first_v));
    int v_end = min(max(first_row_below(low, sec_in), first_row_below(low, sec_out)), int(c.end_v));
    for (int v = v_end - 1; v >= v_first; --v)
      for (int u = s.end_pixel - 1; u >= s.first_pixel; --u) {
        float sec = sec_of(u);
        if (v >= first_row_below(high, sec) && v < first_row_below(low, sec))
          add_pixel(ivec3(u, v, s.layer), s, column, row + 1);
      }
  }
}
