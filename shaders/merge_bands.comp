#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

// Pictures of three bands each, joined by a camera's response.
#include "shared/bands.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kBandOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kBandData, scalar) uniform Data { BandParams params; };
layout(set = 0, binding = kBandIn) uniform texture2DArray first_image;
layout(set = 0, binding = kBandIn + 1) uniform texture2DArray second_image;
layout(set = 0, binding = kBandIn + 2) uniform texture2DArray third_image;
layout(set = 0, binding = kBandIn + 3) uniform texture2DArray fourth_image;
layout(set = 0, binding = kBandIn + 4) uniform texture2DArray fifth_image;

layout(constant_id = kSpecBandPictures) const uint kPictures = 3;

void main() {
  vec3 rows[15];
  [[unroll]] for (uint i = 0u; i < 3u * kPictures; ++i) rows[i] = params.rows[i];
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec3 pictures[5];
  pictures[0] = texelFetch(first_image, at, 0).rgb;
  pictures[1] = texelFetch(second_image, at, 0).rgb;
  pictures[2] = texelFetch(third_image, at, 0).rgb;
  if (kPictures > 3u) pictures[3] = texelFetch(fourth_image, at, 0).rgb;
  if (kPictures > 4u) pictures[4] = texelFetch(fifth_image, at, 0).rgb;
  vec3 sum = vec3(0.0);
  [[unroll]] for (uint i = 0u; i < kPictures; ++i)
    sum += vec3(dot(rows[3u * i], pictures[i]), dot(rows[3u * i + 1u], pictures[i]), dot(rows[3u * i + 2u], pictures[i]));
  imageStore(out_image, at, vec4(clamp(sum, vec3(-60000.0), vec3(60000.0)), 1.0));
}
