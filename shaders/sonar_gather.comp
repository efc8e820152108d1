#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The plain cosine: one sample a (theta, phi) cell centre, its incidence added to its range bin, or shared
// out over the bins that the row's height spans (kFootprint).
#include "shared/sonar_common.glsl"
#include "shared/sonar_beam.glsl"

// Parts of the counts, rounded at the bins' edges, so that their sum is the whole.
void share_out(uint column, BeamHit hit) {
  vec2 ends = shared_ends(hit.ends_m, hit.range_m);
  int low = int(floor(bin_at(ends.x))), high = int(floor(bin_at(ends.y)));
  if (high < 0 || low >= int(c.n_range)) return;
  uvec2 label;
  float strength = reflected(hit.strength, hit.at, label);
  float counts = floor(strength * c.fixed_scale + 0.5);
  int first = max(low, 0), last = min(high, int(c.n_range) - 1);
  uint before = first > low ? uint(part_below(ends, range_at(first)) * counts + 0.5) : 0;
  for (int bin = first; bin <= last; ++bin) {
    uint until = uint(bin == high ? counts : part_below(ends, range_at(bin + 1)) * counts + 0.5);
    until = max(before, min(until, uint(counts)));
    add_counts(uint(bin) * c.n_azimuth + column, until - before, float(until - before) / c.fixed_scale, label.x);
    before = until;
  }
}

void main() {
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0) return;
  uint first = kLanes == 1 ? 0 : gl_LocalInvocationID.y;
  for (uint row = first; row < c.n_elevation; row += kLanes) {
    BeamHit hit = beam_hit(s, row);
    if (kFootprint != kSonarFootprintNone) {
      if (hit.range_m > 0.0 && hit.strength > 0.0) share_out(column, hit);
      continue;
    }
    float bin = (hit.range_m - c.range_min_m) * c.bins_per_m + c.edge_bias_bins;
    // A zero normal gives strength 0; NaN fails all comparisons.
    if (hit.range_m > 0.0 && hit.strength > 0.0 && bin >= 0.0 && bin < float(c.n_range))
      add_return(uint(bin) * c.n_azimuth + column, hit.strength, hit.at);
  }
}
