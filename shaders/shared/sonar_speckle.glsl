// Speckle: what a column's powers, bin by bin, become: amplitudes of the world's scatterers. Used after the echo's
// uniform and the bins' geometry (sonar_beam.glsl).

// Scatterers are parts of cells of a lattice of the world, each with amplitudes that are its own for ever. A
// cell is as large as what beams sample there asks for. Seen from the sonar it is cut into slices, counted from
// its centre, so that they are the world's too: a bin deep along range, a column wide across. A bin's edge cuts
// a slice in two, so a bin hears an even and an odd one.
// Rows only sum power (note): a slice may be met by rows far apart, between which others are met, and amplitudes
// of its own number summed row by row would add up to more than their power. Amplitudes come after all rows, once
// a slice (sound_column).
// No two columns and no two bins share an amplitude (else the taps of pattern and pulse would add N of them to
// N^2 power): a slice's centre says which column hears it; and one that a bin's edge cuts gives either bin a
// part of its own (parts_of). So as the sonar moves, the picture of speckle moves with the world, along range and
// across.
struct Cell {
  ivec3 world;  // its index in the world's lattice of its level, modulo 2^32
  uint level;   // doublings of the finest lattice, or kNoLevel
  vec3 center;  // from the eye
  float bin;    // of the centre, as heard
};
const uint kNoLevel = 0xffffffffu;

// Scratch is [n_range][n_azimuth][2], a bin's power while rows are summed: the float's bits, then two parts of 65535: of
// what odd slices gave, and of the rows' number of the place where it comes from, on average.

uint level_at(float range_m) {
  return uint(clamp(ceil(log2(max(echo.least_cells, range_m * echo.cells_per_range))), 0.0, 24.0));
}

ivec3 cell_at(vec3 point, uint level) {
  return (ivec3(floor(point * echo.cells_per_m + echo.cell_fraction)) + ivec3(echo.origin_cell)) >> int(level);
}

vec3 center_of(ivec3 cell, uint level) {
  ivec3 from_origin = (cell << int(level)) - ivec3(echo.origin_cell);
  return (vec3(from_origin) + 0.5 * float(1u << level) - echo.cell_fraction) / echo.cells_per_m;
}

// Half of the way there and back.
float path_to(vec3 point) {
  float path_m = length(point);
  return kGhost != 0 ? 0.5 * (path_m + length(point - echo.ghost_source)) : path_m;
}

Cell cell_of(vec3 point, float heard_over_path) {
  uint level = level_at(length(point));
  ivec3 world = cell_at(point, level);
  vec3 center = center_of(world, level);
  return Cell(world, level, center, bin_at(heard_over_path * path_to(center)));
}

// A bin's amplitudes fit 31 bits but by a chance below e^-64 (gather.cpp), or where a texture's patch is
// brighter still: then it is at its limit.
const float kMostCounts = 1073741824.0;
int saturated_sum(int a, int b) {
  int sum = a + b;
  if (((a ^ sum) & (b ^ sum)) < 0) return a < 0 ? -2147483647 : 2147483647;
  return sum;
}

void add_amplitude(int bin, uint column, vec2 z) {
  ivec2 counts = ivec2(round(clamp(z * echo.sum_scale, vec2(-kMostCounts), vec2(kMostCounts))));
  uint cell = 2 * (uint(bin) * c.n_azimuth + column);
  set_sum(cell, uint(saturated_sum(int(sum_at(cell)), counts.x)));
  set_sum(cell + 1, uint(saturated_sum(int(sum_at(cell + 1)), counts.y)));
}

// A row's power that lies in one bin, at a point of the column's middle. place: of the point, in rows. ends: in
// bins. heard_over_path: of ranges.
void note(uint column, vec3 point, float place, float heard_over_path, vec2 ends, int bin, float power) {
  float center = cell_of(point, heard_over_path).bin;
  float from = ends.x - center + 0.5, upto = ends.y - center + 0.5;
  float high = floor(upto);
  float nearer = high > floor(from) ? clamp((high - from) / (upto - from), 0.0, 1.0) : 0.0;
  float odd = (int(high) & 1) != 0 ? 1.0 - nearer : nearer;
  uint cell = 2 * (uint(bin) * c.n_azimuth + column);
  uvec2 before = uvec2(scratch_at(cell), scratch_at(cell + 1));
  vec2 mean = unpackUnorm2x16(before.y);
  float sum = uintBitsToFloat(before.x) + power;
  mean += (vec2(odd, place / float(c.n_elevation)) - mean) * (power / sum);
  set_scratch(cell, floatBitsToUint(sum));
  set_scratch(cell + 1, packUnorm2x16(mean));
}

// The cell that a bin's power comes from, of a part of all rows.
Cell cell_heard(SonarColumn s, int bin, float place) {
  place *= float(c.n_elevation);
  float row = clamp(floor(place), 0.0, float(c.n_elevation - 1));
  vec2 edges = texelFetch(rows, ivec2(row, 0), 0).zw;
  vec3 eye = beam_towards(s, mix(edges.x, edges.y, place - row));
  float heard_m = range_at(bin) + 0.5 / c.bins_per_m, path_m = heard_m, range_m = heard_m;
  float heard_over_path = 1.0;
  // Heard over true range changes so little with range that twice is enough.
  for (int i = 0; i < (kCorrected != 0 || kMoving != 0 ? 2 : 0); ++i) {
    Legs legs = legs_of_path(eye, path_m, range_m);
    heard_over_path = max(heard_of(legs, path_m) / path_m, 1e-3);
    path_m = heard_m / heard_over_path;
  }
  legs_of_path(eye, path_m, range_m);
  return cell_of(eye * range_m, heard_over_path);
}

// Directions across either axis that count as different: about 5 degrees.
const float kAsides = 12.0;

// Two numbers of a slice, complex normal, of mean power 1 (but for the texture).
void numbers_of(SonarColumn s, Cell cell, int slice, out vec2 z, out vec2 w) {
  vec3 ahead = normalize(s.beam_base), right = cross(ahead, s.up);
  vec3 center = cell.center;
  vec2 flat_m = vec2(dot(center, right), dot(center, ahead));
  // The cell's centre, in columns from this column's middle, and the slice that is heard here.
  float across = atan(flat_m.x, flat_m.y) / echo.column_rad;
  int place = int(ceil(-0.5 - across));
  // It lies so far across from the centre: along a direction of the world, which the path's phase is counted by.
  vec3 aside = normalize(round(kAsides * normalize(flat_m.y * right - flat_m.x * ahead)));
  vec3 point = center + aside * (float(place) * echo.column_rad * length(flat_m));
  point *= 1.0 + float(slice) / (c.bins_per_m * max(length(center), 1e-6));
  float amplitude = 1.0;
  if (kTextured != 0) {
    uvec3 patch_cell = uvec3(ivec3(floor(point * echo.patches_per_m + echo.patch_fraction))) + echo.origin_patch;
    uint entries = uint(textureSize(gamma_quantiles, 0).x);
    uint entry = hash_of(uvec4(patch_cell, echo.seed + 1u)).x % entries;
    amplitude = sqrt(texelFetch(gamma_quantiles, ivec2(entry, 0), 0).r);
  }
  uint part = 0x9e3779b9u * cell.level + 0x85ebca6bu * uint(slice) + 0xc2b2ae35u * uint(place);
  uvec4 bits = hash_of(uvec4(uvec3(cell.world), echo.seed + part));
  float turns = fract(echo.turns_per_m * path_to(point));
  z = amplitude * complex_normal(bits.xy, turns);
  w = amplitude * complex_normal(bits.zw, turns);
}

// Amplitudes of a column's bins first to last, whose power is known, added to those that are there. A slice begins
// in one bin and ends in the next, if that hears the same cell. Whole its amplitude is z. Where the edge leaves the
// part q on the near side, the parts are those of a Brownian path from 0 to z, which has q z + sqrt(q (1 - q)) w
// there: of powers q and 1 - q, uncorrelated, together z.
void sound_column(SonarColumn s, uint column, int first, int last) {
  Cell before = Cell(ivec3(0), kNoLevel, vec3(0.0), 0.0);
  int slice = 0;         // that begins in the bin before
  float begun = 0.0;     // its power there
  vec2 sum = vec2(0.0);  // the bin before's amplitude but for that slice's
  for (int bin = first; bin <= last + 1; ++bin) {
    uint noted_at = 2 * (uint(min(bin, last)) * c.n_azimuth + column);
    float power = bin <= last ? uintBitsToFloat(scratch_at(noted_at)) : 0.0;
    vec2 mean = unpackUnorm2x16(scratch_at(noted_at + 1));
    Cell cell = cell_heard(s, bin, mean.y);
    bool goes_on = power > 0.0 && cell.world == before.world && cell.level == before.level;
    vec2 z, w;
    if (!goes_on) {
      numbers_of(s, before, slice, z, w);
      if (begun > 0.0) sum += sqrt(begun) * z;
      begun = 0.0;
    }
    int ending = goes_on ? slice : int(floor(float(bin) - cell.bin + 0.5));
    float odd = power * mean.x;
    float ended = (ending & 1) != 0 ? odd : power - odd;
    numbers_of(s, cell, ending, z, w);
    vec2 root = sqrt(vec2(begun, ended) / max(begun + ended, 1e-30));
    if (begun > 0.0) sum += sqrt(begun) * (root.x * z + root.y * w);
    if (sum != vec2(0.0)) add_amplitude(bin - 1, column, sum);
    sum = ended > 0.0 ? sqrt(ended) * (root.y * z - root.x * w) : vec2(0.0);
    before = cell;
    slice = ending + 1;
    begun = power - ended;
  }
}
