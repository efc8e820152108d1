// Normals under an affine map. GLSL only.
#ifndef NERITIC_AFFINE_GLSL
#define NERITIC_AFFINE_GLSL

// n turned by the map with rows r0, r1, r2 (xyz); not of unit length. w: -1 where the map mirrors.
// The cofactor matrix is det * inverse transpose, so a mirroring map (det < 0) needs its sign back.
vec4 turned_normal(vec3 r0, vec3 r1, vec3 r2, vec3 n) {
  vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  float side = dot(r0, c0) < 0.0 ? -1.0 : 1.0;
  return vec4(side * vec3(dot(c0, n), dot(c1, n), dot(c2, n)), side);
}

#endif
