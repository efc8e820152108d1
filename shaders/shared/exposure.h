// Focus and shutter act on a picture before its lens: bindings and parameters of the focus and
// shutter passes.
#ifndef NERITIC_SHARED_EXPOSURE_H
#define NERITIC_SHARED_EXPOSURE_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

#ifdef __cplusplus
using glm::abs;
using glm::min;
#endif

struct FocusParams {
  float near_m;
  float focus_m;
  float opening_px;  // half the lens's opening (m) times the picture's focal length (pixels)
  float widest_px;   // no spot has a larger radius
  uint samples;
};

// Radius of a point's spot on the picture, pixels: thin lens, planar distances (opening / 2 |1 / z
// - 1 / focus|).
NERITIC_INLINE float spot_radius_px(FocusParams focus, float planar_m) {
  return min(focus.opening_px * abs(1.0f / planar_m - 1.0f / focus.focus_m), focus.widest_px);
}

// Pixels a side of the tiles whose motions the shutter knows.
NERITIC_CONST uint kShutterTile = 16;
// Ways that differ by less count as one surface's.
NERITIC_CONST float kSameMotion_px = 0.5f;
// Steps of a grid over the picture before the lens.
NERITIC_CONST uint kRowSteps = 32;

struct ShutterParams {
  float exposed;  // share of the time to the next frame that a row is exposed
  float readout;  // and that the rows are read one after another, from the first to the last
  uint samples;
  float farthest_px;  // no sample is farther off along the motion
  vec2 tiles;         // tiles that the picture's sides count, with parts of one
  uint by_lens;       // 0: the sensor's rows are the picture's; 1: row[] tells which
  // The sensor's row, as a share of its height, that shows each point of the grid: row by row.
  float row[(kRowSteps + 1) * (kRowSteps + 1)];
};

NERITIC_CONST uint kExposureHdr = 0;
NERITIC_CONST uint kExposureDepth = 1;
NERITIC_CONST uint kExposureOut = 2;
NERITIC_CONST uint kExposureData = 3;
NERITIC_CONST uint kExposureMotion = 4;  // pixels to the next frame
// Each tile's quickest and slowest motion; shutter_reach turns them into two texels a tile, with
// four motions.
NERITIC_CONST uint kExposureTiles = 5;

NERITIC_SHARED_END
#endif
