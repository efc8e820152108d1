// The words that the gathers sum into, [n_range][n_azimuth], with terms two each; all are cleared before. They lie in
// storage buffers. With kTexels they are read and written as texels of the same buffers, one thread owning a place: a
// processor's driver loads a storage buffer lane by lane, through memory, and fetches texels by one instruction.
layout(constant_id = kSonarSpecTexels) const uint kTexels = 0;

layout(set = 0, binding = kSonarBindSums, scalar) buffer Sums { uint sums[]; };
layout(set = 0, binding = kSonarBindKeys, scalar) buffer Keys { uint keys[]; };
layout(set = 0, binding = kSonarBindScratch, scalar) buffer Scratch { uint scratch[]; };
layout(set = 0, binding = kSonarBindSumTexels, r32ui) uniform uimageBuffer sum_texels;
layout(set = 0, binding = kSonarBindKeyTexels, r32ui) uniform uimageBuffer key_texels;
layout(set = 0, binding = kSonarBindScratchTexels, r32ui) uniform uimageBuffer scratch_texels;

uint sum_at(uint at) {
  if (kTexels != 0) return imageLoad(sum_texels, int(at)).x;
  return sums[at];
}

void set_sum(uint at, uint word) {
  if (kTexels != 0) imageStore(sum_texels, int(at), uvec4(word));
  else sums[at] = word;
}

uint key_at(uint at) {
  if (kTexels != 0) return imageLoad(key_texels, int(at)).x;
  return keys[at];
}

void set_key(uint at, uint word) {
  if (kTexels != 0) imageStore(key_texels, int(at), uvec4(word));
  else keys[at] = word;
}

uint scratch_at(uint at) {
  if (kTexels != 0) return imageLoad(scratch_texels, int(at)).x;
  return scratch[at];
}

void set_scratch(uint at, uint word) {
  if (kTexels != 0) imageStore(scratch_texels, int(at), uvec4(word));
  else scratch[at] = word;
}
