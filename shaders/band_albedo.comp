#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// A G-buffer's albedo as reflectances of the red, green and blue third of the spectrum, between 0 and 1.
#include "shared/bands.h"
#include "shared/lighting.h"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kBandOut, rgba8) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kBandData, scalar) uniform Data { BandParams params; };
layout(set = 0, binding = kBandIn) uniform texture2DArray albedo_image;

void main() {
  vec3 red = params.rows[0], green = params.rows[1], blue = params.rows[2];
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  // The image holds square roots.
  vec4 held = texelFetch(albedo_image, at, 0);
  vec3 rgb = held.rgb * held.rgb;
  vec3 bands = clamp(vec3(dot(red, rgb), dot(green, rgb), dot(blue, rgb)), vec3(0.0), vec3(1.0));
  imageStore(out_image, at, vec4(sqrt(bands), held.a));
}
