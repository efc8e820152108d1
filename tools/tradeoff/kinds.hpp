// The cases that `neritic tradeoff sonar` measures for each kind of sonar: a sensor with its point
// spread (patterns and pulse) in the given scene, from a few places, and the same with every knob
// and term changed one at a time. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::tools {

// The sampling of a sonar, apart from what it is: what a quality level sets.
struct Knobs {
  double scale = 0.5;                   // G-buffer pixels a cell, linear
  std::uint32_t columns = 1, rows = 1;  // gathered a beam in azimuth, and in elevation
  std::string gather = "plane";
  std::uint32_t bins_range = 0;  // 0: the sensor's
};
scene::Sonar with_knobs(scene::Sonar sonar, const Knobs& knobs);

// One place to listen from.
struct Shot {
  Pose world_from_sonar;
  std::uint32_t frame = 0;  // whose noise is its own, and which of a scanner's steps
};

struct KindSetting {
  scene::Sonar base;  // level off, patterns and pulse on
  Knobs middle;       // at which one knob at a time is changed
  std::vector<Shot> shots;
};

// The five kinds at a scene's first sonar (which the scene must have): the imaging sonar has its
// limits; the others share its place. altitude_m: of the place above the bottom; kinds that look
// down reach as far as that asks for.
std::vector<KindSetting> kind_settings(const scene::Scene& scene, double altitude_m);
// Where the first sonar is.
Pose place_of(const scene::Scene& scene);

// One sensor of a sweep over terms.
struct TermCase {
  std::string name;
  scene::Sonar with, without;
  enum class Judge {
    kImage,    // against the rays, either of them
    kShape,    // the same, without counted after scaling it to the rays' energy
    kSpeckle,  // contrast and mean
    kNoise,    // mean
    kCost,     // nothing to compare: labels
  } judge = Judge::kImage;
};
std::vector<TermCase> term_cases(const KindSetting& kind);

// How the sonar moves where motion is named.
inline const Vec3 kTrackVelocity_m_s{0.3, 0.0, -1.5};
inline constexpr double kTrackYaw_rad_s = radians(10.0);
// A course through a place at time 0.
scene::Mount moving_mount(const Pose& world_from_sonar);

}  // namespace neritic::tools
