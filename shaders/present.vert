#version 460
#extension GL_EXT_multiview : require

layout(location = 0) out vec3 out_uvw;

// A strip of four corners that covers the target and no more, so that nothing is clipped: row 0 is on
// top, the layer is the view's.
void main() {
  vec2 uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
  out_uvw = vec3(uv, float(gl_ViewIndex));
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
}
