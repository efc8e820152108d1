#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The gather with terms: each beam's power is weighted by the beam's pattern, its range is the one that
// the sonar hears (sound speed, motion), and what it adds is power (64 bits) or, where speckle is named,
// the complex amplitude of the world's scatterers, made of the power once all rows are summed. Two integers a bin
// either way.
#include "shared/sonar_common.glsl"
#include "shared/sonar_echo.h"
#include "shared/random.glsl"
#include "shared/sonar_beam.glsl"

layout(constant_id = kSonarSpecCoherent) const uint kCoherent = 0;
layout(constant_id = kSonarSpecWeighted) const uint kWeighted = 0;
layout(constant_id = kSonarSpecCorrected) const uint kCorrected = 0;
layout(constant_id = kSonarSpecTextured) const uint kTextured = 0;
layout(constant_id = kSonarSpecRecords) const uint kRecords = 0;
layout(constant_id = kSonarSpecGhost) const uint kGhost = 0;
layout(constant_id = kSonarSpecMoving) const uint kMoving = 0;
layout(constant_id = kSonarSpecBent) const uint kBent = 0;

layout(set = 0, binding = kSonarBindEcho, scalar) uniform Echo { SonarEcho of_ping; };
SonarEcho echo;  // copied as c is
layout(set = 0, binding = kSonarBindWeights) uniform texture2D weights;
layout(set = 0, binding = kSonarBindCorrection, scalar) readonly buffer Corrections { float corrections[]; };
layout(set = 0, binding = kSonarBindTexture) uniform texture2D gamma_quantiles;
layout(set = 0, binding = kSonarBindRecords, scalar) writeonly buffer Records { SonarRecord records[]; };
layout(set = 0, binding = kSonarBindDirectDepth) uniform texture2DArray direct_depth;
layout(set = 0, binding = kSonarBindDirectLabel) uniform utexture2DArray direct_label;

// The largest power of one beam that 32 bits of counts hold. A ghost's may be above 1.
const float kLargestPower = 15.0;

// A table's value: linear in range and in the sine of the elevation. from: its first entry.
float correction_at(float range_m, float sine, uint from) {
  float x = min(range_m / echo.correction_range_m, 1.0) * float(echo.correction_width - 1);
  float y = (clamp(sine, -1.0, 1.0) * 0.5 + 0.5) * float(echo.correction_height - 1);
  uvec2 low = uvec2(min(x, float(echo.correction_width - 2)), min(y, float(echo.correction_height - 2)));
  vec2 part = vec2(x, y) - vec2(low);
  uint at = from + low.y * echo.correction_width + low.x, above = at + echo.correction_width;
  return mix(mix(corrections[at], corrections[at + 1], part.x), mix(corrections[above], corrections[above + 1], part.x),
             part.y);
}

void add_power(uint cell, uint counts) {
  if (kLanes == 1) {
    uint before = sum_at(2 * cell);
    set_sum(2 * cell, before + counts);
    if (before + counts < before) set_sum(2 * cell + 1, sum_at(2 * cell + 1) + 1);
  } else {
    uint before = atomicAdd(sums[2 * cell], counts);
    if (before + counts < before) atomicAdd(sums[2 * cell + 1], 1);
  }
}

// Strongest first, in steps of 1/512 octave, then the smallest label.
uint power_key(float power, uint label) {
  uint level = uint(clamp((log2(power) + 100.0) * 512.0, 1.0, 65535.0));
  return level << 16 | (65535u - label);
}

void add_key(uint cell, float power, uint label) {
  if (kLabels == 0 || !(power > 0.0)) return;
  add_to_key(cell, power_key(power, label));
}

// Column and row of the head (not of its mirror image) in a direction from the sonar; negative: beyond what it
// gathers.
ivec2 beam_of(vec3 direction) {
  float azimuth = atan(dot(direction, echo.head_right), -dot(direction, echo.head_back));
  float elevation = asin(clamp(dot(direction, echo.head_up), -1.0, 1.0));
  // A full turn's columns are a ring: its last bearing may round over.
  float column = (azimuth - echo.azimuth_min_rad) * echo.columns_per_rad;
  float row = (elevation - echo.elevation_min_rad) * echo.rows_per_rad;
  if (column < 0.0 || row < 0.0 || column > float(c.n_azimuth) || row >= float(c.n_elevation)) return ivec2(-1);
  return ivec2(min(uint(column), c.n_azimuth - 1), row);
}

// Where a bent ray leaves the sonar that ends at a range in a direction, in the same upright plane.
vec3 launched(float range_m, vec3 direction) {
  float sine = dot(direction, echo.world_up);
  vec3 level = direction - sine * echo.world_up;
  float cosine = length(level);
  if (!(cosine > 1e-6)) return direction;  // straight up or down no ray bends
  float bend = correction_at(range_m, sine, echo.correction_width * echo.correction_height);
  vec2 turn = vec2(cos(bend), sin(bend));
  return level * ((cosine * turn.x - sine * turn.y) / cosine) +
         echo.world_up * (sine * turn.x + cosine * turn.y);
}

// The weight in a direction from the sonar, linear between rows and columns; none beyond the rows.
// Columns beyond the last are as it: only a cone's differ, and fall off to its edge.
float weight_towards(vec3 direction, bool turned_over) {
  float azimuth = atan(dot(direction, echo.head_right), -dot(direction, echo.head_back));
  float elevation = asin(clamp(dot(direction, echo.head_up), -1.0, 1.0));
  float row = (elevation - echo.elevation_min_rad) * echo.rows_per_rad;
  if (row < 0.0 || row >= float(c.n_elevation)) return 0.0;
  if (turned_over) row = float(c.n_elevation) - row;
  ivec2 last = ivec2(c.n_azimuth, c.n_elevation) - 1;
  vec2 place = clamp(vec2((azimuth - echo.azimuth_min_rad) * echo.columns_per_rad, row) - 0.5, vec2(0.0), vec2(last));
  ivec2 low = ivec2(place), high = min(low + 1, last);
  vec2 part = place - vec2(low);
  vec2 lower = vec2(texelFetch(weights, low, 0).r, texelFetch(weights, ivec2(high.x, low.y), 0).r);
  vec2 upper = vec2(texelFetch(weights, ivec2(low.x, high.y), 0).r, texelFetch(weights, high, 0).r);
  vec2 weight = mix(lower, upper, part.y);
  return mix(weight.x, weight.y, part.x);
}

// A row's weight by where its sound leaves; the solid angle stays the row's own.
float weight_leaving(vec3 leaves, uint row) {
  float weight = weight_towards(leaves, kGhost != 0);
  if (kGhost != 0 || echo.solid_angle == 0) return weight;
  float up = dot(leaves, echo.head_up);
  return weight * inversesqrt(max(1.0 - up * up, 1e-6)) / texelFetch(rows, ivec2(row, 0), 0).y;
}

// The pattern's one-way weight. The eye's rows are the head's turned over, and so is the table.
float pattern_of(ivec2 beam) {
  if (beam.x < 0) return 0.0;
  return kWeighted != 0 ? texelFetch(weights, ivec2(beam.x, int(c.n_elevation) - 1 - beam.y), 0).r : 1.0;
}

// Whether a leg in a direction from the sonar meets what the sonar sees drawn larger than it is.
bool meets(SonarDrawnLarger thing, vec3 direction) {
  float azimuth = atan(dot(direction, echo.head_right), -dot(direction, echo.head_back));
  float elevation = asin(clamp(dot(direction, echo.head_up), -1.0, 1.0));
  vec4 own = thing.direct_rad;
  return abs(azimuth - own.x) < own.y && elevation > own.z && elevation < own.w;
}

// Something hides a leg where it is nearer by more than this part of it, and by two bins.
const float kHidesBy = 1.0 / 64.0;

// Whether the sonar sees as far as a leg's end: in one of three pixels, since the end is a surface's point.
bool is_clear(ivec2 beam, vec3 direction, float leg_m, uint through_class) {
  SonarColumn s = columns[beam.x];  // pixels and layers are the head's as they are its mirror image's
  if (s.pixel < 0) return true;
  float up = dot(direction, echo.head_up);
  float v = floor(c.cy - c.fy * s.sec_theta * up * inversesqrt(max(1.0 - up * up, 1e-12)));
  float nearest_m = leg_m * (1.0 - kHidesBy) - 2.0 / c.bins_per_m;
  for (int i = -1; i <= 1; ++i) {
    ivec3 at = ivec3(s.pixel, clamp(int(v) + i, 0, int(c.height) - 1), s.layer);
    float ty = (c.cy - (float(at.y) + 0.5)) / c.fy;
    float range_m = planar_metres(texelFetch(direct_depth, at, 0).r) * sqrt(1.0 + s.pixel_tan * s.pixel_tan + ty * ty);
    if (!(range_m > 0.0) || range_m > nearest_m) return true;
    if (kLarger != 0) {
      uint entry = larger_of(texelFetch(direct_label, at, 0).y);
      if (entry < c.drawn_larger && drawn_larger[entry].direct != 0 &&
          !meets(drawn_larger[entry], direction))
        return true;
    }
    if (through_class != 0 && texelFetch(direct_label, at, 0).x == through_class) return true;
  }
  return false;
}

// A mirror's path: back by the mirror, forth directly (and the other way round). The eye is the sonar's
// mirror image.
struct GhostPath {
  float mean_m;    // of both legs; 0: there is no such path
  float direct_m;
  vec3 direct;     // unit, from the sonar
  vec3 launch;     // unit, from the sonar to where the mirror shows the point
};

// And what it adds, the mean of both ways round. The beam's solid angle covers a patch of area range^2 / cos(in),
// which Lambert's law sends on with cos(in) cos(out), so cos(out) alone is left. Each leg passes the pattern once.
// A point that the mirror's view shows has a free path from the mirror. The sonar's own view tells whether the paths
// from the sonar to the mirror and to the point are free.
GhostPath ghost_path(vec3 direction, uint row, BeamHit hit, out float power) {
  GhostPath none = GhostPath(0.0, 0.0, vec3(0.0), vec3(0.0));
  power = 0.0;
  vec3 point = direction * hit.range_m;
  float above = dot(point, echo.world_up) - echo.water_level_m;
  if (above * echo.water_sign > 0.0) return none;  // beyond the mirror
  vec3 leg = point - echo.ghost_source;
  float direct_m = length(leg);
  vec3 n = normal_at(hit.at);
  if (kFacing == 0 && dot(n, direction) > 0.0) n = -n;
  float cosine = -dot(n, leg) / direct_m;
  if (!(hit.strength > 0.0 && cosine > 0.0)) return none;  // turned away from the mirror or from the sonar
  float mean_m = 0.5 * (direct_m + hit.range_m);
  ivec2 direct_beam = beam_of(leg / direct_m);
  float through =
      kBent != 0 ? weight_towards(launched(direct_m, leg / direct_m), true) : pattern_of(direct_beam);
  power = min(cosine, 1.0) * echo.ghost_weight * through;
  if (!(power > 0.0) || !is_clear(direct_beam, leg / direct_m, direct_m, 0)) return none;
  vec3 launch = direction - 2.0 * dot(direction, echo.world_up) * echo.world_up;
  ivec2 launch_beam = beam_of(launch);
  float mirror_m = echo.water_level_m / dot(direction, echo.world_up);
  if (launch_beam.x >= 0 && !is_clear(launch_beam, launch, mirror_m, echo.mirror_class)) return none;
  if (echo.solid_angle != 0) power /= texelFetch(rows, ivec2(row, 0), 0).y;
  float spread = 1.0;
  if (echo.ghost_spreading == kSonarGhostSpreading) spread = mean_m / max(direct_m, 1e-3 * mean_m);
  if (echo.ghost_spreading == kSonarGhostNoSpreading) spread = hit.range_m / mean_m;
  power *= spread * spread;
  return GhostPath(mean_m, direct_m, leg / direct_m, launch);
}

// The range that is heard, by the speed of sound, for a range in a direction from the sonar.
float corrected(float range_m, vec3 direction) {
  return range_m * correction_at(range_m, dot(direction, echo.world_up), 0);
}

// The way of an echo: there and back, directions from the sonar. Without a ghost both are the eye's.
struct Legs {
  vec3 there, back;
  float there_m, back_m;
};

// The range that is heard, of the mean of both legs.
float heard_of(Legs legs, float path_m) {
  float heard_m = path_m;
  vec3 direction = legs.there;  // the sonar's motion counts on either leg
  if (kCorrected != 0) heard_m = corrected(legs.there_m, legs.there);
  if (kGhost != 0) {
    if (kCorrected != 0) heard_m = 0.5 * (heard_m + corrected(legs.back_m, legs.back));
    direction = 0.5 * (legs.there + legs.back);
  }
  if (kMoving != 0) heard_m += path_m * dot(echo.motion, direction) + dot(echo.doppler, direction);
  return heard_m;
}

// The legs of a path seen in a direction from the eye, and how far off its end is from there.
Legs legs_of_path(vec3 eye, float path_m, out float range_m) {
  range_m = path_m;
  if (kGhost == 0) return Legs(eye, eye, path_m, path_m);
  vec3 g = echo.ghost_source;
  range_m = max((4.0 * path_m * path_m - dot(g, g)) / (4.0 * path_m - 2.0 * dot(g, eye)), 0.0);
  vec3 leg = eye * range_m - g;
  float direct_m = max(length(leg), 1e-6);
  return Legs(eye - 2.0 * dot(eye, echo.world_up) * echo.world_up, leg / direct_m, range_m, direct_m);
}

#include "shared/sonar_speckle.glsl"

// One row's echo: its power by bins, heard over true range, and where its ends lie.
struct RowEcho {
  float power;
  float bin;      // of its centre
  vec2 ends_m;    // heard
  float range_m;  // heard, of its centre
  uint label;
};

// The surface's point at a heard range, on the line between the row's ends, as far off as it is heard; part: of the
// way from the nearer end.
vec3 point_at(SonarColumn s, BeamHit hit, RowEcho e, float bin_range_m, out float part) {
  vec3 near = beam_towards(s, hit.ends_tan.x) * hit.ends_m.x, far = beam_towards(s, hit.ends_tan.y) * hit.ends_m.y;
  float span = e.ends_m.y - e.ends_m.x;
  part = span > 0.0 ? clamp((bin_range_m - e.ends_m.x) / span, 0.0, 1.0) : 0.5;
  return mix(near, far, part);
}

// The place of a direction from the eye, in rows.
float place_of(SonarColumn s, vec3 direction) {
  float rows_up = (asin(clamp(dot(direction, s.up), -1.0, 1.0)) - echo.elevation_min_rad) * echo.rows_per_rad;
  return clamp(rows_up, 0.0, float(c.n_elevation));
}

// Notes a row's power in the bins that its height spans, for the scatterers there.
void share_out_coherent(SonarColumn s, uint column, uint row, BeamHit hit, RowEcho e, float heard, inout ivec2 noted) {
  float drawn_out = e.range_m / hit.range_m;
  vec2 ends = e.ends_m;
  Share share = share_of(ends, 1.0);
  int low = share.bins.x, high = share.bins.y;
  int first = max(low, 0), last = min(high, int(c.n_range) - 1);
  noted = ivec2(min(noted.x, first), max(noted.y, last));
  bool rising = hit.ends_tan.x <= hit.ends_tan.y;
  float below = first > low ? part_below(share, first) : 0.0;
  for (int bin = first; bin <= last; ++bin) {
    float upto = bin == high ? 1.0 : part_below(share, bin + 1);
    float power = e.power * max(upto - below, 0.0);
    below = upto;
    vec2 within_m = vec2(max(range_at(bin), ends.x), min(range_at(bin + 1), ends.y));
    float part;
    vec3 point = point_at(s, hit, e, 0.5 * (within_m.x + within_m.y), part) / drawn_out;
    if (hit.larger) point = hit.towards * hit.range_m;
    vec2 within = vec2(bin_at(within_m.x), bin_at(within_m.y));
    float place = hit.larger ? place_of(s, hit.towards) : float(row) + (rising ? part : 1.0 - part);
    if (power > 0.0) note(column, point, place, heard, within, bin, power);
    add_key(uint(bin) * c.n_azimuth + column, power, e.label);
  }
}

// Shares a row's power out over the bins that its height spans. Parts are rounded at the bins' edges, so
// that their sum is the whole.
void share_out(uint column, RowEcho e) {
  Share share = share_of(e.ends_m, 1.0);
  int low = share.bins.x, high = share.bins.y;
  int first = max(low, 0), last = min(high, int(c.n_range) - 1);
  uint counts = uint(e.power * echo.sum_scale + 0.5);
  float below = first > low ? part_below(share, first) : 0.0;
  uint before = uint(below * float(counts) + 0.5);
  for (int bin = first; bin <= last; ++bin) {
    float upto = bin == high ? 1.0 : part_below(share, bin + 1);
    float power = e.power * max(upto - below, 0.0);
    uint cell = uint(bin) * c.n_azimuth + column;
    uint until = bin == high ? counts : max(before, min(counts, uint(upto * float(counts) + 0.5)));
    add_power(cell, until - before);
    before = until;
    add_key(cell, power, e.label);
    below = upto;
  }
}

uint end_of(float range_m) { return uint(clamp(bin_at(range_m), 0.0, float(kSonarFarthestEnd - 1))); }

// A beam that hit a surface records where, even if its echo is too weak to count, so that shadows are known.
void tell(uint column, uint row, RowEcho e, bool heard, uint label) {
  SonarRecord record = SonarRecord(kSonarNoReturn, 0, label, 0);
  if (e.range_m > 0.0) {
    uint near = end_of(e.ends_m.x), far = end_of(e.ends_m.y);
    record.bin = kFootprint != kSonarFootprintNone && heard ? kSonarSharedReturn : end_of(e.range_m);
    record.counts = heard ? uint(e.power * kSonarRecordScale + 0.5) : 0u;
    record.ends = near | far << 16;
  }
  records[row * c.n_azimuth + column] = record;
}

void main() {
  c = pushed;
  echo = of_ping;
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0 && kRecords == 0) return;
  ivec2 noted = ivec2(int(c.n_range), -1);  // coherent: the first and the last bin with power
  uint first = c.first_row + (kLanes == 1 ? 0 : gl_LocalInvocationID.y);
  Look before, look, after;  // kInTurn: the rows beside each
  if (kInTurn) look = look_at(s, max(first, 1) - 1), after = look_at(s, first);
  for (uint row = first; row < c.end_row; row += kLanes) {
    if (kInTurn) {
      before = look;
      look = after;
      after = look_at(s, min(row + 1, c.n_elevation - 1));
    } else look = look_at(s, row);
    BeamHit hit = no_hit();
    if (s.pixel >= 0) hit = beam_hit(s, look, ranges_beside(s, row, before, look, after));
    float power = hit.strength;
    uvec2 label = uvec2(0);
    float range_m = hit.range_m;
    vec3 eye = vec3(0.0);
    if (kCorrected != 0 || kGhost != 0 || kMoving != 0 || kCoherent != 0 || kLarger != 0) eye = beam_direction(s, row);
    if (hit.larger) eye = hit.towards;
    Legs legs = Legs(eye, eye, range_m, range_m);
    if (kGhost != 0) {
      GhostPath ghost = GhostPath(0.0, 0.0, vec3(0.0), vec3(0.0));
      if (range_m > 0.0) ghost = ghost_path(eye, row, hit, power);
      legs = Legs(ghost.launch, ghost.direct, range_m, ghost.direct_m);
      range_m = ghost.mean_m;
    }
    float heard_m = heard_of(legs, range_m);
    bool leaves = true;  // within the beam
    if (kBent != 0) {
      float weight = range_m > 0.0 ? weight_leaving(launched(legs.there_m, legs.there), row) : 0.0;
      power *= weight;
      leaves = weight > 0.0;
    } else if (kWeighted != 0 && hit.larger) {
      power *= range_m > 0.0 ? weight_leaving(legs.there, row) : 0.0;
    } else if (kWeighted != 0) power *= texelFetch(weights, ivec2(column, row), 0).r;
    if (kReflect != 0 || kLabels != 0 || kRecords != 0) label = texelFetch(label_image, hit.at, 0).xy;
    if (kReflect != 0) power *= label.y < c.reflectivities ? abs(reflectivity[label.y]) : 1.0;
    if (kGhost != 0) label.x = kSonarGhostClass;
    RowEcho e = RowEcho(min(power, kLargestPower), bin_at(heard_m), vec2(heard_m), heard_m, label.x);
    if (kFootprint != 0 && range_m > 0.0) e.ends_m = shared_ends(hit.ends_m * (heard_m / hit.range_m), heard_m);
    if (kBent != 0 && !leaves) e.range_m = 0.0;  // no ray, so no shadow of what it would end on
    bool echoes = range_m > 0.0 && e.power > 0.0;
    bool heard = echoes && e.bin >= 0.0 && e.bin < float(c.n_range);
    if (kFootprint != kSonarFootprintNone)
      heard = echoes && bin_at(e.ends_m.y) >= 0.0 && bin_at(e.ends_m.x) < float(c.n_range);
    if (kRecords != 0) tell(column, row, e, heard, label.x | label.y << 16);
    if (!heard) continue;
    if (kFootprint != kSonarFootprintNone) {
      if (kCoherent != 0) share_out_coherent(s, column, row, hit, e, heard_m / range_m, noted);
      else share_out(column, e);
      continue;
    }
    uint cell = uint(e.bin) * c.n_azimuth + column;
    if (kCoherent != 0) {
      int bin = int(e.bin);
      note(column, eye * hit.range_m, hit.larger ? place_of(s, eye) : float(row) + 0.5, heard_m / range_m, vec2(e.bin), bin, e.power);
      noted = ivec2(min(noted.x, bin), max(noted.y, bin));
    } else {
      add_power(cell, uint(e.power * echo.sum_scale + 0.5));
    }
    add_key(cell, e.power, e.label);
  }
  if (kCoherent != 0) sound_column(s, column, noted.x, noted.y);
}
