// A pixel's motion and a row's time of exposure, for the shutter's passes. A pass that includes it declares
// motion_image and shutter before. GLSL only.
#ifndef NERITIC_SHUTTER_GLSL
#define NERITIC_SHUTTER_GLSL

// A point that will be behind the camera counts as still.
vec2 motion_at(ivec3 at) {
  vec2 motion = texelFetch(motion_image, at, 0).xy;
  return any(isnan(motion)) || any(isinf(motion)) ? vec2(0.0) : motion;
}

// The way of a point by a time, pixels.
vec2 way_of(vec2 motion, float time) {
  vec2 way = motion * time;
  float far_px = length(way);
  return far_px > shutter.farthest_px ? way * (shutter.farthest_px / far_px) : way;
}

// Whether two ways are of one surface, whose motion changes little from pixel to pixel. Short ways may differ by less,
// since an edge that moves by a third of a pixel is still an edge.
float allowed_px(float way_px) { return max(0.35 * way_px, 0.05); }
bool same_way(vec2 a, vec2 b) {
  return distance(a, b) < min(allowed_px(max(length(a), length(b))), kSameMotion_px);
}

// The share of the sensor's rows above that of a point of the picture.
float row_share(vec2 share) {
  if (shutter.by_lens == 0u) return share.y;
  vec2 at = clamp(share, 0.0, 1.0) * float(kRowSteps), low = min(floor(at), vec2(float(kRowSteps - 1u))), part = at - low;
  uint i = uint(low.y) * (kRowSteps + 1u) + uint(low.x);
  return mix(mix(shutter.row[i], shutter.row[i + 1u], part.x),
             mix(shutter.row[i + kRowSteps + 1u], shutter.row[i + kRowSteps + 2u], part.x), part.y);
}

// When the middle of a row's exposure is, against the frame's instant; in times to the next frame.
float row_time(vec2 share) { return shutter.readout * (row_share(share) - 0.5); }

#endif
