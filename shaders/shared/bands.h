// Pictures of a spectrum: an albedo in the three thirds of the spectrum, and three bands each
// joined to one picture by a camera's response (engine/render/bands.hpp).
#ifndef NERITIC_SHARED_BANDS_H
#define NERITIC_SHARED_BANDS_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kMaxBandPictures = 5;

// Rows of matrices: red, green and blue from the channels of each picture, or the reverse.
struct BandParams {
  vec3 rows[15];
};

NERITIC_CONST uint kBandOut = 0;
NERITIC_CONST uint kBandData = 1;
NERITIC_CONST uint kBandIn = 2;  // and those that follow
NERITIC_CONST uint kSpecBandPictures = 0;

NERITIC_SHARED_END
#endif
