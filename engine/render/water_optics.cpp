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
  // Jerlov 1976, Marine Optics, Table XXVII, from 400 to 700 nm every 25 nm.
  std::array<double, 13> diffuse_attenuation_m;
  // Total scattering in the green, 1/m: published values for I, II, III, 1C, 5C and 9C (derived
  // from Solonenko and Mobley 2015). IA, IB, 3C and 7C have none: geometric means between their
  // neighbours, since scattering runs over three decades along the series.
  double green_scattering_m;
};
constexpr std::array<TypeRow, 10> kTypes{{
    {"I", {.028, .022, .019, .018, .027, .043, .063, .089, .235, .305, .36, .42, .56}, .002},
    {"IA", {.038, .031, .026, .025, .032, .048, .067, .094, .24, .31, .37, .43, .57}, .0113},
    {"IB", {.051, .042, .036, .033, .042, .054, .072, .099, .245, .315, .375, .435, .58}, .0636},
    {"II", {.096, .081, .068, .062, .07, .076, .089, .115, .26, .335, .4, .465, .61}, .358},
    {"III", {.185, .16, .135, .116, .115, .116, .12, .148, .295, .375, .445, .52, .66}, .98},
    {"1C", {.51, .36, .25, .17, .14, .13, .12, .15, .3, .37, .45, .51, .65}, .365},
    {"3C", {.78, .54, .39, .29, .22, .2, .19, .21, .33, .4, .46, .56, .71}, .697},
    {"5C", {1.1, .78, .56, .43, .36, .31, .3, .33, .4, .48, .54, .65, .8}, 1.33},
    {"7C", {1.6, 1.2, .89, .71, .58, .49, .46, .46, .48, .54, .63, .78, .92}, 2.04},
    {"9C", {2.4, 1.9, 1.6, 1.23, .99, .78, .63, .58, .6, .65, .76, .92, 1.1}, 3.12},
}};

static_assert(std::ranges::equal(kTypes, scene::kWaterTypes, {}, &TypeRow::name),
              "every type that scenes may name has its row");

// Pure sea water, 1/m: Morel 1974 as summarised by Mobley 1994 (valid 350 to 600 nm).
double water_scattering_m(double wavelength_nm) {
  return 16.06 * 4.72e-4 * std::pow(400.0 / wavelength_nm, 4.32);
}

// Absorption of pure water from 400 to 700 nm every 25 nm, 1/m: Pope and Fry 1997, Applied Optics
// 36, table 3.
constexpr std::array<double, 13> kPureWater_m{.00663, .00478, .00922, .0114, .0204, .0417, .0565,
                                              .0772,  .2224,  .2834,  .340,  .448,  .624};

// Between the wavelengths of a table.
double at_wavelength(const std::array<double, 13>& table, double wavelength_nm) {
  const double place = std::clamp((wavelength_nm - 400.0) / 25.0, 0.0, 12.0);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(place), 11);
  const double share = place - static_cast<double>(low);
  return share == 0.0 ? table[low] : std::lerp(table[low], table[low + 1], share);
}

// Particles scatter a little more at short waves: b ~ 1/lambda, between the exponents 1.7 (small)
// and 0.3 (large particles) of Kopelevich's two fractions (Haltrin 1999).
constexpr double kParticleExponent = 1.0;
// Closure K_d = 1.04 (a + b_b) / mu_d; mu_d for a high sun. Backwards go half of what pure water
// scatters (its phase function is even, Morel 1974) and 0.0183 of what particles do (Petzold).
constexpr double kClosure = 1.04, kMeanCosine = 0.86;
constexpr double kWaterBackFraction = 0.5, kParticleBackFraction = 0.0183;

Result<const TypeRow*> row_of(const std::string& type) {
  const auto row =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeRow& r) { return type == r.name; });
  if (row == kTypes.end())
    return refusal("water type", fmt::format("'{}'", type), join(scene::kWaterTypes));
  return &*row;
}

// Adds this share of what the water is at a wavelength to a channel.
void add_wavelength(const TypeRow& row, double wavelength_nm, double share, int i,
                    WaterOptics& optics) {
  const double k_d = at_wavelength(row.diffuse_attenuation_m, wavelength_nm);
  const double water = water_scattering_m(wavelength_nm);
  const double particles_green = std::max(0.0, row.green_scattering_m - water_scattering_m(550.0));
  const double particles = particles_green * std::pow(550.0 / wavelength_nm, kParticleExponent);
  optics.diffuse_attenuation_m[i] += share * k_d;
  optics.water_scattering_m[i] += share * water;
  optics.particle_scattering_m[i] += share * particles;
  const double back = kWaterBackFraction * water + kParticleBackFraction * particles;
  // Absorption from the closure, but no less than pure water's.
  optics.absorption_m[i] += share * std::max(k_d * kMeanCosine / kClosure - back,
                                             at_wavelength(kPureWater_m, wavelength_nm));
}

}  // namespace

Result<WaterOptics> jerlov_optics(const std::string& type) {
  NERITIC_TRY(const TypeRow* row, row_of(type));
  WaterOptics optics{Vec3(0.0), Vec3(0.0), Vec3(0.0), Vec3(0.0)};
  for (int i = 0; i < 3; ++i)
    add_wavelength(*row, kWavelength_nm[static_cast<std::size_t>(i)], 1.0, i, optics);
  return optics;
}

Result<WaterOptics> jerlov_optics(const std::string& type, const std::array<WaveBand, 3>& bands) {
  NERITIC_TRY(const TypeRow* row, row_of(type));
  WaterOptics optics{Vec3(0.0), Vec3(0.0), Vec3(0.0), Vec3(0.0)};
  constexpr int kSteps = 8;
  for (int i = 0; i < 3; ++i) {
    const WaveBand& band = bands[static_cast<std::size_t>(i)];
    for (int s = 0; s < kSteps; ++s)
      add_wavelength(*row, std::lerp(band.first_nm, band.last_nm, (s + 0.5) / kSteps), 1.0 / kSteps,
                     i, optics);
  }
  return optics;
}

}  // namespace neritic::render
