#include "engine/render/bands.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::render {
namespace {

constexpr double kSpectrumFirst_nm = 400.0, kSpectrumLast_nm = 700.0;

// CIE standard illuminant D65 from 400 to 700 nm, every 10 nm (CIE 15:2004, table T.1).
constexpr std::array<double, 31> kDaylight{
    82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
    115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
    100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886,
    83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091};

double daylight_d65(double wavelength_nm) {
  const double place = std::clamp((wavelength_nm - kSpectrumFirst_nm) / 10.0, 0.0, 30.0);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(place), 29);
  return std::lerp(kDaylight[low], kDaylight[low + 1], place - static_cast<double>(low));
}

// A bell that is differently wide on both sides of its middle.
double bell(double x, double middle, double low, double high) {
  const double t = (x - middle) / (x < middle ? low : high);
  return std::exp(-0.5 * t * t);
}

Vec3 eye_response(double l) {
  const Vec3 xyz(1.056 * bell(l, 599.8, 37.9, 31.0) + 0.362 * bell(l, 442.0, 16.0, 26.7) -
                     0.065 * bell(l, 501.1, 20.4, 26.2),
                 0.821 * bell(l, 568.8, 46.9, 40.5) + 0.286 * bell(l, 530.9, 16.3, 31.1),
                 1.217 * bell(l, 437.0, 11.8, 36.0) + 0.681 * bell(l, 459.0, 26.0, 13.8));
  // IEC 61966-2-1.
  return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
          -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
          0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

Vec3 tabled_response(const std::vector<scene::ResponseRow>& rows, double wavelength_nm) {
  const auto above = std::ranges::find_if(
      rows, [&](const auto& row) { return row.wavelength_nm >= wavelength_nm; });
  if (above == rows.begin()) return rows.front().channels;
  if (above == rows.end()) return rows.back().channels;
  const scene::ResponseRow& low = *(above - 1);
  const double share =
      (wavelength_nm - low.wavelength_nm) / (above->wavelength_nm - low.wavelength_nm);
  return glm::mix(low.channels, above->channels, share);
}

}  // namespace

Vec3 response_to_daylight(const scene::Spectrum& spectrum, double wavelength_nm) {
  return daylight_d65(wavelength_nm) * (spectrum.response.empty()
                                            ? eye_response(wavelength_nm)
                                            : tabled_response(spectrum.response, wavelength_nm));
}

BandSet make_bands(const scene::Spectrum& spectrum) {
  BandSet out;
  const std::size_t each = spectrum.bands / 3;
  const double width_nm =
      (kSpectrumLast_nm - kSpectrumFirst_nm) / (3.0 * static_cast<double>(each));
  Vec3 white(0.0);
  for (std::size_t i = 0; i < each; ++i) {
    std::array<WaveBand, 3> picture;
    Mat3 joined(0.0);
    for (int third = 0; third < 3; ++third) {
      // Red, the long waves, come first.
      const auto band = static_cast<double>(i + each * static_cast<std::size_t>(2 - third));
      WaveBand& here = picture[static_cast<std::size_t>(third)];
      here = {kSpectrumFirst_nm + band * width_nm, kSpectrumFirst_nm + (band + 1.0) * width_nm};
      constexpr int kSteps = 32;
      for (int s = 0; s < kSteps; ++s)
        joined[third] +=
            response_to_daylight(spectrum, here.first_nm + (s + 0.5) * width_nm / kSteps);
      white += joined[third];
    }
    out.pictures.push_back(picture);
    out.rgb_from_bands.push_back(joined);
  }
  Mat3 thirds(0.0);
  for (Mat3& joined : out.rgb_from_bands) {
    for (int third = 0; third < 3; ++third) joined[third] /= white;
    thirds += joined;
  }
  // Channels that see the same have no way back; their surfaces keep what they have.
  if (std::abs(glm::determinant(thirds)) > 1e-6) out.bands_from_rgb = glm::inverse(thirds);
  return out;
}

Result<shared::Lighting> band_lighting(const shared::Lighting& lighting, const std::string& water,
                                       const BandSet& bands, std::size_t picture) {
  shared::Lighting out = lighting;
  const auto colour = [&](const Vec3f& rgb) {
    return glm::max(Vec3f(bands.bands_from_rgb * Vec3(rgb)), Vec3f(0.0f));
  };
  if (lighting.terms & shared::kLightWater) {
    NERITIC_TRY(const WaterOptics optics, jerlov_optics(water, bands.pictures[picture]));
    out.diffuse_attenuation = Vec3f(optics.diffuse_attenuation_m);
    out.beam_attenuation = Vec3f(optics.beam_attenuation_m());
    out.water_scattering = Vec3f(optics.water_scattering_m);
    out.particle_scattering = Vec3f(optics.particle_scattering_m);
  }
  out.surface_irradiance = colour(lighting.surface_irradiance);
  out.background = colour(lighting.background);
  out.bottom_color = glm::min(colour(lighting.bottom_color), Vec3f(1.0f));
  for (std::uint32_t i = 0; i < out.lamp_count; ++i)
    out.lamps[i].intensity_cd = colour(lighting.lamps[i].intensity_cd);
  return out;
}

Result<Vec3> white_under_water(const std::string& water, const BandSet& bands, double depth_m) {
  Vec3 sum(0.0);
  for (std::size_t p = 0; p < bands.pictures.size(); ++p) {
    NERITIC_TRY(const WaterOptics optics, jerlov_optics(water, bands.pictures[p]));
    sum += bands.rgb_from_bands[p] * glm::exp(-depth_m * optics.diffuse_attenuation_m);
  }
  return sum;
}

}  // namespace neritic::render
