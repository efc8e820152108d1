#include "sonar/levels.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "sonar/acoustics.hpp"
#include "sonar/table.hpp"

namespace neritic::sonar {

using scene::SonarLevel;

double absorption_of(const scene::SonarTerms& terms, double depth_m) {
  if (!terms.level) return 0.0;
  const SonarLevel& level = *terms.level;
  if (level.absorption == SonarLevel::Absorption::kNone) return 0.0;
  if (level.absorption == SonarLevel::Absorption::kFixed) return level.absorption_db_per_m;
  const scene::SonarWater& w = terms.water;
  const double depth_of_m = std::clamp(w.depth_m.value_or(depth_m), 0.0, 12000.0);
  const SeaWater there = w.at(depth_of_m);
  const Water water{there.temperature_c, there.salinity_psu, depth_of_m, w.ph};
  const AbsorptionModel model = level.absorption == SonarLevel::Absorption::kAinslieMcColm
                                    ? AbsorptionModel::kAinslieMcColm
                                    : AbsorptionModel::kFrancoisGarrison;
  return absorption_db_m(model, water, terms.frequency_hz);
}

double echo_power(const SonarLevel& level, double range_m, double absorption_db_m, double strength,
                  double solid_angle) {
  const double r = std::max(range_m, kNearestRange_m);
  const double loss_db =
      level.spreading ? two_way_loss_db(r, absorption_db_m) : 2.0 * absorption_db_m * r;
  const double target_db = db_from_power(strength * solid_angle * r * r);
  return std::min(power_from_db(level.source_level_db - loss_db + target_db), kLargestPower);
}

double noise_level_db(const scene::SonarTerms& terms) {
  NERITIC_CHECK(terms.noise, "the noise of a sonar that names none");
  const scene::SonarNoise& noise = *terms.noise;
  if (noise.level_db) return *noise.level_db;
  const double bandwidth_hz = terms.range_spread.value_or(scene::SonarRangeSpread{}).bandwidth_hz;
  const double ambient_db =
      ambient_noise_db(terms.frequency_hz, noise.wind_m_s, noise.shipping) - noise.directivity_db;
  std::vector<double> levels_db{band_level_db(ambient_db, bandwidth_hz)};
  if (noise.self_db) levels_db.push_back(*noise.self_db);
  return incoherent_sum_db(levels_db);
}

double receiver_gain_db(const SonarLevel& level, double range_m, double absorption_db_m) {
  if (!level.tvg_table.empty()) return level.gain_db + interpolate(level.tvg_table, range_m);
  const double absorption_db = level.tvg_absorption ? 2.0 * absorption_db_m * range_m : 0.0;
  return level.gain_db + level.tvg_log / 20.0 * spherical_spreading_db(range_m) + absorption_db;
}

std::vector<float> above_floor(std::span<const float> intensity, std::span<const float> floor) {
  std::vector<float> out(intensity.begin(), intensity.end());
  if (floor.empty()) return out;
  NERITIC_CHECK(intensity.size() % floor.size() == 0, "{} values for {} rows", intensity.size(),
                floor.size());
  const std::size_t columns = intensity.size() / floor.size();
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!(out[i] >= floor[i / columns])) out[i] = 0.0f;
  return out;
}

double percentile_of_heard(std::span<const float> values, double fraction) {
  std::vector<float> heard;
  for (const float v : values)
    if (v > 0.0f && std::isfinite(v)) heard.push_back(v);
  if (heard.empty()) return 1.0;
  const auto at =
      heard.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(heard.size() - 1));
  std::nth_element(heard.begin(), at, heard.end());
  return *at;
}

}  // namespace neritic::sonar
