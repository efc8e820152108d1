#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The value that the fan shows in full brightness: a high quantile of what is not silent, followed
// slowly so that one strong echo does not make the picture flicker.
#include "shared/sonar_fan.h"

layout(local_size_x = kSonarFanScaleGroup) in;

layout(set = 0, binding = kSonarFanSums, scalar) readonly buffer Sums { uint sums[]; };
layout(set = 0, binding = kSonarFanScale, scalar) buffer Scale { float full_scale; };  // 0: none yet
layout(push_constant, scalar) uniform Push { SonarFanScalePush c; };

shared uint counts[kSonarFanScaleBins];

uint bin_of(uint value) {
  if (c.is_power != 0)
    return uint(clamp((0.5 * log2(uintBitsToFloat(value)) + 64.0) * 2.0, 0.0, float(kSonarFanScaleBins - 1)));
  uint octave = uint(findMSB(value));
  uint eighth = octave >= 3 ? (value >> (octave - 3)) & 7u : (value << (3 - octave)) & 7u;
  return octave * 8 + eighth;
}

// Upper edge of a bin.
float value_of(uint bin) {
  if (c.is_power != 0) return exp2(float(bin + 1) * 0.5 - 64.0);
  return exp2(float(bin / 8)) * (1.0 + float(bin % 8 + 1) / 8.0);
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  for (uint i = lane; i < kSonarFanScaleBins; i += kSonarFanScaleGroup) counts[i] = 0;
  barrier();
  for (uint i = lane * c.stride; i < c.cells; i += kSonarFanScaleGroup * c.stride)
    if (sums[i] > 0) atomicAdd(counts[bin_of(sums[i])], 1);
  barrier();
  if (lane != 0) return;
  uint total = 0;
  for (uint i = 0; i < kSonarFanScaleBins; ++i) total += counts[i];
  if (total == 0) return;  // silence: the scale stays
  uint wanted = uint(ceil(c.quantile * float(total)));
  uint below = 0, bin = 0;
  for (; bin < kSonarFanScaleBins - 1; ++bin) {
    below += counts[bin];
    if (below >= wanted) break;
  }
  float found = value_of(bin);
  full_scale = full_scale > 0.0 ? mix(full_scale, found, c.follow) : found;
}
