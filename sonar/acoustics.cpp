#include "sonar/acoustics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"

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
  return bad_input("water: {} is {} {}, {} to {} is accepted", what, value, unit, low, high);
}

}  // namespace

double db_from_power(double power_ratio) {
  return 10.0 * std::log10(power_ratio);
}
double power_from_db(double level_db) {
  return std::pow(10.0, level_db / 10.0);
}
double db_from_amplitude(double amplitude_ratio) {
  return 20.0 * std::log10(amplitude_ratio);
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

std::complex<double> coherent_sum(std::span<const double> levels_db,
                                  std::span<const double> phases_rad) {
  NERITIC_CHECK(levels_db.size() == phases_rad.size(), "{} levels, {} phases", levels_db.size(),
                phases_rad.size());
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < levels_db.size(); ++i)
    sum += std::polar(amplitude_from_db(levels_db[i]), phases_rad[i]);
  return sum;
}

Status validate(const Water& water) {
  NERITIC_TRY_STATUS(in_range("temperature", water.temperature_c, -4.0, 60.0, "C"));
  NERITIC_TRY_STATUS(in_range("salinity", water.salinity_psu, 0.0, 60.0, "psu"));
  NERITIC_TRY_STATUS(in_range("depth", water.depth_m, 0.0, 12000.0, "m"));
  return in_range("pH", water.ph, 6.0, 10.0, "");
}

double sound_speed_mackenzie_m_s(const Water& water) {
  const double t = water.temperature_c, s = water.salinity_psu - 35.0, d = water.depth_m;
  return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * s + 1.630e-2 * d +
         1.675e-7 * d * d - 1.025e-2 * t * s - 7.139e-13 * t * d * d * d;
}

double sound_speed_medwin_m_s(const Water& water) {
  const double t = water.temperature_c, s = water.salinity_psu - 35.0;
  return 1449.2 + 4.6 * t - 0.055 * t * t + 0.00029 * t * t * t + (1.34 - 0.010 * t) * s +
         0.016 * water.depth_m;
}

Result<AbsorptionModel> absorption_model_of(std::string_view name) {
  if (name == "francois-garrison") return AbsorptionModel::kFrancoisGarrison;
  if (name == "ainslie-mccolm") return AbsorptionModel::kAinslieMcColm;
  return bad_input("absorption '{}'; accepted: francois-garrison, ainslie-mccolm", name);
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

double echo_level_db(double source_level_db, double two_way_loss_db, double target_strength_db) {
  return source_level_db - two_way_loss_db + target_strength_db;
}

double signal_to_noise_db(double echo_level_db, double noise_level_db) {
  return echo_level_db - noise_level_db;
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

double rigid_sphere_target_strength_db(double radius_m) {
  return 20.0 * std::log10(radius_m / 2.0);
}

double lambert_strength(double mu_db, double grazing_rad) {
  return power_from_db(mu_db) * square(std::sin(grazing_rad));
}

double lambert_strength_db(double mu_db, double grazing_rad) {
  return mu_db + 20.0 * std::log10(std::abs(std::sin(grazing_rad)));
}

double reflection_coefficient(const Medium& from, const Medium& into) {
  const double z1 = from.impedance_rayl(), z2 = into.impedance_rayl();
  return (z2 - z1) / (z2 + z1);
}

// Rayleigh: with grazing angles g1 and g2 of the two waves, (Z2 sin g1 - Z1 sin g2) over the sum.
// Snell: cos g2 = (c2 / c1) cos g1, and sin g2 imaginary beyond the critical angle. Jensen et al.
// 2011, Computational Ocean Acoustics, sec. 1.6.1.
std::complex<double> reflection_coefficient(const Medium& from, const Medium& into,
                                            double grazing_rad) {
  const double sine = std::sin(grazing_rad);
  const double cosine2 = into.sound_speed_m_s / from.sound_speed_m_s * std::cos(grazing_rad);
  const std::complex<double> sine2 = std::sqrt(std::complex<double>(1.0 - square(cosine2), 0.0));
  const std::complex<double> a = into.impedance_rayl() * sine;
  const std::complex<double> b = from.impedance_rayl() * sine2;
  return (a - b) / (a + b);
}

}  // namespace neritic::sonar
