// Optical properties of natural waters by Jerlov type, at the three wavelengths that stand for the
// linear sRGB channels: 600, 550 and 450 nm. Pure data; any thread.
#pragma once

#include <array>
#include <string>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::render {

struct WaterOptics {
  Vec3 diffuse_attenuation_m;  // K_d, 1/m: how sunlight fades with depth
  Vec3 absorption_m;           // a, 1/m
  Vec3 water_scattering_m;     // b of pure sea water, 1/m
  Vec3 particle_scattering_m;  // b of particles, 1/m
  // c = a + b, 1/m: how sight along a line fades.
  Vec3 beam_attenuation_m() const {
    return absorption_m + water_scattering_m + particle_scattering_m;
  }
};

// A part of the spectrum.
struct WaveBand {
  double first_nm = 550.0, last_nm = 550.0;
};
// The means over three parts of the spectrum, from 400 to 700 nm. Measured every 25 nm and linear
// between; pure water's scattering above 600 nm is extrapolated.
Result<WaterOptics> jerlov_optics(const std::string& type, const std::array<WaveBand, 3>& bands);
// The types of scene::kWaterTypes; another name is kBadInput with the list.
Result<WaterOptics> jerlov_optics(const std::string& type);

}  // namespace neritic::render
