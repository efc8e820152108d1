// Levels that follow from a sonar's settings: the sonar equation of one patch, the noise in the
// receiver's band, the receiver's gain over range. Pure functions; any thread.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::sonar {

// The water's absorption around a sonar at depth_m, dB per metre one way. 0 without levels.
double absorption_of(const scene::SonarTerms& terms, double depth_m);

// The echo's power, re 1 uPa^2, from a surface within a solid angle at range r. strength is
// Lambert's mu times the cosine of incidence i. The patch has the area r^2 dOmega / cos i and
// scatters mu cos^2 i, so its target strength is mu cos i r^2 dOmega.
double echo_power(const scene::SonarLevel& level, double range_m, double absorption_db_m,
                  double strength, double solid_angle);

// Mean noise of a bin, dB re 1 uPa in the receiver's band: the given level, or the sum of the
// powers of ambient noise over the pulse's bandwidth and of self noise. Ambient noise is that of an
// omnidirectional hydrophone: no directivity index is subtracted.
double noise_level_db(const scene::SonarTerms& terms);

// Receiver gain plus time varied gain. tvg_log of 40 makes the level of point targets independent
// of range, 30 that of areas cut out by beam and pulse, 20 that of volumes.
double receiver_gain_db(const scene::SonarLevel& level, double range_m, double absorption_db_m);

// The receiver clamps powers to this (300 dB re 1 uPa, far above any in water), so that sums of
// thousands of bins stay finite floats.
inline constexpr double kLargestPower = 1e30;

// An intensity of any origin: negative and non-finite values count as silence.
inline float heard(float intensity) {
  return intensity > 0.0f && std::isfinite(intensity) ? intensity : 0.0f;
}

// intensity [range][columns], with 0 where it is below its row's floor. An empty floor changes
// nothing.
std::vector<float> above_floor(std::span<const float> intensity, std::span<const float> floor);

// The value below which a fraction of the values above zero lies; 1 if none is above zero.
double percentile_of_heard(std::span<const float> values, double fraction);

}  // namespace neritic::sonar
