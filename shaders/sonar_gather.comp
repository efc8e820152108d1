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
  uvec2 label;
  float strength = reflected(hit.strength, hit.at, label);
  Share share = share_of(ends, floor(strength * c.fixed_scale + 0.5));
  int low = share.bins.x, high = share.bins.y;
  if (high < 0 || low >= int(c.n_range)) return;
  int first = max(low, 0), last = min(high, int(c.n_range) - 1);
  int before = first > low ? int(part_below(share, first) + 0.5) : 0;
  for (int bin = first; bin <= last; ++bin) {
    int until = int((bin == high ? share.whole : part_below(share, bin + 1)) + 0.5);
    until = max(before, until);
    add_counts(uint(bin) * c.n_azimuth + column, uint(until - before), float(until - before) / c.fixed_scale, label.x);
    before = until;
  }
}

void gather(uint column, BeamHit hit) {
  if (!(hit.range_m > 0.0 && hit.strength > 0.0)) return;  // zero normals give strength 0
  if (kFootprint != kSonarFootprintNone) {
    share_out(column, hit);
    return;
  }
  float bin = bin_at(hit.range_m);
  if (bin >= 0.0 && bin < float(c.n_range))  // NaN fails all comparisons
    add_return(uint(bin) * c.n_azimuth + column, hit.strength, hit.at);
}

void main() {
  c = pushed;
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0) return;
  uint first = c.first_row + (kLanes == 1 ? 0 : gl_LocalInvocationID.y);
  // Two rows a turn, whose fetches wait for memory together. Rows that are doubtful come after all others: integers
  // are summed, so that the order is free, and a loop within would cost a processor a fifth.
  uvec2 doubtful = uvec2(c.n_elevation, 0);  // rows, from and until
  Look before, after;  // kInTurn: the rows beside the two
  if (kInTurn) before = look_at(s, max(first, 1) - 1), after = look_at(s, first);
  for (uint row = first; row < c.end_row; row += 2 * kLanes) {
    uint next = min(row + kLanes, c.n_elevation - 1);
    Look look;
    if (kInTurn) look = after;
    else look = look_at(s, row);
    Look next_look = look_at(s, next);
    if (kInTurn) after = look_at(s, min(row + 2, c.n_elevation - 1));
    BeamHit hit = hit_of(s, look, ranges_beside(s, row, before, look, next_look), false);
    BeamHit next_hit = hit_of(s, next_look, ranges_beside(s, next, look, next_look, after), false);
    if (kInTurn) before = next_look;
    bool two = row + kLanes < c.end_row;
    if (hit.doubtful) doubtful = uvec2(min(doubtful.x, row), row + 1);
    if (two && next_hit.doubtful) doubtful = uvec2(min(doubtful.x, next), next + 1);
    if (!hit.doubtful) gather(column, hit);
    if (two && !next_hit.doubtful) gather(column, next_hit);
  }
  for (uint row = doubtful.x; row < doubtful.y; row += kLanes) {
    Look look = look_at(s, row);
    BeamHit hit = hit_of(s, look, neighbour_ranges(s, row, look.v), true);
    if (hit.doubtful) gather(column, hit);
  }
}
