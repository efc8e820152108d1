// Counter-based random numbers: a hash of integers (PCG-style permutation of Jarzynski and Olano, "Hash
// functions for GPU rendering", 2020), so that the same counters give the same number in any order.
uvec4 hash_of(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// In (0, 1).
float unit_open(uint bits) { return (float(bits >> 9) + 0.5) * (1.0 / 8388608.0); }

// A complex normal number of mean power 1, its phase advanced by `turns`.
vec2 complex_normal(uvec2 bits, float turns) {
  float amplitude = sqrt(-log(unit_open(bits.x)));
  float angle = 6.28318530718 * fract(unit_open(bits.y) + turns);
  return amplitude * vec2(cos(angle), sin(angle));
}
