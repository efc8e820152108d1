// What both sonar gathers do alike: read a pixel of the G-buffer, sum into a column's range bins,
// write the column out. Integers only are summed, so the order of addition cannot change a bit.
#include "shared/octahedral.h"
#include "shared/sonar.h"

layout(constant_id = kSonarSpecColumns) const uint kColumns = 8;
layout(constant_id = kSonarSpecLanes) const uint kLanes = 1;
layout(constant_id = kSonarSpecSharedWords) const uint kSharedWords = 1;
layout(constant_id = kSonarSpecPlane) const uint kPlane = 1;
layout(constant_id = kSonarSpecReversedZ) const uint kReversedZ = 1;
layout(constant_id = kSonarSpecOctahedral) const uint kOctahedral = 1;
layout(constant_id = kSonarSpecFacing) const uint kFacing = 1;
layout(constant_id = kSonarSpecReflect) const uint kReflect = 0;
layout(constant_id = kSonarSpecLabels) const uint kLabels = 1;
layout(local_size_x_id = kSonarSpecColumns, local_size_y_id = kSonarSpecLanes) in;

layout(set = 0, binding = kSonarBindColumns, scalar) readonly buffer Columns { SonarColumn columns[]; };
layout(set = 0, binding = kSonarBindRows, scalar) readonly buffer Rows { SonarRow rows[]; };
layout(set = 0, binding = kSonarBindDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kSonarBindNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kSonarBindLabel) uniform utexture2DArray label_image;
layout(set = 0, binding = kSonarBindReflectivity, scalar) readonly buffer Reflectivity { float reflectivity[]; };
layout(set = 0, binding = kSonarBindImage, scalar) writeonly buffer Image { float intensity[]; };
layout(set = 0, binding = kSonarBindLabels, scalar) writeonly buffer Labels { uint labels[]; };
layout(set = 0, binding = kSonarBindScratch, scalar) buffer Scratch { uint scratch[]; };
layout(push_constant, scalar) uniform Push { SonarPush c; };

shared uint sums[kSharedWords];

// Planar metres of a depth texel; 0 where nothing is hit (cleared, NaN, infinite, negative).
float planar_metres(float texel) {
  float metres = kReversedZ != 0 ? c.near_m / texel : texel;
  return texel > 0.0 && metres < 3.0e38 ? metres : 0.0;
}

// Unit normal; zero length where the image says that it is unknown.
vec3 normal_of(ivec3 at) {
  vec4 texel = texelFetch(normal_image, at, 0);
  return kOctahedral != 0 ? octahedral_decode(texel.xy) : texel.xyz;
}

float facing(float cosine) { return kFacing != 0 ? max(cosine, 0.0) : abs(cosine); }

// Slots: kinds (0 sums, 1 label keys, 2 stamps) x range bins x columns of the workgroup.
uint slot_of(uint kind, uint bin) {
  uint slot = (kind * c.n_range + bin) * kColumns + gl_LocalInvocationID.x;
  return slot;
}
uint scratch_base(uint kinds) { return gl_WorkGroupID.x * kinds * c.n_range * kColumns; }

uint load_slot(uint slot, uint base) {
  return kSharedWords > 1 ? sums[slot] : scratch[base + slot];
}
void store_slot(uint slot, uint base, uint value) {
  if (kSharedWords > 1) sums[slot] = value;
  else scratch[base + slot] = value;
}
void add_to_slot(uint slot, uint base, uint value) {
  if (kLanes == 1) {
    store_slot(slot, base, load_slot(slot, base) + value);
  } else if (kSharedWords > 1) {
    atomicAdd(sums[slot], value);
  } else {
    atomicAdd(scratch[base + slot], value);
  }
}
void max_to_slot(uint slot, uint base, uint value) {
  if (kLanes == 1) {
    store_slot(slot, base, max(load_slot(slot, base), value));
  } else if (kSharedWords > 1) {
    atomicMax(sums[slot], value);
  } else {
    atomicMax(scratch[base + slot], value);
  }
}

// Strongest first, then the smallest label.
uint label_key(float strength, uint label) {
  return max(1u, uint(strength * 65535.0 + 0.5)) << 16 | (65535u - label);
}

// Adds a return of a pixel to its range bin. strength is the incidence term.
void add_return(uint bin, uint base, float strength, ivec3 at) {
  uvec2 label = uvec2(0);
  if (kReflect != 0 || kLabels != 0) label = texelFetch(label_image, at, 0).xy;
  if (kReflect != 0) {
    float reflects = label.y < c.reflectivities ? reflectivity[label.y] : 1.0;
    strength *= clamp(reflects, 0.0, 1.0);
  }
  add_to_slot(slot_of(0, bin), base, uint(strength * c.fixed_scale + 0.5));
  if (kLabels != 0 && strength > 0.0) max_to_slot(slot_of(1, bin), base, label_key(strength, label.x));
}

// Everything a column has heard, to the images.
void write_column(uint column, uint base) {
  for (uint bin = gl_LocalInvocationID.y; bin < c.n_range; bin += kLanes) {
    uint at = bin * c.n_azimuth + column;
    intensity[at] = float(load_slot(slot_of(0, bin), base)) * c.image_scale;
    if (kLabels != 0) {
      uint key = load_slot(slot_of(1, bin), base);
      labels[at] = key == 0 ? 0 : 65535u - (key & 0xffffu);
    }
  }
}

void clear_column(uint kinds, uint base) {
  for (uint i = gl_LocalInvocationID.y; i < kinds * c.n_range; i += kLanes)
    store_slot(slot_of(0, i), base, 0);
}

void wait_for_column() {
  if (kLanes > 1) {
    memoryBarrierBuffer();
    memoryBarrierShared();
    barrier();
  }
}
