// A side-scan line from a camera's picture: the alternative that image-based simulators use, for
// comparison with the acoustic one along the same track. UnRealTHASC (2024), section IV.A, names
// "an RGB-image-based side-scan sonar measurement model" and refers to another paper for it; it
// gives no equation, so that what follows is this project's own, the least that the name asks for:
// the echo of a point is its picture's brightness, optionally times the cosine of incidence (that
// paper's eq. 2), put into the bin of its slant range and averaged along the track (as eq. 5
// averages over elevation: the sum over what a bin covers divided by a number that does not depend
// on it). Pure functions in double; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/intrinsics.hpp"
#include "engine/core/result.hpp"
#include "sonar/beam_grid.hpp"

namespace neritic::sonar {

// A picture from straight above, taken where the sonar is: view axes x to starboard, y ahead, z up.
struct SeabedPicture {
  ImageF32 brightness;    // one channel, 0 to 1, linear; NaN: not known
  Intrinsics intrinsics;  // pixel centres at +0.5, row 0 ahead
  // Planar metres along the view axis a pixel [height][width]; not finite or <= 0: nothing there.
  // Empty: a flat bottom at altitude_m.
  std::vector<float> depth_m;
  double altitude_m = 10.0;
};

// Rec. 709 luminance (ITU-R BT.709) of an sRGB picture of 1, 3 or 4 channels, made linear (IEC
// 61966-2-1), 0 to 1.
ImageF32 brightness_of(const ImageU8& picture);

struct PictureLineOptions {
  std::uint32_t n_range = 500;
  double range_min_m = 0.0, range_max_m = 50.0;  // slant
  // Full width of the beam along the track. Rows of the picture whose pixels lie within it count,
  // weighted with the part of each pixel that does.
  double beam_along_rad = radians(1.0);
  // Times the cosine of incidence on a level bottom, h / r. Off: brightness alone.
  bool incidence = false;
};

struct SidescanLine {
  std::vector<float> port, starboard;  // [n_range], nearest first
};

// A pixel's brightness is shared among the slant bins that it covers across the track, in
// proportion; the picture is read where it lies (no interpolation). Divided by the number of rows
// in the beam, a bin on an even bottom of brightness 1 holds how many pixels' width of picture it
// covers; so energy belongs to the solid angle of the pixels, as in the acoustic sonars. kBadInput
// that names what does not fit.
Result<SidescanLine> sidescan_from_picture(const SeabedPicture& picture,
                                           const PictureLineOptions& options);

}  // namespace neritic::sonar
