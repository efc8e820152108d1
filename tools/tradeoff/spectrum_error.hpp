// How far colours under water are off that are made of few bands of the spectrum, against its every
// nanometre: a white card in daylight, of which the camera sees what K_d leaves. Pure functions.
#pragma once

#include <cstdint>
#include <string>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::tools {

// CIE L*, a*, b* of linear sRGB, white (1, 1, 1).
Vec3 lab_of(const Vec3& linear);
// CIEDE2000 (Sharma, Wu and Dalal 2005), all weights 1; 1 is about just noticeable.
double delta_e(const Vec3& a_lab, const Vec3& b_lab);

// Error of a white card at this depth, both exposed so that the whole spectrum gives it a luminance
// of 0.5. bands: 3 (600, 550 and 450 nm), 9, 12 or 15. Errors: an unknown type of water.
Result<double> card_error(const std::string& water, double depth_m, std::uint32_t bands);

}  // namespace neritic::tools
