#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The plain cosine: one sample a (theta, phi) cell centre, its incidence added to its range bin.
#include "shared/sonar_common.glsl"
#include "shared/sonar_beam.glsl"

void main() {
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0) return;
  uint first = kLanes == 1 ? 0 : gl_LocalInvocationID.y;
  for (uint row = first; row < c.n_elevation; row += kLanes) {
    BeamHit hit = beam_hit(s, row);
    float bin = (hit.range_m - c.range_min_m) * c.bins_per_m + c.edge_bias_bins;
    // A zero normal gives strength 0; NaN fails all comparisons.
    if (hit.range_m > 0.0 && hit.strength > 0.0 && bin >= 0.0 && bin < float(c.n_range))
      add_return(uint(bin) * c.n_azimuth + column, hit.strength, hit.at);
  }
}
