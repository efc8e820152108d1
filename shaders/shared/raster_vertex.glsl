// Shared by all vertex stages of the raster passes: the streams that place a vertex, the views, and its place.
// NERITIC_CLIPPED: of views of one side of a plane. NERITIC_DEPTH: places alone, no normals and labels.
#include "shared/octahedral.h"
#include "shared/raster.h"
#include "shared/affine.glsl"

layout(constant_id = kSpecMultiview) const bool kMultiview = true;

layout(location = 0) in vec3 position;
#ifndef NERITIC_DEPTH
layout(location = 1) in vec2 normal;
#endif
layout(location = kInstanceRow0) in vec4 row0;
layout(location = kInstanceRow1) in vec4 row1;
layout(location = kInstanceRow2) in vec4 row2;

layout(set = 0, binding = kRasterViews, scalar) uniform Views { View views[kMaxViews]; };

#ifndef NERITIC_DEPTH
layout(location = 0) out vec3 out_normal;
layout(location = 1) flat out uint out_label;
#endif

#ifdef NERITIC_CLIPPED
out float gl_ClipDistance[1];
#endif

int view_index() { return kMultiview ? gl_ViewIndex : 0; }

// Writes where the vertex is drawn; returns where it is, from the views' origin.
vec3 place_vertex() {
  int view = view_index();
  vec4 p = vec4(position, 1.0);
  vec3 at = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  gl_Position = views[view].clip_from_origin * vec4(at, 1.0);
#ifdef NERITIC_CLIPPED
  gl_ClipDistance[0] = dot(views[view].within, vec4(at, 1.0));
#endif
  gl_PointSize = 1.0;
  return at;
}

#ifndef NERITIC_DEPTH
// xyz: the normal of the placed vertex; w: see turned_normal.
vec4 placed_normal() { return turned_normal(row0.xyz, row1.xyz, row2.xyz, octahedral_decode(normal)); }
#endif
