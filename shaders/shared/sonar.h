// Shared by the sonar's gather passes and their host: tables, constants, bindings. Directions are
// in the axes of the G-buffer's normals (G-buffer axes), lengths per unit of planar depth of the
// view.
#ifndef NERITIC_SHARED_SONAR_H
#define NERITIC_SHARED_SONAR_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// One azimuth column of the sonar. A column is a vertical plane through the sonar, which a level
// pinhole sees as one column of pixels; the beam at elevation phi is beam_base + tan(phi) *
// sec_theta
// * up, a pixel centre forward + pixel_tan * right + (cy - v - 0.5) / fy * up.
struct SonarColumn {
  vec3 beam_base;   // (tan theta, 0, -1) of the view
  float sec_theta;  // 1 / cos of the azimuth off the view's axis
  vec3 right;       // the view's x
  float pixel_tan;  // (u + 0.5 - cx) / fx
  vec3 up;          // the view's y
  vec3 forward;     // the view's -z
  int pixel;        // u, or -1: no view sees the column
  uint layer;       // of the G-buffer images
  int first_pixel;  // published gather: pixels whose centres lie in the column
  int end_pixel;
  float tan_theta;  // of the azimuth off the view's axis
};

// One elevation row is one texel of a 1-texel-high image: tangent and 1 / cos of its centre,
// tangents of its edges. (An image, because a processor's driver reads a buffer lane by lane.)

struct SonarPush {
  uint n_range;
  uint n_azimuth;
  uint n_elevation;
  uint width;  // of a layer, pixels
  uint height;
  float fx;
  float fy;
  float cx;
  float cy;
  float near_m;  // reversed-Z: planar metres = near_m / depth
  float range_min_m;
  float bins_per_m;
  float bin_m;
  float fixed_scale;  // intensity 1 in counts
  float edge_bias_bins;
  uint reflectivities;  // entries of the table by instance label; others reflect fully
  float lean;           // of a view whose sides lean (kSonarSpecLeaning), in tangents
  float azimuth_step_rad;
  uint first_row;  // of cells, in this dispatch
  uint end_row;
  uint first_v;  // published: of pixels, in this dispatch
  uint end_v;
  uint drawn_larger;  // entries of the table of what is drawn larger
  // The water's surface over the view's eye, along the y of G-buffer axes: nothing above it echoes.
  float surface_m;
};

// Something that is drawn larger than it is (kSonarSpecLarger): the point that is drawn in the
// direction d, at its true range r, lies at s * true_from_drawn * d + offset_m, with the s that
// makes it r far. About the view's eye, in G-buffer axes. By ascending labels.
struct SonarDrawnLarger {
  mat3 true_from_drawn;
  vec3 offset_m;
  // Ghosts: the thing's own azimuth, half its width, its lowest and highest elevation, seen from
  // the sonar.
  vec4 direct_rad;
  uint label;
  uint direct;  // ghosts: not 0 where it is drawn larger in the sonar's own view
};

NERITIC_CONST uint kSonarBindColumns = 0;
NERITIC_CONST uint kSonarBindRows = 1;
NERITIC_CONST uint kSonarBindDepth = 2;
NERITIC_CONST uint kSonarBindNormal = 3;
NERITIC_CONST uint kSonarBindLabel = 4;
NERITIC_CONST uint kSonarBindReflectivity = 5;
NERITIC_CONST uint kSonarBindSums = 6;
NERITIC_CONST uint kSonarBindKeys = 7;
NERITIC_CONST uint kSonarBindScratch = 8;     // of one gather, cleared before: stamps, or powers
NERITIC_CONST uint kSonarBindSumTexels = 16;  // the same three as texels, with kSonarSpecTexels
NERITIC_CONST uint kSonarBindKeyTexels = 17;
NERITIC_CONST uint kSonarBindScratchTexels = 18;
NERITIC_CONST uint kSonarBindLarger = 19;

// Specialisation constants.
NERITIC_CONST uint kSonarSpecColumns = 0;  // columns a workgroup (its x size)
NERITIC_CONST uint kSonarSpecLanes = 1;    // threads a column (its y size)
NERITIC_CONST uint kSonarSpecPlane = 2;    // beam meets the plane of the pixel's point and normal
NERITIC_CONST uint kSonarSpecPacked = 3;   // normal image: unit x, y, z and planar metres, no other
NERITIC_CONST uint kSonarSpecFacing = 5;   // else the normals' signs are unknown
NERITIC_CONST uint kSonarSpecReflect = 6;  // multiply by the reflectivity of the instance
NERITIC_CONST uint kSonarSpecLabels = 7;   // keep the label of the strongest return
// Small things are drawn larger than they are: their reflectivity is negative, its size what a
// sample of them counts.
NERITIC_CONST uint kSonarSpecLarger = 19;
// The view's sides lean (render::ViewDesc), and a column's rows look for surfaces all over its
// width.
NERITIC_CONST uint kSonarSpecLeaning = 16;
NERITIC_CONST uint kSonarSpecTexels = 18;      // sums, keys and scratch are texel buffers
NERITIC_CONST uint kSonarSpecFootprint = 15;   // what is done with the ranges that a row spans:
NERITIC_CONST uint kSonarFootprintNone = 0;    // nothing, its centre counts
NERITIC_CONST uint kSonarFootprintShared = 1;  // its counts are shared out over them, evenly
NERITIC_CONST uint kSonarFootprintBounded =
    2;  // by incidence, and end where the neighbouring rows' begin

NERITIC_SHARED_END
#endif
