#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// One sample a (theta, phi) cell centre: the pixel that the beam hits gives range and incidence; the
// intensity is added to its range bin. kPlane: the beam meets the plane through the pixel's point and
// normal, else the pixel's own range counts.
#include "shared/sonar_common.glsl"

// How far the plane may carry the range from the pixel's own, as a factor: beyond, the plane is seen
// so grazing that the neighbouring pixel sees something else, and the pixel's range counts. At half a
// pixel of .1 degrees it is reached at a grazing angle of .2 degrees.
const float kLargestStretch = 1.25;

void main() {
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0) return;
  float pixels_per_tan = c.fy * s.sec_theta;
  uint first = kLanes == 1 ? 0 : gl_LocalInvocationID.y;
  for (uint row = first; row < c.n_elevation; row += kLanes) {
    vec2 e = texelFetch(rows, ivec2(row, 0), 0).xy;  // tan, sec
    int v = int(floor(c.cy - pixels_per_tan * e.x));
    if (v < 0 || v >= int(c.height)) continue;
    ivec3 at = ivec3(s.pixel, v, s.layer);
    float planar = planar_metres(texelFetch(depth_image, at, 0).r);
    vec3 n = normal_of(at);
    float ty = (c.cy - (float(v) + 0.5)) / c.fy;
    float along_up = dot(n, s.up);
    float along_pixel = dot(n, s.pixel_base) + ty * along_up;
    float length_of = sqrt(s.pixel_square + ty * ty);
    float along = along_pixel;
    if (kPlane != 0) {
      float along_beam = dot(n, s.beam_base) + e.x * s.sec_theta * along_up;
      float stretch = along_pixel / along_beam;
      if (stretch < kLargestStretch && stretch * kLargestStretch > 1.0) {
        planar *= stretch;
        along = along_beam;
        length_of = s.sec_theta * e.y;
      }
    }
    float strength = min(facing(-along / length_of), 1.0);
    float bin = (planar * length_of - c.range_min_m) * c.bins_per_m + c.edge_bias_bins;
    // A zero normal gives strength 0; NaN fails all comparisons.
    if (planar > 0.0 && strength > 0.0 && bin >= 0.0 && bin < float(c.n_range))
      add_return(uint(bin) * c.n_azimuth + column, strength, at);
  }
}
