// Vertex stage of the geometry G-buffer (depth, normal, label): all that a sonar needs.
// NERITIC_LARGER: some instances are drawn larger than they are (engine/render/least_drawn.hpp).
#include "shared/raster_vertex.glsl"

layout(location = kInstanceLabel) in uint label;
#ifdef NERITIC_LARGER
layout(location = kNextInstanceRow0) in vec4 drawn_row0;
layout(location = kNextInstanceRow1) in vec4 drawn_row1;
layout(location = kNextInstanceRow2) in vec4 drawn_row2;
#endif

void main() {
#ifdef NERITIC_LARGER
  // As far off as it is, in the direction of where it is drawn. Others keep their bits.
  vec3 at = place_vertex();
  vec4 p = vec4(position, 1.0);
  vec3 drawn = vec3(dot(drawn_row0, p), dot(drawn_row1, p), dot(drawn_row2, p));
  if (drawn_row0 != row0 || drawn_row1 != row1 || drawn_row2 != row2) {
    vec3 eye = views[view_index()].eye;
    vec3 way = drawn - eye;
    at = eye + way * (length(at - eye) / max(length(way), 1e-20));
    gl_Position = views[view_index()].clip_from_origin * vec4(at, 1.0);
  }
#else
  place_vertex();
#endif
  out_normal = placed_normal().xyz;
  out_label = label;
}
