// Shared by the sonar's passes beyond the plain cosine and their host: the gather with terms, and
// the receiver's passes. Fields and powers are in units of the gather's scale; gains turn them to
// what leaves.
#ifndef NERITIC_SHARED_SONAR_ECHO_H
#define NERITIC_SHARED_SONAR_ECHO_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Constants of one ping. Directions and lengths in the axes of the G-buffer's normals, about the
// view's eye.
struct SonarEcho {
  vec3 motion;         // heard range = r + r * dot(motion, d) + dot(doppler, d)
  float sum_scale;     // power 1 (amplitude 1 where coherent) in counts
  vec3 doppler;        // metres
  float turns_per_m;   // phase of an echo: 2 f / c times its range
  vec3 cell_fraction;  // where the eye lies in its cell of the finest lattice of scatterers, 0 to 1
  float cells_per_m;
  uvec3 origin_cell;  // that cell, modulo 2^32
  uint seed;
  vec3 patch_fraction;  // the same for the patches of the gamma texture
  float patches_per_m;
  uvec3 origin_patch;
  uint correction_width;  // of the table of range factors: ranges
  vec3 world_up;
  uint correction_height;    // sines of the elevation above the horizon, -1 to 1
  float correction_range_m;  // range of its last column
  // Ghosts: hits above (sign +) or below (-) this height over the eye are none.
  float water_level_m;
  float water_sign;
  float ghost_weight;
  vec3 ghost_source;  // ghosts: the sonar, seen from its mirror image (the eye)
  // Ghosts: what the direct leg's spreading makes of the gain, which counts the mean leg's:
  // kSonarGhost.
  uint ghost_spreading;
  vec3 head_right;  // the head's axes, for a direction's place in its pattern
  float elevation_min_rad;
  vec3 head_up;
  float rows_per_rad;
  vec3 head_back;
  float azimuth_min_rad;
  float columns_per_rad;
  uint solid_angle;       // a beam's weight holds the cosine of its elevation
  float cells_per_range;  // scatterers: the least width of a cell a metre of range, in finest cells
  float least_cells;      // and at any range
  float column_rad;
  uint mirror_class;  // ghosts: of what the mirror is a part, and does not hide itself; 0: of
                      // nothing
};
NERITIC_CONST uint kSonarGhostPlain = 0u;        // no range counts
NERITIC_CONST uint kSonarGhostSpreading = 1u;    // 1 / r^2 of the direct leg
NERITIC_CONST uint kSonarGhostNoSpreading = 2u;  // the patch that a beam's solid angle covers

// The return of one gathered beam, for labels by energy. bin: row of the range, or kSonarNoReturn.
struct SonarRecord {
  uint bin;
  uint counts;  // of its power, 2^-28 each
  uint label;   // class in the low, instance in the high 16 bits
  uint ends;    // bins of the nearest and farthest that its height spans, low and high 16 bits
};
NERITIC_CONST uint kSonarNoReturn = 0xffffffffu;
NERITIC_CONST uint kSonarSharedReturn = 0xfffffffeu;  // as bin: its counts are shared over its ends
NERITIC_CONST uint kSonarFarthestEnd = 65535u;
NERITIC_CONST float kSonarRecordScale = 268435456.0f;
NERITIC_CONST uint kSonarGhostClass = 65533u;

// Bindings of the gather with terms, after those of sonar.h.
NERITIC_CONST uint kSonarBindEcho = 9;
NERITIC_CONST uint kSonarBindWeights = 10;  // R32 [n_elevation][n_azimuth]: 0 to 1 of each beam
// Floats [sine][range]: heard over true range; of bent rays then how much higher they leave, rad.
NERITIC_CONST uint kSonarBindCorrection = 11;
NERITIC_CONST uint kSonarBindTexture = 12;  // R32 quantiles of the gamma texture, mean 1
NERITIC_CONST uint kSonarBindRecords = 13;
NERITIC_CONST uint kSonarBindDirectDepth = 14;  // ghosts: what the sonar itself sees
NERITIC_CONST uint kSonarBindDirectLabel = 15;
// Specialisation constants, after those of sonar.h.
NERITIC_CONST uint kSonarSpecCoherent = 8;
NERITIC_CONST uint kSonarSpecWeighted = 9;
NERITIC_CONST uint kSonarSpecCorrected = 10;
NERITIC_CONST uint kSonarSpecTextured = 11;
NERITIC_CONST uint kSonarSpecRecords = 12;
NERITIC_CONST uint kSonarSpecGhost = 13;
NERITIC_CONST uint kSonarSpecMoving = 14;
NERITIC_CONST uint kSonarSpecBent = 17;  // weights are those of where a bent ray leaves

// The receiver: sums to a field (resolve), spread along range and across beams (spread), noise and
// gain (receive). Fields are RG32F images [n_range][columns]: (power, 0), or real and imaginary
// amplitude.
struct SonarReceiverPush {
  uint columns;  // of the field read
  uint rows;
  uint out_columns;  // of what is written
  uint stride;       // columns of the field a beam
  int first;         // of the taps' offsets, may be negative
  uint taps;
  float scale;        // resolve: counts to field
  float first_shift;  // spread across beams: columns that the bearing has turned until row 0
  float shift;        // and what it turns from row to row
  // spread across beams: columns that a bearing shifts by as the sonar moves to starboard (times
  // the bearing's cosine) and backwards (times its sine), and the beams' bearings.
  float shift_right;
  float shift_back;
  float first_bearing_rad;
  float bearing_step_rad;
  // spread across beams: correlation of the taps with themselves a column on, which says what power
  // the field between two columns has.
  float tap_correlation;
  float noise;  // receive: amplitude of either part
  uint seed;
  uint ping;
};
NERITIC_CONST uint kReceiverIn = 0;  // sums (buffer), or the field
// vec2 [n_range]: of the field (amplitude where coherent), of the power after it.
NERITIC_CONST uint kReceiverGains = 1;
NERITIC_CONST uint kReceiverTaps = 2;  // R32F
NERITIC_CONST uint kReceiverOut = 3;
NERITIC_CONST uint kReceiverGroup = 8;
NERITIC_CONST uint kReceiverSpecCoherent = 0;
NERITIC_CONST uint kReceiverSpecAxis = 1;  // spread: 0 across beams, 1 along range
NERITIC_CONST uint kReceiverSpecNoise = 2;
NERITIC_CONST uint kReceiverSpecShift = 3;
NERITIC_CONST uint kReceiverSpecWrap = 4;  // a full turn: the columns are a ring

NERITIC_SHARED_END
#endif
