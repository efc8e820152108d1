// Speckle: what a column's beams add to the world's scatterers, and what those add to bins. Used after the echo's
// uniform and the bins' geometry (sonar_beam.glsl).

// Scatterers are parts of cells of a lattice of the world, each with amplitudes that are its own for ever. A
// cell is as large as what beams sample there asks for. Seen from the sonar it is cut into slices, counted from
// its centre, so that they are the world's too: a bin deep along range, a column wide across.
// No two columns and no two bins share an amplitude (else the taps of pattern and pulse would add N of them to
// N^2 power): a slice's centre says which column hears it; and one that a bin's edge cuts gives either bin a
// part of its own (flush). So as the sonar moves, the picture of speckle moves with the world, along range and
// across.
struct Cell {
  ivec3 world;  // its index in the world's lattice of its level, modulo 2^32
  uint level;   // doublings of the finest lattice, or kNoLevel
  vec3 center;  // from the eye
  float bin;    // of the centre, as heard
};
const uint kNoLevel = 0xffffffffu;
// Of one column: the slice whose power is being summed, row by row, in a bin and the next.
struct Run {
  Cell cell;
  int slice;
  int bin;
  vec2 power;
};

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
  sums[cell] = uint(saturated_sum(int(sums[cell]), counts.x));
  sums[cell + 1] = uint(saturated_sum(int(sums[cell + 1]), counts.y));
}

// Of either axis, directions across that are told apart: some 5 degrees.
const float kAsides = 12.0;

// Adds a run's slice. Where it lies in one bin its amplitude is z. Where a bin's edge leaves the part q on the
// near side, the parts are those of a Brownian path from 0 to z, which has q z + sqrt(q (1 - q)) w there: of powers
// q and 1 - q, uncorrelated, together z.
void flush(SonarColumn s, uint column, Run run) {
  float all = run.power.x + run.power.y;
  if (!(all > 0.0)) return;
  vec3 ahead = normalize(s.beam_base), right = cross(ahead, s.up);
  vec3 center = run.cell.center;
  vec2 root = sqrt(run.power / all);
  vec2 flat_m = vec2(dot(center, right), dot(center, ahead));
  // Of the cell's centre, in columns from this one's middle, and of the slice that is heard here.
  float across = atan(flat_m.x, flat_m.y) / echo.column_rad;
  int place = int(ceil(-0.5 - across));
  // It lies so far across from the centre: along a direction of the world, which the path's phase is counted by.
  vec3 aside = normalize(round(kAsides * normalize(flat_m.y * right - flat_m.x * ahead)));
  vec3 point = center + aside * (float(place) * echo.column_rad * length(flat_m));
  point *= 1.0 + float(run.slice) / (c.bins_per_m * max(length(center), 1e-6));
  if (kTextured != 0) {
    uvec3 patch_cell = uvec3(ivec3(floor(point * echo.patches_per_m + echo.patch_fraction))) + echo.origin_patch;
    uint entries = uint(textureSize(gamma_quantiles, 0).x);
    uint entry = hash_of(uvec4(patch_cell, echo.seed + 1u)).x % entries;
    all *= texelFetch(gamma_quantiles, ivec2(entry, 0), 0).r;
  }
  uint part = 0x9e3779b9u * run.cell.level + 0x85ebca6bu * uint(run.slice) + 0xc2b2ae35u * uint(place);
  uvec4 bits = hash_of(uvec4(uvec3(run.cell.world), echo.seed + part));
  float turns = fract(echo.turns_per_m * path_to(point)), amplitude = sqrt(all);
  vec2 near = amplitude * complex_normal(bits.xy, turns);
  if (run.power.y > 0.0) {
    vec2 z = near, w = amplitude * complex_normal(bits.zw, turns);
    near = root.x * (root.x * z + root.y * w);
    add_amplitude(run.bin + 1, column, root.y * (root.y * z - root.x * w));
  }
  add_amplitude(run.bin, column, near);
}

// A row's power that lies in one bin, at a point of the column's middle, to the slices that it spans. ends: in bins.
// heard: heard over true range. falling: rows go on towards the sonar.
void scatter(SonarColumn s, uint column, vec3 point, float heard, vec2 ends, int bin, bool falling, float power,
             inout Cell here, inout Run run) {
  uint level = level_at(length(point));
  ivec3 world = cell_at(point, level);
  if (world != here.world || level != here.level) {
    vec3 center = center_of(world, level);
    here = Cell(world, level, center, bin_at(heard * path_to(center)));
  }
  float from = ends.x - here.bin + 0.5, upto = ends.y - here.bin + 0.5;
  int low = int(floor(from)), high = max(int(floor(upto)), low);
  float nearer = high > low ? (float(high) - from) / (upto - from) : 1.0;
  // The nearer slice, then the farther one, or the other way round.
  for (int i = 0; i <= min(high - low, 1); ++i) {
    bool far = (i == 1) != falling && high > low;
    int slice = far ? high : low;
    float part = power * (far ? 1.0 - nearer : nearer);
    bool same = slice == run.slice && here.world == run.cell.world && here.level == run.cell.level;
    bool before = bin == run.bin - 1 && run.power.y == 0.0;
    if (!same || !(bin == run.bin || bin == run.bin + 1 || before)) {
      flush(s, column, run);
      run = Run(here, slice, bin, vec2(0.0));
    } else if (before) {
      run = Run(here, slice, bin, run.power.yx);
    }
    if (bin == run.bin) run.power.x += part;
    else run.power.y += part;
  }
}
