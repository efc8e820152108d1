// Acoustics of sea water and of the sonar equation, in decibels: sound speed, absorption,
// transmission loss, reflection, ambient noise. Pure functions in double; any thread. Levels are dB
// re 1 uPa (at 1 m for sources), losses positive dB.
//
// An argument that is NaN gives NaN. Values outside a formula's published range (stated above it)
// are extrapolated and stay finite wherever validate(water) is ok and the frequency lies in
// [1 Hz, 10 MHz]; frequencies that are not positive give NaN.
#pragma once

#include <span>

#include "engine/core/result.hpp"

namespace neritic::sonar {

// ---- Decibels -----------------------------------------------------------------------------------
// A ratio of 0 is -infinity dB, and back.
double db_from_power(double power_ratio);
double power_from_db(double level_db);
double amplitude_from_db(double level_db);
// Level of independent contributions: their powers add. No contribution is -infinity.
double incoherent_sum_db(std::span<const double> levels_db);

// ---- Water --------------------------------------------------------------------------------------
struct Water {
  double temperature_c = 10.0;
  double salinity_psu = 35.0;
  double depth_m = 0.0;  // below the surface, positive
  double ph = 8.0;
};
// kBadInput that names the quantity, what was found and what is accepted: temperature [-4, 60],
// salinity [0, 60], depth [0, 12000], pH [6, 10].
Status validate(const Water& water);

inline constexpr double kMinFrequency_hz = 1.0, kMaxFrequency_hz = 1.0e7;

// Mackenzie 1981, "Nine-term equation for sound speed in the oceans", JASA 70, 807. Published for
// 2 to 30 C, 25 to 40 psu, 0 to 8000 m; standard error 0.07 m/s.
double sound_speed_mackenzie_m_s(const Water& water);
enum class AbsorptionModel { kFrancoisGarrison, kAinslieMcColm };
// dB per metre, one way, >= 0.
// Francois and Garrison 1982, "Sound absorption based on ocean measurements, Parts I and II", JASA
// 72, 896 and 1879. Published for 0.4 to 1000 kHz, -1.8 to 30 C, 30 to 35 psu.
// Ainslie and McColm 1998, "A simplified formula for viscous and chemical absorption in sea
// water", JASA 103, 1671. Published for 0.1 to 1000 kHz, -6 to 35 C, 5 to 50 psu, 0 to 7 km.
double absorption_db_m(AbsorptionModel model, const Water& water, double frequency_hz);

// ---- Transmission loss --------------------------------------------------------------------------
// Spheres do not spread from nothing: ranges below this count as this (a loss of -60 dB re 1 m).
inline constexpr double kNearestRange_m = 1.0e-3;
// 20 log10 r, re 1 m, and with absorption. Two ways are twice that.
double spherical_spreading_db(double range_m);
double transmission_loss_db(double range_m, double absorption_db_m);
double two_way_loss_db(double range_m, double absorption_db_m);

// A spectrum level (dB re 1 uPa^2/Hz) over a band in which it is flat.
double band_level_db(double spectrum_level_db, double bandwidth_hz);

// Ambient noise, dB re 1 uPa^2/Hz: Wenz's 1962 curves (turbulence, shipping 0 to 1, wind, thermal)
// in the form of Coates 1990, Underwater Acoustic Systems. Thermal noise alone: Mellen 1952.
double thermal_noise_db(double frequency_hz);
double ambient_noise_db(double frequency_hz, double wind_m_s, double shipping);

// ---- Surfaces -------------------------------------------------------------------------------
// Lambert's rule for backscatter per square metre, mu sin^2(grazing), has mu about -27 dB for many
// bottoms (Mackenzie 1961, JASA 33, 1498).
inline constexpr double kLambertMu_db = -27.0;
// A fluid, or a solid as its compressional wave sees it.
struct Medium {
  double density_kg_m3 = 1000.0;
  double sound_speed_m_s = 1480.0;
  double impedance_rayl() const { return density_kg_m3 * sound_speed_m_s; }
};
// Pressure reflected at normal incidence, (Z2 - Z1) / (Z2 + Z1), in [-1, 1]. Negative: inverted.
double reflection_coefficient(const Medium& from, const Medium& into);
}  // namespace neritic::sonar
