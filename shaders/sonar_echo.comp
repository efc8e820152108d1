#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// The gather with terms: each beam's power is weighted by the beam's pattern, its range is the one that
// the sonar hears (sound speed, motion), and what it adds is power (64 bits) or, where speckle is named,
// the complex amplitude of the world's scatterers. Two integers a bin either way.
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

layout(set = 0, binding = kSonarBindEcho, scalar) uniform Echo { SonarEcho echo; };
layout(set = 0, binding = kSonarBindWeights) uniform texture2D weights;
layout(set = 0, binding = kSonarBindCorrection, scalar) readonly buffer Corrections { float corrections[]; };
layout(set = 0, binding = kSonarBindTexture) uniform texture2D gamma_quantiles;
layout(set = 0, binding = kSonarBindRecords, scalar) writeonly buffer Records { SonarRecord records[]; };

// The largest power of one beam that the counts hold; a ghost's mirror may focus a little.
const float kLargestPower = 8.0;

// Heard over true range, of the table: linear in range and in the sine of the elevation.
float correction_at(float range_m, float sine) {
  float x = min(range_m / echo.correction_range_m, 1.0) * float(echo.correction_width - 1);
  float y = (clamp(sine, -1.0, 1.0) * 0.5 + 0.5) * float(echo.correction_height - 1);
  uvec2 low = uvec2(min(x, float(echo.correction_width - 2)), min(y, float(echo.correction_height - 2)));
  vec2 part = vec2(x, y) - vec2(low);
  uint at = low.y * echo.correction_width + low.x, above = at + echo.correction_width;
  return mix(mix(corrections[at], corrections[at + 1], part.x), mix(corrections[above], corrections[above + 1], part.x),
             part.y);
}

// A run of beams of one column that meet one scatterer in one range bin: its power is summed, then its
// amplitude is added once. A scatterer is a cell of the world, so it is the same at every visit.
struct Run {
  ivec3 cell;
  uint bin;
  float power;
};

void flush(Run run, uint column) {
  if (!(run.power > 0.0)) return;
  uvec4 bits = hash_of(uvec4(uvec3(run.cell) + echo.origin_cell, echo.seed));
  float power = run.power;
  vec3 center = (vec3(run.cell) + 0.5 - echo.cell_fraction) / echo.cells_per_m;
  if (kTextured != 0) {
    uvec3 patch_cell = uvec3(ivec3(floor(center * echo.patches_per_m + echo.patch_fraction))) + echo.origin_patch;
    uint entries = uint(textureSize(gamma_quantiles, 0).x);
    uint entry = hash_of(uvec4(patch_cell, echo.seed + 1u)).x % entries;
    power *= texelFetch(gamma_quantiles, ivec2(entry, 0), 0).r;
  }
  vec2 z = sqrt(power) * complex_normal(bits.xy, fract(echo.turns_per_m * length(center)));
  ivec2 counts = ivec2(round(clamp(z, vec2(-32.0), vec2(32.0)) * echo.sum_scale));
  uint cell = 2 * (run.bin * c.n_azimuth + column);
  sums[cell] += uint(counts.x);  // two's complement: adds as signed numbers do
  sums[cell + 1] += uint(counts.y);
}

void add_power(uint cell, float power) {
  uint counts = uint(power * echo.sum_scale + 0.5);
  if (kLanes == 1) {
    uint before = sums[2 * cell];
    sums[2 * cell] = before + counts;
    if (before + counts < before) sums[2 * cell + 1] += 1;
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

// What a mirror's path adds: back by the mirror, forth directly (and the other way round). The eye is the
// sonar's mirror image. Returns the mean of both ways, 0 where there is no such path.
float ghost_range(vec3 direction, float range_m, inout float power) {
  vec3 hit = direction * range_m;
  float above = dot(hit, echo.world_up) - echo.water_level_m;
  if (above * echo.water_sign > 0.0) return 0.0;  // beyond the mirror
  float direct_m = length(hit - echo.ghost_source);
  float mean_m = 0.5 * (direct_m + range_m);
  float spread = mean_m / max(direct_m, 1e-3 * mean_m);
  power *= echo.ghost_weight * spread * spread;  // the receiver's gain counts 1 / mean^2 once
  return mean_m;
}

void main() {
  uint column = gl_GlobalInvocationID.x;
  if (column >= c.n_azimuth) return;
  SonarColumn s = columns[column];
  if (s.pixel < 0 && kRecords == 0) return;
  Run run = Run(ivec3(0), 0, 0.0);
  uint first = kLanes == 1 ? 0 : gl_LocalInvocationID.y;
  for (uint row = first; row < c.n_elevation; row += kLanes) {
    BeamHit hit = BeamHit(ivec3(0), 0.0, 0.0);
    if (s.pixel >= 0) hit = beam_hit(s, row);
    float power = hit.strength;
    if (kWeighted != 0) power *= texelFetch(weights, ivec2(column, row), 0).r;
    uvec2 label = uvec2(0);
    if (kReflect != 0 || kLabels != 0 || kRecords != 0) label = texelFetch(label_image, hit.at, 0).xy;
    if (kReflect != 0) power *= label.y < c.reflectivities ? reflectivity[label.y] : 1.0;
    float range_m = hit.range_m;
    vec3 direction = vec3(0.0);
    if (kCorrected != 0 || kGhost != 0 || kMoving != 0 || kCoherent != 0) direction = beam_direction(s, row);
    if (kGhost != 0) {
      range_m = ghost_range(direction, range_m, power);
      label.x = kSonarGhostClass;
    }
    float heard_m = range_m;
    if (kCorrected != 0) heard_m *= correction_at(range_m, dot(direction, echo.world_up));
    if (kMoving != 0) heard_m += range_m * dot(echo.motion, direction) + dot(echo.doppler, direction);
    power = min(power, kLargestPower);
    float bin = (heard_m - c.range_min_m) * c.bins_per_m + c.edge_bias_bins;
    bool heard = range_m > 0.0 && power > 0.0 && bin >= 0.0 && bin < float(c.n_range);
    if (kRecords != 0) {
      // A beam that ended on something is told where, heard or not, so that shadows are known.
      bool ended = range_m > 0.0 && bin < float(c.n_range);
      records[row * c.n_azimuth + column] =
          SonarRecord(ended ? uint(max(bin, 0.0)) : kSonarNoReturn,
                      heard ? uint(power * kSonarRecordScale + 0.5) : 0u, label.x | label.y << 16);
    }
    if (!heard) continue;
    uint range_bin = uint(bin);
    uint cell = range_bin * c.n_azimuth + column;
    if (kCoherent != 0) {
      ivec3 scatterer = ivec3(floor(direction * (hit.range_m * echo.cells_per_m) + echo.cell_fraction));
      if (scatterer != run.cell || range_bin != run.bin) {
        flush(run, column);
        run = Run(scatterer, range_bin, 0.0);
      }
      run.power += power;
    } else {
      add_power(cell, power);
    }
    if (kLabels != 0) {
      uint key = power_key(power, label.x);
      if (kLanes > 1) atomicMax(keys[cell], key);
      else if (key > keys[cell]) keys[cell] = key;
    }
  }
  if (kCoherent != 0) flush(run, column);
}
