// The light of coarser_image at a finer pixel, linear between texels; scale: coarser texels a finer one.
vec3 light_between(ivec3 at, float scale) {
  ivec2 last = imageSize(coarser_image).xy - 1;
  vec2 place = (vec2(at.xy) + 0.5) * scale - 0.5;
  vec2 base = floor(place);
  vec2 part = place - base;
  ivec2 low = clamp(ivec2(base), ivec2(0), last), high = clamp(ivec2(base) + 1, ivec2(0), last);
  vec3 a = imageLoad(coarser_image, ivec3(low, at.z)).rgb;
  vec3 b = imageLoad(coarser_image, ivec3(high.x, low.y, at.z)).rgb;
  vec3 c = imageLoad(coarser_image, ivec3(low.x, high.y, at.z)).rgb;
  vec3 d = imageLoad(coarser_image, ivec3(high, at.z)).rgb;
  return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}
