// Vertex stage of the geometry G-buffer (depth, normal, label): all that a sonar needs.
#include "shared/raster_vertex.glsl"

layout(location = kInstanceLabel) in uint label;

void main() {
  place_vertex();
  out_normal = placed_normal().xyz;
  out_label = label;
}
