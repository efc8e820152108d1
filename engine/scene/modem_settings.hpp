// A scene's acoustic modems, and the water that their messages go through (sonar/modem.hpp). Plain
// data: engine/scene knows neither sound nor messages. SI; angles in radians, levels in decibels.
// Any thread.
#pragma once

#include <optional>
#include <string>

#include "engine/core/math.hpp"
#include "engine/scene/sonar_settings.hpp"

namespace neritic::scene {

// A modem that asks another one where it is, as a USBL does: range by the two-way travel time of a
// request and its answer, direction by phase over a short baseline.
struct Ranging {
  std::string target;                       // the object whose modem answers
  double interval_s = 2.0, offset_s = 0.0;  // from request to request; of the first one
  std::optional<double> wait_s;             // for an answer; absent: interval_s
  double range_noise_m = 0.05;              // standard deviations
  double direction_noise_rad = 0.00873;     // across the line of sight, both ways
  std::optional<double> sound_m_s;  // that it reckons with; absent: the water's at its depth
};

// On a vehicle, a diver, or an object that devices move.
struct Modem {
  int object = -1;       // index into Scene::objects
  Vec3 position_m{0.0};  // on the object, its own axes
  double source_level_db = 170.0;
  double frequency_hz = 25e3, bandwidth_hz = 8e3;
  double bit_rate_hz = 500.0, preamble_s = 0.05;
  double coding_gain_db = 3.0, detection_db = 3.0;
  double self_noise_db = 0.0;  // spectrum level, re 1 uPa^2/Hz; 0: none
  bool fading = true;
  double turnaround_s = 0.5;  // from a request's first sound to its answer's
  std::optional<Ranging> usbl;
};

// [acoustics]: absent, these defaults.
struct Acoustics {
  double temperature_c = 10.0, salinity_psu = 35.0, ph = 8.0;
  SonarTable profile;  // depth in metres, m/s; empty: by the above
  enum class Path { kConstant, kStraight, kBent };
  Path path = Path::kStraight;
  double spreading = 2.0;
  double wind_m_s = 5.0, shipping = 0.5;  // of the ambient noise
};

}  // namespace neritic::scene
