// Only for tests/graph: the colour is the depth that the image of the depth test holds here.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(binding = 0) uniform texture2DArray depth;

layout(location = 0) out vec4 color;

void main() {
  color = vec4(texelFetch(depth, ivec3(gl_FragCoord.xy, 0), 0).r, 0.0, 0.0, 1.0);
}
