// One beam of the gather: the G-buffer pixel that a (theta, phi) cell centre hits, its range and
// incidence. kPlane: the beam meets the plane through the pixel's point and normal, else the pixel's own
// range counts. Used after sonar_common.glsl.

// How far the plane may carry the range from the pixel's own, as a factor: beyond, the plane is seen
// so grazing that the neighbouring pixel sees something else, and the pixel's range counts. At half a
// pixel of .1 degrees it is reached at a grazing angle of .2 degrees.
const float kLargestStretch = 1.25;

struct BeamHit {
  ivec3 at;        // pixel and layer
  float range_m;   // 0: nothing is hit
  float strength;  // incidence term, 0 to 1
};

BeamHit beam_hit(SonarColumn s, uint row) {
  BeamHit hit = BeamHit(ivec3(0), 0.0, 0.0);
  vec2 e = texelFetch(rows, ivec2(row, 0), 0).xy;  // tan, sec
  int v = int(floor(c.cy - c.fy * s.sec_theta * e.x));
  if (v < 0 || v >= int(c.height)) return hit;
  hit.at = ivec3(s.pixel, v, s.layer);
  float planar = planar_metres(texelFetch(depth_image, hit.at, 0).r);
  vec3 n = normal_of(hit.at);
  float ty = (c.cy - (float(v) + 0.5)) / c.fy;
  float along_up = dot(n, s.up);
  float along_pixel = dot(n, s.pixel_base) + ty * along_up;
  float length_of = sqrt(s.pixel_square + ty * ty);
  float along = along_pixel;
  if (kPlane != 0) {
    float along_beam = dot(n, s.beam_base) + e.x * s.sec_theta * along_up;
    float stretch = along_pixel / along_beam;
    if (stretch < kLargestStretch && stretch * kLargestStretch > 1.0) {
      planar *= stretch;
      along = along_beam;
      length_of = s.sec_theta * e.y;
    }
  }
  hit.strength = min(facing(-along / length_of), 1.0);
  hit.range_m = planar * length_of;
  return hit;
}

// Unit direction of a beam, in the axes of the normals.
vec3 beam_direction(SonarColumn s, uint row) {
  vec2 e = texelFetch(rows, ivec2(row, 0), 0).xy;
  return (s.beam_base + e.x * s.sec_theta * s.up) / (s.sec_theta * e.y);
}
