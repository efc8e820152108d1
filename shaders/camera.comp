#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// A pinhole's exposed radiance as a camera delivers it, in the order of the light's way: lens, vignette,
// photons and read noise (EMVA 1288: variance = electrons + read noise^2; Gaussian, by counters), the
// converter's steps, white balance. Linear. Terms that the scene does not name are not compiled.
#include "shared/camera.h"
#include "shared/lighting.h"
#include "shared/random.glsl"

layout(local_size_x = kShadeGroup, local_size_y = kShadeGroup) in;

layout(set = 0, binding = kCameraHdr) uniform texture2DArray hdr_image;
layout(set = 0, binding = kCameraOut, rgba16f) writeonly uniform image2DArray out_image;
layout(set = 0, binding = kCameraData, scalar) uniform Data { CameraParams camera; };

layout(constant_id = kSpecCameraTerms) const uint kTerms = 0;

vec3 texel(ivec2 at, int layer, ivec2 size) {
  return texelFetch(hdr_image, ivec3(clamp(at, ivec2(0), size - 1), layer), 0).rgb;
}

vec3 bilinear(vec2 px, int layer) {
  ivec2 size = textureSize(hdr_image, 0).xy;
  vec2 at = px - 0.5, low = floor(at), part = at - low;
  ivec2 i = ivec2(low);
  return mix(mix(texel(i, layer, size), texel(i + ivec2(1, 0), layer, size), part.x),
             mix(texel(i + ivec2(0, 1), layer, size), texel(i + ivec2(1, 1), layer, size), part.x), part.y);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(out_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  vec2 image = (vec2(at.xy) + 0.5 - camera.center_px) / camera.focal_px, plane = image;
  vec3 x;
  if ((kTerms & kCameraLens) != 0u) {
    plane = lens_undistort(camera.model, image, camera.k, camera.p);
    x = bilinear(through_port(camera.port, camera.port_offset, plane) * camera.source_focal_px +
                     camera.source_center_px,
                 at.z);
  } else {
    x = texelFetch(hdr_image, at, 0).rgb;
  }
  // cos^4 of the angle off the axis, to the power that is named.
  if ((kTerms & kCameraVignette) != 0u) x *= pow(1.0 + dot(plane, plane), -2.0 * camera.vignette);
  if ((kTerms & kCameraNoise) != 0u) {
    uvec4 bits = hash_of(uvec4(uint(at.y) * uint(size.x) + uint(at.x), camera.frame * 8u + uint(at.z),
                               camera.stream, camera.seed));
    uvec4 more = hash_of(bits ^ uvec4(0x9e3779b9u));
    // complex_normal has a variance of 1/2 in each part.
    vec2 first = complex_normal(bits.xy, 0.0), second = complex_normal(more.xy, 0.0);
    vec3 normal = 1.41421356 * vec3(first, second.x);
    x = clamp(x, vec3(0.0), vec3(camera.saturation));
    vec3 electrons = x * camera.electrons;
    x += normal * sqrt(electrons + camera.read_noise_e * camera.read_noise_e) / camera.electrons;
    float step_size = camera.saturation / camera.steps;
    x = min(round(x / step_size) * step_size, vec3(camera.saturation));
  }
  if ((kTerms & kCameraWhite) != 0u) x *= camera.white;
  imageStore(out_image, at, vec4(min(x, vec3(60000.0)), 1.0));  // as halves hold it
}
