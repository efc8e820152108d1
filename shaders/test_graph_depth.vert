// Only for tests/graph: one triangle over the whole picture; its depth goes from 0 at the left edge
// to 1 at the right one.
#version 460

void main() {
  const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);  // 0 to 2
  gl_Position = vec4(corner * 2.0 - 1.0, corner.x, 1.0);
}
