// Smooth noise in [0, 1) on a plane. GLSL only.
float noise(vec2 p, uint seed) {
  vec2 cell = floor(p), part = p - cell;
  part = part * part * (3.0 - 2.0 * part);
  float corners[4];
  for (int i = 0; i < 4; ++i) {
    uvec2 c = uvec2(ivec2(cell) + ivec2(i & 1, i >> 1));
    uint h = (c.x * 1664525u + c.y * 22695477u + seed) * 2654435769u;
    h ^= h >> 15;
    h *= 2246822519u;
    corners[i] = float(h >> 8) * (1.0 / 16777216.0);
  }
  return mix(mix(corners[0], corners[1], part.x), mix(corners[2], corners[3], part.x), part.y);
}
