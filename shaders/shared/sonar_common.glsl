// Shared by both sonar gathers: read a pixel of the G-buffer, sum into a column's range bins.
// Integers only are summed, so the order of addition cannot change a bit.
#include "shared/octahedral.h"
#include "shared/sonar.h"

layout(constant_id = kSonarSpecColumns) const uint kColumns = 8;
layout(constant_id = kSonarSpecLanes) const uint kLanes = 1;
layout(constant_id = kSonarSpecPlane) const uint kPlane = 1;
layout(constant_id = kSonarSpecPacked) const uint kPacked = 0;
layout(constant_id = kSonarSpecFacing) const uint kFacing = 1;
layout(constant_id = kSonarSpecReflect) const uint kReflect = 0;
layout(constant_id = kSonarSpecLabels) const uint kLabels = 1;
layout(constant_id = kSonarSpecFootprint) const uint kFootprint = 0;
layout(constant_id = kSonarSpecLeaning) const uint kLeaning = 0;
layout(constant_id = kSonarSpecLarger) const uint kLarger = 0;
layout(local_size_x_id = kSonarSpecColumns, local_size_y_id = kSonarSpecLanes) in;

layout(set = 0, binding = kSonarBindColumns, scalar) readonly buffer Columns { SonarColumn columns[]; };
layout(set = 0, binding = kSonarBindRows) uniform texture2D rows;
layout(set = 0, binding = kSonarBindDepth) uniform texture2DArray depth_image;
layout(set = 0, binding = kSonarBindNormal) uniform texture2DArray normal_image;
layout(set = 0, binding = kSonarBindLabel) uniform utexture2DArray label_image;
layout(set = 0, binding = kSonarBindReflectivity, scalar) readonly buffer Reflectivity { float reflectivity[]; };
layout(set = 0, binding = kSonarBindLarger, scalar) readonly buffer Larger { SonarDrawnLarger drawn_larger[]; };
layout(push_constant, scalar) uniform Push { SonarPush pushed; };
// main copies it at its start: within loops a processor's driver would load it anew each time, lane by lane.
SonarPush c;

#include "shared/sonar_words.glsl"

// The contents of a pixel: its normal (x, y, z, or two of an octahedron), then its depth. Zero beside the images.
vec4 surface_at(ivec3 at) {
  vec4 texel = texelFetch(normal_image, at, 0);
  return kPacked != 0 ? texel : vec4(texel.xy, 0.0, texelFetch(depth_image, at, 0).r);
}

float depth_at(ivec3 at) {
  return kPacked != 0 ? texelFetch(normal_image, at, 0).w : texelFetch(depth_image, at, 0).r;
}

// Planar metres of a stored depth; 0 where nothing is hit (cleared, NaN, infinite, negative).
float planar_metres(float depth) {
  float metres = kPacked != 0 ? depth : c.near_m / depth;
  return depth > 0.0 && metres < 3.0e38 ? metres : 0.0;
}

// Unit normal; zero length where the image says that it is unknown.
vec3 normal_of(vec4 surface) {
  return kPacked != 0 ? surface.xyz : octahedral_decode(surface.xy);
}

vec3 normal_at(ivec3 at) { return normal_of(texelFetch(normal_image, at, 0)); }

float facing(float cosine) { return kFacing != 0 ? max(cosine, 0.0) : abs(cosine); }

// Strongest first, then the smallest label.
uint label_key(float strength, uint label) {
  return max(1u, uint(strength * 65535.0 + 0.5)) << 16 | (65535u - label);
}

// Whether what a pixel shows is drawn larger than it is.
bool is_larger(ivec3 at) {
  if (kLarger == 0) return false;
  uint instance = texelFetch(label_image, at, 0).y;
  return instance < c.reflectivities && reflectivity[instance] < 0.0;
}

// The entry of an instance in the table of what is drawn larger; as many as there are: it has none.
uint larger_of(uint instance) {
  uint low = 0, high = c.drawn_larger;
  while (low < high) {
    uint middle = (low + high) / 2;
    if (drawn_larger[middle].label < instance) low = middle + 1;
    else high = middle;
  }
  return low < c.drawn_larger && drawn_larger[low].label == instance ? low : c.drawn_larger;
}

// The direction of the place that a pixel shows at a range, of something drawn larger than it is.
vec3 true_direction(ivec3 at, vec3 drawn, float range_m) {
  uint entry = larger_of(texelFetch(label_image, at, 0).y);
  if (entry == c.drawn_larger || !(range_m > 0.0)) return drawn;
  vec3 along = drawn_larger[entry].true_from_drawn * drawn, offset_m = drawn_larger[entry].offset_m;
  float square = dot(along, along), half_linear = dot(along, offset_m);
  float root = half_linear * half_linear - square * (dot(offset_m, offset_m) - range_m * range_m);
  return normalize((sqrt(max(root, 0.0)) - half_linear) / square * along + offset_m);
}

// The incidence term times the reflectivity of the pixel's instance; gives the label too.
float reflected(float strength, ivec3 at, out uvec2 label) {
  label = uvec2(0);
  if (kReflect != 0 || kLabels != 0) label = texelFetch(label_image, at, 0).xy;
  if (kReflect == 0) return strength;
  float reflects = label.y < c.reflectivities ? reflectivity[label.y] : 1.0;
  if (kLarger != 0) reflects = abs(reflects);
  return strength * clamp(reflects, 0.0, 1.0);
}

// The greater of two keys stays.
void add_to_key(uint cell, uint key) {
  if (kLanes > 1) atomicMax(keys[cell], key);
  else if (key > key_at(cell)) set_key(cell, key);
}

// Adds to a cell of the image. Where one thread owns a column no other writes there, and a processor is
// spared its slow atomics.
void add_counts(uint cell, uint counts, float strength, uint label) {
  if (kLanes == 1) set_sum(cell, sum_at(cell) + counts);
  else atomicAdd(sums[cell], counts);
  if (kLabels != 0 && strength > 0.0) add_to_key(cell, label_key(strength, label));
}

void add_return(uint cell, float strength, ivec3 at) {
  uvec2 label;
  strength = reflected(strength, at, label);
  add_counts(cell, uint(strength * c.fixed_scale + 0.5), strength, label.x);
}
