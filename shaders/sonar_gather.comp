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
  uint kinds = kLabels != 0 ? 2 : 1;
  uint base = scratch_base(kinds);
  bool inside = column < c.n_azimuth;
  if (inside) clear_column(kinds, base);
  wait_for_column();
  SonarColumn s = columns[min(column, c.n_azimuth - 1)];
  if (inside && s.pixel >= 0) {
    float pixels_per_tan = c.fy * s.sec_theta;
    for (uint row = gl_LocalInvocationID.y; row < c.n_elevation; row += kLanes) {
      SonarRow e = rows[row];
      int v = int(floor(c.cy - pixels_per_tan * e.tan_phi));
      if (v < 0 || v >= int(c.height)) continue;
      ivec3 at = ivec3(s.pixel, v, s.layer);
      float planar = planar_metres(texelFetch(depth_image, at, 0).r);
      if (planar <= 0.0) continue;
      vec3 n = normal_of(at);
      float ty = (c.cy - (float(v) + 0.5)) / c.fy;
      float along_pixel = dot(n, s.pixel_base) + ty * dot(n, s.up);
      float length_of = sqrt(s.pixel_square + ty * ty);
      float along = along_pixel;
      if (kPlane != 0) {
        float along_beam = dot(n, s.beam_base) + e.tan_phi * s.sec_theta * dot(n, s.up);
        float stretch = along_pixel / along_beam;
        if (stretch < kLargestStretch && stretch * kLargestStretch > 1.0) {
          planar *= stretch;
          along = along_beam;
          length_of = s.sec_theta * e.sec_phi;
        }
      }
      float strength = min(facing(-along / length_of), 1.0);
      float bin = (planar * length_of - c.range_min_m) * c.bins_per_m + c.edge_bias_bins;
      // A zero normal gives strength 0; NaN fails both comparisons.
      if (strength > 0.0 && bin >= 0.0 && bin < float(c.n_range))
        add_return(uint(bin), base, strength, at);
    }
  }
  wait_for_column();
  if (inside) write_column(column, base);
}
