#include "sonar/acoustics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/water_column.hpp"

namespace neritic::sonar {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double square(double x) {
  return x * x;
}

// A relaxation's share: A f_r f^2 / (f_r^2 + f^2), 0 where there is no salt (f_r = 0).
double relaxation(double f_khz, double relaxation_khz) {
  return relaxation_khz * square(f_khz) / (square(relaxation_khz) + square(f_khz));
}

// Francois and Garrison 1982, eq. 9 to 14 of part II: boric acid, magnesium sulphate, water. f in
// kHz, D in m; dB/km. Their own sound speed, c, is part of the fit.
double francois_garrison_db_km(const Water& w, double f_khz) {
  const double t = w.temperature_c, s = w.salinity_psu, d = w.depth_m, kelvin = t + 273.0;
  const double c = 1412.0 + 3.21 * t + 1.19 * s + 0.0167 * d;
  const double boric = 8.86 / c * std::pow(10.0, 0.78 * w.ph - 5.0);
  const double boric_khz = 2.8 * std::sqrt(s / 35.0) * std::pow(10.0, 4.0 - 1245.0 / kelvin);
  const double magnesium = 21.44 * s / c * (1.0 + 0.025 * t);
  const double magnesium_pressure = 1.0 - 1.37e-4 * d + 6.2e-9 * d * d;
  const double magnesium_khz =
      8.17 * std::pow(10.0, 8.0 - 1990.0 / kelvin) / (1.0 + 0.0018 * (s - 35.0));
  const double water = t <= 20.0 ? 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
                                 : 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t;
  const double water_pressure = 1.0 - 3.83e-5 * d + 4.9e-10 * d * d;
  return boric * relaxation(f_khz, boric_khz) +
         magnesium * magnesium_pressure * relaxation(f_khz, magnesium_khz) +
         water * water_pressure * square(f_khz);
}

// Ainslie and McColm 1998, eq. 3 to 7. f in kHz; dB/km. Depth enters in km, in the water term as
// D/17: some programs leave the division out and are short by half at 1000 m and 900 kHz.
double ainslie_mccolm_db_km(const Water& w, double f_khz) {
  const double t = w.temperature_c, s = w.salinity_psu / 35.0, depth_km = w.depth_m * 1e-3;
  const double boric_khz = 0.78 * std::sqrt(s) * std::exp(t / 26.0);
  const double magnesium_khz = 42.0 * std::exp(t / 17.0);
  return 0.106 * relaxation(f_khz, boric_khz) * std::exp((w.ph - 8.0) / 0.56) +
         0.52 * (1.0 + t / 43.0) * s * relaxation(f_khz, magnesium_khz) *
             std::exp(-depth_km / 6.0) +
         0.00049 * square(f_khz) * std::exp(-(t / 27.0 + depth_km / 17.0));
}

Status in_range(const char* what, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return {};
  return refusal(fmt::format("water: {}", what), fmt::format("{} {}", value, unit),
                 fmt::format("{} to {}", low, high));
}

}  // namespace

double db_from_power(double power_ratio) {
  return 10.0 * std::log10(power_ratio);
}
double power_from_db(double level_db) {
  return std::pow(10.0, level_db / 10.0);
}
double amplitude_from_db(double level_db) {
  return std::pow(10.0, level_db / 20.0);
}

double incoherent_sum_db(std::span<const double> levels_db) {
  // Relative to the strongest, so that no power over- or underflows.
  double strongest = -std::numeric_limits<double>::infinity();
  for (const double level : levels_db) {
    if (std::isnan(level)) return kNaN;
    strongest = std::max(strongest, level);
  }
  if (std::isinf(strongest)) return strongest;
  double sum = 0.0;
  for (const double level : levels_db) sum += power_from_db(level - strongest);
  return strongest + db_from_power(sum);
}

Status validate(const Water& water) {
  NERITIC_TRY_STATUS(in_range("temperature", water.temperature_c, -4.0, 60.0, "C"));
  NERITIC_TRY_STATUS(in_range("salinity", water.salinity_psu, 0.0, 60.0, "psu"));
  NERITIC_TRY_STATUS(in_range("depth", water.depth_m, 0.0, 12000.0, "m"));
  return in_range("pH", water.ph, 6.0, 10.0, "");
}

double sound_speed_mackenzie_m_s(const Water& water) {
  return sea_sound_speed_m_s({water.temperature_c, water.salinity_psu}, water.depth_m);
}

double absorption_db_m(AbsorptionModel model, const Water& water, double frequency_hz) {
  if (!(frequency_hz > 0.0)) return kNaN;
  const double f_khz = frequency_hz * 1e-3;
  return 1e-3 * (model == AbsorptionModel::kFrancoisGarrison ? francois_garrison_db_km(water, f_khz)
                                                             : ainslie_mccolm_db_km(water, f_khz));
}

double spherical_spreading_db(double range_m) {
  // Not std::max(kNearestRange_m, range_m), which would swallow a NaN.
  return 20.0 * std::log10(range_m < kNearestRange_m ? kNearestRange_m : range_m);
}

double transmission_loss_db(double range_m, double absorption_db_m) {
  return spherical_spreading_db(range_m) + absorption_db_m * range_m;
}

double two_way_loss_db(double range_m, double absorption_db_m) {
  return 2.0 * transmission_loss_db(range_m, absorption_db_m);
}

double band_level_db(double spectrum_level_db, double bandwidth_hz) {
  return spectrum_level_db + db_from_power(bandwidth_hz);
}

double thermal_noise_db(double frequency_hz) {
  return frequency_hz > 0.0 ? -15.0 + 20.0 * std::log10(frequency_hz * 1e-3) : kNaN;
}

double ambient_noise_db(double frequency_hz, double wind_m_s, double shipping) {
  if (!(frequency_hz > 0.0 && wind_m_s >= 0.0)) return kNaN;
  const double f_khz = frequency_hz * 1e-3, log_f = std::log10(f_khz);
  const double levels_db[] = {
      17.0 - 30.0 * log_f,
      40.0 + 20.0 * (shipping - 0.5) + 26.0 * log_f - 60.0 * std::log10(f_khz + 0.03),
      50.0 + 7.5 * std::sqrt(wind_m_s) + 20.0 * log_f - 40.0 * std::log10(f_khz + 0.4),
      thermal_noise_db(frequency_hz)};
  return incoherent_sum_db(levels_db);
}

double reflection_coefficient(const Medium& from, const Medium& into) {
  const double z1 = from.impedance_rayl(), z2 = into.impedance_rayl();
  return (z2 - z1) / (z2 + z1);
}

}  // namespace neritic::sonar
