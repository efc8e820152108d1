// The decibels that a sonar's settings come to: the sonar equation of one patch, the noise in the
// receiver's band, and the receiver's gain over range. Pure functions of plain values; any thread.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::sonar {

// What the water takes, dB per metre one way, of a sonar depth_m deep. 0 without levels.
double absorption_of(const scene::SonarTerms& terms, double depth_m);

// Echo, as a power re 1 uPa^2, of what lies within a solid angle at range r and sends back
// strength (Lambert's mu times the cosine of incidence): a patch of r^2 dOmega / cos i scatters
// mu cos^2 i, so target strength is mu cos i r^2 dOmega.
double echo_power(const scene::SonarLevel& level, double range_m, double absorption_db_m,
                  double strength, double solid_angle);

// Mean noise of a bin, dB re 1 uPa in the receiver's band: what is named, or ambient noise over the
// pulse's bandwidth and self noise, whose powers add. Ambient noise is an omnidirectional
// hydrophone's: no directivity index is taken off.
double noise_level_db(const scene::SonarTerms& terms);

// Receiver gain and time varied gain: of SonarLevel's tvg_log, 40 levels point targets, 30 the
// areas that beam and pulse cut out, 20 volumes.
double receiver_gain_db(const scene::SonarLevel& level, double range_m, double absorption_db_m);

// A receiver holds no more than this (300 dB re 1 uPa, far above any water's): sums of thousands of
// such bins stay finite floats.
inline constexpr double kLargestPower = 1e30;

// An intensity from anywhere: what is not finite or negative is silence.
inline float heard(float intensity) {
  return intensity > 0.0f && std::isfinite(intensity) ? intensity : 0.0f;
}

// intensity [range][columns] without what is below its row's floor (none: as it is).
std::vector<float> above_floor(std::span<const float> intensity, std::span<const float> floor);

}  // namespace neritic::sonar
