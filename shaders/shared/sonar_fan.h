// The sonar's image as a fan, for the eyes of a person at the live display. Shared by its two
// passes and their host: one finds how bright to show it, one draws it.
#ifndef NERITIC_SHARED_SONAR_FAN_H
#define NERITIC_SHARED_SONAR_FAN_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

struct SonarFanPush {
  uint width;  // of the picture, pixels
  uint height;
  float n_range;  // of the rows, that lie in the part of the range that is shown
  uint n_azimuth;
  float left_m;  // of the picture's left edge, starboard positive
  float top_m;   // of its upper edge, ahead positive
  float m_per_px;
  float range_min_m;
  float bins_per_m;
  float azimuth_middle_rad;
  float azimuth_half_rad;
  float bins_per_rad;
  float gamma;  // shown brightness = (value gain / full scale)^gamma
  float gain;
  uint is_power;   // cells are floats of power, shown as amplitudes; else counts
  uint is_opaque;  // around the fan is the darkest colour; else nothing, and colour is not
                   // multiplied by alpha
};

NERITIC_CONST uint kSonarFanSums = 0;
NERITIC_CONST uint kSonarFanScale = 1;
NERITIC_CONST uint kSonarFanPicture = 2;
NERITIC_CONST uint kSonarFanGroup = 8;

// The brightness pass: one workgroup looks at every stride-th cell. A value v > 0 counts in bin
// 8 * floor(log2 v) + the next three bits of v, so a bin is an eighth of an octave.
struct SonarFanScalePush {
  uint cells;
  uint stride;
  float quantile;  // of the cells that are not silent
  float follow;    // how much of the new full scale is taken: 1 all of it
  uint is_power;   // then a bin is half an octave of amplitude, from 2^-64
};
NERITIC_CONST uint kSonarFanScaleGroup = 64;
NERITIC_CONST uint kSonarFanScaleBins = 256;

NERITIC_SHARED_END
#endif
