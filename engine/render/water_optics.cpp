#include "engine/render/water_optics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::render {
namespace {

constexpr std::array<double, 3> kWavelength_nm{600.0, 550.0, 450.0};

struct TypeRow {
  std::string_view name;
  // Jerlov 1976, Marine Optics, Table XXVII, at 600, 550 and 450 nm.
  std::array<double, 3> diffuse_attenuation_m;
  // Total scattering in the green, 1/m: published values for I, II, III, 1C, 5C and 9C (derived
  // from Solonenko and Mobley 2015). IA, IB, 3C and 7C have none: geometric means between their
  // neighbours, since scattering runs over three decades along the series.
  double green_scattering_m;
};
constexpr std::array<TypeRow, 10> kTypes{{
    {"I", {.235, .063, .019}, .002},
    {"IA", {.240, .067, .026}, .0113},
    {"IB", {.245, .072, .036}, .0636},
    {"II", {.260, .089, .068}, .358},
    {"III", {.295, .120, .135}, .98},
    {"1C", {.300, .120, .250}, .365},
    {"3C", {.330, .190, .390}, .697},
    {"5C", {.400, .300, .560}, 1.33},
    {"7C", {.480, .460, .890}, 2.04},
    {"9C", {.600, .630, 1.60}, 3.12},
}};

static_assert(std::ranges::equal(kTypes, scene::kWaterTypes, {}, &TypeRow::name),
              "every type that scenes may name has its row");

// Pure sea water, 1/m: Morel 1974 as summarised by Mobley 1994 (valid 350 to 600 nm).
double water_scattering_m(double wavelength_nm) {
  return 16.06 * 4.72e-4 * std::pow(400.0 / wavelength_nm, 4.32);
}

// Absorption of pure water at 600, 550 and 450 nm, 1/m: Pope and Fry 1997, Applied Optics 36,
// table 3.
constexpr std::array<double, 3> kPureWater_m{.2224, .0565, .00922};

// Particles scatter a little more at short waves: b ~ 1/lambda, between the exponents 1.7 (small)
// and 0.3 (large particles) of Kopelevich's two fractions (Haltrin 1999).
constexpr double kParticleExponent = 1.0;
// Closure K_d = 1.04 (a + b_b) / mu_d; mu_d for a high sun. Backwards go half of what pure water
// scatters (its phase function is even, Morel 1974) and 0.0183 of what particles do (Petzold).
constexpr double kClosure = 1.04, kMeanCosine = 0.86;
constexpr double kWaterBackFraction = 0.5, kParticleBackFraction = 0.0183;

}  // namespace

Result<WaterOptics> jerlov_optics(const std::string& type) {
  const auto row =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeRow& r) { return type == r.name; });
  if (row == kTypes.end())
    return refusal("water type", fmt::format("'{}'", type), join(scene::kWaterTypes));
  WaterOptics optics;
  for (int i = 0; i < 3; ++i) {
    const double wavelength_nm = kWavelength_nm[i];
    const double k_d = row->diffuse_attenuation_m[i];
    const double water = water_scattering_m(wavelength_nm);
    const double particles_green =
        std::max(0.0, row->green_scattering_m - water_scattering_m(550.0));
    const double particles = particles_green * std::pow(550.0 / wavelength_nm, kParticleExponent);
    optics.diffuse_attenuation_m[i] = k_d;
    optics.water_scattering_m[i] = water;
    optics.particle_scattering_m[i] = particles;
    const double back = kWaterBackFraction * water + kParticleBackFraction * particles;
    // Absorption from the closure, but no less than pure water's.
    optics.absorption_m[i] = std::max(k_d * kMeanCosine / kClosure - back, kPureWater_m[i]);
  }
  return optics;
}

}  // namespace neritic::render
