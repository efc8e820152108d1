// A spectrum in bands, for cameras that name it (scene::Spectrum): the light from 400 to 700 nm in
// 9, 12 or 15 bands of even width. A picture has three of them, one from each third of the
// spectrum, as red, green and blue; each is shaded as usual, in its own water, and all are joined
// by the camera's response to daylight. A surface's colour becomes a reflectance that is constant
// over each third, so that it keeps its colour in air. Plain values; any thread.
#pragma once

#include <array>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/render/water_optics.hpp"
#include "engine/scene/camera_terms.hpp"
#include "shared/lighting.h"

namespace neritic::render {

struct BandSet {
  std::vector<std::array<WaveBand, 3>> pictures;  // red, green and blue third
  std::vector<Mat3> rgb_from_bands;               // of each picture; white light becomes white
  Mat3 bands_from_rgb{1.0};  // reflectances of the thirds; their way back gives the same colour
};
BandSet make_bands(const scene::Spectrum& spectrum);

// How much light of a wavelength each channel gets of a white surface in daylight (CIE D65), per
// nm, not scaled: by the camera's response; without one the eye's, CIE 1931 as Wyman, Sloan and
// Shirley fitted it (2013, JCGT 2, 2), in linear sRGB.
Vec3 response_to_daylight(const scene::Spectrum& spectrum, double wavelength_nm);

// The light of one picture: the water's at its bands, and lamps and grounds as they are in them.
// Errors: an unknown type of water.
Result<shared::Lighting> band_lighting(const shared::Lighting& lighting, const std::string& water,
                                       const BandSet& bands, std::size_t picture);

// A white card that daylight reaches through metres of depth, as the camera has it (white at 0 m).
Result<Vec3> white_under_water(const std::string& water, const BandSet& bands, double depth_m);

}  // namespace neritic::render
