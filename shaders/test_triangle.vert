// For tests/gpu: a triangle from two vertex streams, moved by one pushed offset a view.
#version 460
#extension GL_EXT_multiview : require
#extension GL_EXT_scalar_block_layout : require
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 instance_color;
layout(location = 0) out vec4 color;
layout(push_constant, scalar) uniform Push { float offset_x[2]; uint burn_steps; };

void main() {
  gl_Position = vec4(position.x + offset_x[gl_ViewIndex], position.yz, 1.0);
  color = instance_color;
}
