// One beam of the gather: the G-buffer pixel that a (theta, phi) cell's beam hits, its range and
// incidence. kPlane: the beam meets the plane through the pixel's point and normal, else the pixel's own
// range counts. Used after sonar_common.glsl.
//
// A beam is the middle of its cell. Where the view leans (kLeaning) the pixel that tells which surface is there
// lies at a place of the column's width that differs from row to row. With pixels that are shifted from row to
// row too, an upright pole narrower than a pixel is met by as many rows as its width is of one, instead of by
// all or by none. A wider pixel keeps the range of the cell's middle: rows' footprints abut.

// How far the plane may carry the range from the pixel's own, as a factor: beyond, the pixel's range counts, and the
// row's edges are carried so far at most. At half a pixel of 0.1 degrees it is reached at a grazing angle of 0.2 degrees.
const float kLargestStretch = 1.25;
// For surfaces that face sideways more than up or down: a floor goes on, the flank of a pole or of a ball bends away, and
// would have horns of echoes before and behind it.
const float kLargestFlankStretch = 1.005;
const float kSteepestFlank = 8.0;

struct BeamHit {
  ivec3 at;        // pixel and layer
  float range_m;   // 0: nothing is hit
  float strength;  // incidence term, 0 to 1
  vec2 ends_m;     // nearest and farthest range of the row's height (kFootprint)
  vec2 ends_tan;   // tangents of the elevations there
  bool doubtful;   // the plane may be a limb's: hit_of asks again
  bool larger;     // what is hit is drawn larger than it is
  vec3 towards;    // then: the direction of the place itself
};

// A footprint reaches this much farther to one side of the row's centre than to the other, at most:
// on a curved surface's limb the plane goes on, the surface does not.
const float kLopsided = 2.0;

// Half of 1 / p of p = 1.3247..., p^3 = p + 1, in 2^-32: rows spread evenly over a column's width, and over the
// shifts of the pixels' rows too, which follow the golden ratio. Rows as far above the middle one as below it
// look as far to either side, so that all together look at the column's middle.
const uint kHalfRowPlace = 1621087445u;
// A single column may be wider than a view.
const float kWidestPlace_rad = 1.0;

// The column at the place where its row looks for a surface.
SonarColumn column_at(SonarColumn s, uint row) {
  float place = float(int((2u * row + 1u - c.n_elevation) * kHalfRowPlace)) / 4294967296.0;
  float angle = clamp(place * c.azimuth_step_rad, -kWidestPlace_rad, kWidestPlace_rad);
  float square = angle * angle;
  float turn = angle * (1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0)));  // its tangent
  s.tan_theta = (s.tan_theta + turn) / max(1.0 - s.tan_theta * turn, 0.25);
  s.sec_theta = sqrt(1.0 + s.tan_theta * s.tan_theta);
  return s;
}

// The pixel of a row of pixels that the direction of tangent t of elevation meets. Half a column may lie
// beside the view.
SonarColumn at_pixel(SonarColumn s, int v, float t) {
  float u = floor(c.cx + c.fx * (s.tan_theta - c.lean * s.sec_theta * t));
  s.pixel = int(clamp(u, 0.0, float(c.width - 1)));
  s.pixel_tan = (float(s.pixel) + 0.5 - c.cx) / c.fx + c.lean * (c.cy - (float(v) + 0.5)) / c.fy;
  return s;
}

// Range of what the pixel at a row's centre sees, of tangent t of elevation, and its row of pixels; 0: nothing.
float centre_range(SonarColumn s, float t, out int v) {
  v = int(floor(c.cy - c.fy * s.sec_theta * t));
  if (v < 0 || v >= int(c.height)) return 0.0;
  if (kLeaning != 0) s = at_pixel(s, v, t);
  float ty = (c.cy - (float(v) + 0.5)) / c.fy;
  float planar = planar_metres(depth_at(ivec3(s.pixel, v, s.layer)));
  return planar * sqrt(1.0 + s.pixel_tan * s.pixel_tan + ty * ty);
}

// The offset of another row; 0 also means: it is the same row of pixels.
float neighbour_range(SonarColumn s, int row, int v) {
  if (row < 0 || row >= int(c.n_elevation)) return 0.0;
  int other;
  float range_m = centre_range(s, texelFetch(rows, ivec2(row, 0), 0).x, other);
  return other == v ? 0.0 : range_m;
}

// How far from the centre's range the plane is at the row's edge of tangent t: no farther than the
// neighbour's range where that lies to the same side.
float edge_reach(SonarColumn s, float t, float planar, float along_edge, float along_pixel, float range_m,
                 float neighbour_m) {
  float inverse = clamp(along_edge / along_pixel, 1.0 / kLargestStretch, kLargestStretch);
  float reach = planar / inverse * s.sec_theta * sqrt(1.0 + t * t) - range_m;
  float limit = neighbour_m - range_m;
  if (!(neighbour_m > 0.0) || reach * limit <= 0.0) return reach;
  return reach > 0.0 ? min(reach, limit) : max(reach, limit);
}

// Seen more grazing than this (range over height; 86.4 degrees of incidence), or carried farther than this from the
// pixel's own range, a plane may be a limb's, where the surface does not go on: the neighbouring pixel tells.
const float kGrazing = 16.0;
const float kFarCarried = 0.005;
const float kFarthest_m = 1e9;

// How far the pixel beside this one lies from it, in planar metres and in range, if no farther than the plane of this one
// says or half as much again: else something else is there, and it is 0.
vec2 step_to(SonarColumn s, int v, ivec2 beside, float planar, float range_m, vec3 normal, float along_pixel) {
  ivec2 other = ivec2(s.pixel, v) + beside;
  float ty = (c.cy - (float(other.y) + 0.5)) / c.fy;
  float tx = s.pixel_tan + float(beside.x) / c.fx - c.lean * float(beside.y) / c.fy;
  float there = planar_metres(depth_at(ivec3(other, s.layer)));
  float expected = planar * along_pixel / (normal.z + tx * normal.x + ty * normal.y);
  if (!(there > 0.0 && abs(there - planar) <= 1.5 * abs(expected - planar))) return vec2(0.0);
  return abs(vec2(there - planar, there * sqrt(1.0 + tx * tx + ty * ty) - range_m));
}

// So far a plane seen at grazing may go on beyond its pixel on the beam's side: to the next pixel, or where that shows
// something else, as far as a quarter of a pixel goes on the other side.
vec2 farthest_step(SonarColumn s, int v, ivec2 beside, float planar, float range_m, vec3 normal, float along_pixel) {
  ivec2 other = ivec2(s.pixel, v) + beside, size = ivec2(c.width, c.height);
  if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) beside = -beside;
  vec2 to_next = step_to(s, v, beside, planar, range_m, normal, along_pixel);
  vec2 behind = step_to(s, v, -beside, planar, range_m, normal, along_pixel);
  return to_next.x > 0.0 ? to_next : 0.25 * behind;
}

// Where the plane meets the edges of a row that is lower than a bin: by how the range r goes with the tangent t of the
// elevation at its centre, d ln r / dt = t / (1 + t^2) - sec along_up / along. At grazing r goes with 1 / along, so that
// the far edge lies farther from the centre than the near one, and rows abut.
void find_close_ends(SonarColumn s, vec4 row, float along, float along_up, float most_m, inout BeamHit hit) {
  float steep = row.x / (row.y * row.y) - s.sec_theta * along_up / along;
  float reach = min(0.5 * (row.w - row.z) * abs(steep), 1.0 - 1.0 / kLargestStretch);
  hit.ends_m = hit.range_m / (1.0 + vec2(reach, -reach));
  hit.ends_m = clamp(hit.ends_m, vec2(hit.range_m - most_m), vec2(hit.range_m + most_m));
  hit.ends_tan = steep >= 0.0 ? row.zw : row.wz;
}

// Where the plane meets the lower and the upper edge of the row. neighbours_m: neighbour_range of the rows there.
void find_ends(SonarColumn s, vec2 neighbours_m, vec2 edges, bool limb, float planar, vec2 along_edges,
               float along_pixel, inout BeamHit hit) {
  float low = edge_reach(s, edges.x, planar, along_edges.x, along_pixel, hit.range_m, neighbours_m.x);
  float high = edge_reach(s, edges.y, planar, along_edges.y, along_pixel, hit.range_m, neighbours_m.y);
  float most = limb ? 0.0 : kLopsided * min(abs(low), abs(high));
  low = clamp(low, -most, most);
  high = clamp(high, -most, most);
  bool rising = low <= high;
  hit.ends_m = hit.range_m + vec2(min(min(low, high), 0.0), max(max(low, high), 0.0));
  hit.ends_tan = rising ? edges : edges.yx;
}

// A footprint is shared out over no more bins to either side of its centre: what one row may cost.
const float kFarthestShare_bins = 2048.0;

float bin_at(float range_m) { return (range_m - c.range_min_m) * c.bins_per_m + c.edge_bias_bins; }
float range_at(int bin) { return (float(bin) - c.edge_bias_bins) * c.bin_m + c.range_min_m; }

// How a row's whole is shared out over the bins that it spans: evenly where the row is lower than a bin; else, seen at
// grazing, elevation goes with 1 / range, and so does the incidence.
struct Share {
  vec2 ends;    // in bins where it is even, else in metres
  ivec2 bins;   // first and last, which may lie beside the image
  float scale;  // for part_below, the same for all bins
  float whole;
};

Share share_of(vec2 ends_m, float whole) {
  vec2 ends_bins = vec2(bin_at(ends_m.x), bin_at(ends_m.y));
  Share share = Share(ends_bins, ivec2(floor(ends_bins)), whole / (ends_bins.y - ends_bins.x), whole);
  if (kFootprint == kSonarFootprintShared) return share;
  share.ends = ends_m;
  share.scale = whole / (ends_m.y - ends_m.x) * ends_m.y * ends_m.y / (ends_m.y + ends_m.x);
  return share;
}

// The part of a row's total that comes from below a bin.
float part_below(Share share, int bin) {
  if (kFootprint == kSonarFootprintShared) return clamp((float(bin) - share.ends.x) * share.scale, 0.0, share.whole);
  float r = clamp(range_at(bin), share.ends.x, share.ends.y);
  return clamp((r - share.ends.x) * (r + share.ends.x) / (r * r) * share.scale, 0.0, share.whole);
}

// A shorter footprint is shared out as its centre: where fewer than n rows fill a bin, bins would ripple by 1 / n.
const float kShortest_bins = 0.02;

vec2 shared_ends(vec2 ends_m, float range_m) {
  if ((ends_m.y - ends_m.x) * c.bins_per_m < kShortest_bins) return vec2(range_m);
  if (kFootprint == kSonarFootprintShared) return ends_m;  // no farther than kLargestStretch goes
  float most = kFarthestShare_bins * c.bin_m;
  return clamp(ends_m, vec2(range_m - most), vec2(range_m + most));
}

// The contents of a beam's pixel. Apart from what follows from it, so that two rows' are fetched together.
struct Look {
  vec4 row;       // tan, sec, tan of the edges
  vec4 surface;   // surface_at
  int pixel, v;   // beside the view nothing is seen, for a texel there is zero
  float pixel_tan;
  int centre_v;   // kInTurn: what centre_range tells of the row
  float centre_m;
};

// For rows whose footprints are bounded by their neighbours'. A thread that processes all rows in turn keeps the
// neighbours' ranges.
const bool kBounded = kFootprint == kSonarFootprintBounded;
const bool kInTurn = kBounded && kLanes == 1;

Look look_at(SonarColumn s, uint row) {
  Look look;
  SonarColumn upright = s;
  look.row = texelFetch(rows, ivec2(row, 0), 0);
  look.v = int(floor(c.cy - c.fy * s.sec_theta * look.row.x));
  if (kLeaning != 0) {
    SonarColumn aside = column_at(s, row);
    look.v = int(clamp(floor(c.cy - c.fy * aside.sec_theta * look.row.x), 0.0, float(c.height - 1)));
    s = at_pixel(aside, look.v, look.row.x);
  }
  look.pixel = s.pixel;
  look.pixel_tan = s.pixel_tan;
  look.surface = surface_at(ivec3(s.pixel, look.v, s.layer));
  if (kInTurn && kLeaning != 0) {
    look.centre_m = centre_range(upright, look.row.x, look.centre_v);
  } else if (kInTurn) {
    float ty = (c.cy - (float(look.v) + 0.5)) / c.fy;
    look.centre_m = planar_metres(look.surface.w) * sqrt(1.0 + s.pixel_tan * s.pixel_tan + ty * ty);
    look.centre_v = look.v;
  }
  return look;
}

vec2 neighbour_ranges(SonarColumn s, uint row, int v) {
  return kBounded ? vec2(neighbour_range(s, int(row) - 1, v), neighbour_range(s, int(row) + 1, v)) : vec2(0.0);
}

// neighbour_ranges from the looks before and after the row's if the thread has kept them; beyond the first and the last
// row any look will do.
vec2 ranges_beside(SonarColumn s, uint row, Look before, Look look, Look after) {
  if (!kInTurn) return neighbour_ranges(s, row, look.v);
  bool below = row > 0 && before.centre_v != look.v;
  bool above = row + 1 < c.n_elevation && after.centre_v != look.v;
  return vec2(below ? before.centre_m : 0.0, above ? after.centre_m : 0.0);
}

BeamHit no_hit() { return BeamHit(ivec3(0), 0.0, 0.0, vec2(0.0), vec2(0.0), false, false, vec3(0.0)); }

// neighbours_m: neighbour_ranges, where footprints are bounded. again: where it is doubtful the neighbouring pixel is
// asked.
BeamHit hit_of(SonarColumn s, Look look, vec2 neighbours_m, bool again) {
  BeamHit hit = no_hit();
  s.pixel = look.pixel;
  s.pixel_tan = look.pixel_tan;
  vec4 e = look.row;
  int v = look.v;
  hit.at = ivec3(s.pixel, v, s.layer);
  float planar = planar_metres(look.surface.w);
  vec3 n = normal_of(look.surface);
  float ty = (c.cy - (float(v) + 0.5)) / c.fy;
  float along_up = dot(n, s.up);
  float ahead = dot(n, s.forward), sideways = dot(n, s.right);
  float along_pixel = ahead + s.pixel_tan * sideways + ty * along_up;
  float length_of = sqrt(1.0 + s.pixel_tan * s.pixel_tan + ty * ty);
  float along = along_pixel;
  float plane = planar;  // of the pixel
  bool larger = is_larger(hit.at);  // its slope is that of the thing itself, which does not go on so far
  bool flank = abs(sideways) > abs(along_up);
  float most_m = kFarthest_m;  // that the row's ends may lie from its centre; 0 of a limb
  if (kPlane != 0 && !larger) {
    float along_beam = ahead + s.tan_theta * sideways + e.x * s.sec_theta * along_up;
    float stretch = along_pixel / along_beam;
    float largest = flank ? kLargestFlankStretch : kLargestStretch;
    bool meets = stretch < largest && stretch * largest > 1.0;
    bool grazing = abs(along_up) > (flank ? kSteepestFlank : kGrazing) * abs(along_pixel);
    if (grazing && (flank || !meets)) most_m = 0.0;
    hit.doubtful = meets && !flank && (grazing || abs(stretch - 1.0) > kFarCarried);
    if (again && hit.doubtful) {
      vec3 normal = vec3(sideways, along_up, ahead);
      ivec2 along_row = ivec2(s.tan_theta > s.pixel_tan ? 1 : -1, 0);
      ivec2 along_column = ivec2(0, e.x * s.sec_theta > ty ? -1 : 1);
      vec2 across = farthest_step(s, v, along_row, planar, planar * length_of, normal, along_pixel);
      vec2 up = farthest_step(s, v, along_column, planar, planar * length_of, normal, along_pixel);
      float most = (across.x + up.x) / planar;
      stretch = clamp(stretch, 1.0 - most, 1.0 + most);
      most_m = up.y;
    }
    if (meets) {
      planar *= stretch;
      along = along_beam;
      length_of = s.sec_theta * e.y;
    }
  }
  hit.strength = min(facing(-along / length_of), 1.0);
  hit.range_m = planar * length_of;
  if (kFootprint == kSonarFootprintShared)
    find_close_ends(s, e, along, along_up, most_m, hit);
  if (kFootprint == kSonarFootprintBounded)
    find_ends(s, neighbours_m, e.zw, most_m == 0.0, plane,
              ahead + s.tan_theta * sideways + e.zw * s.sec_theta * along_up, along_pixel, hit);
  if (larger) {
    hit.larger = true;
    hit.towards = true_direction(hit.at, (s.forward + s.pixel_tan * s.right + ty * s.up) / length_of, hit.range_m);
    hit.strength = min(facing(-dot(n, hit.towards)), 1.0);
    hit.ends_m = vec2(hit.range_m);
  }
  // Sound does not leave the water.
  float above_m = hit.larger ? hit.towards.y * hit.range_m
                             : plane * (s.forward.y + s.pixel_tan * s.right.y + ty * s.up.y);
  if (above_m > c.surface_m) return no_hit();
  return hit;
}

BeamHit beam_hit(SonarColumn s, Look look, vec2 neighbours_m) {
  BeamHit hit = hit_of(s, look, neighbours_m, false);
  // A loop, since a processor's driver skips one that no lane enters.
  for (bool again = hit.doubtful; again; again = false) hit = hit_of(s, look, neighbours_m, true);
  return hit;
}

// Unit direction of a beam, in the axes of the normals: of a tangent of elevation, of a row's centre.
vec3 beam_towards(SonarColumn s, float t) {
  return (s.beam_base + t * s.sec_theta * s.up) / (s.sec_theta * sqrt(1.0 + t * t));
}
vec3 beam_direction(SonarColumn s, uint row) {
  vec2 e = texelFetch(rows, ivec2(row, 0), 0).xy;
  return (s.beam_base + e.x * s.sec_theta * s.up) / (s.sec_theta * e.y);
}
