// Length, mass, centre and inertia of a body's segments from its height, mass and sex, by the
// tables of de Leva (1996), and volumes by the densities of Dempster. Plain values; any thread.
#pragma once

#include <array>
#include <cstdint>

#include "diver/segments.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

enum class Sex : std::uint32_t { kMale, kFemale };

struct Build {
  Sex sex = Sex::kMale;
  double height_m = 1.78;
  double mass_kg = 75.0;  // without gear
};

// One segment as the tables have it.
struct SegmentMeasures {
  double length_m = 0.0, mass_kg = 0.0;
  // From the upper end: of the trunk and head towards the feet, of the limbs away from the trunk,
  // of the foot from the heel.
  double centre_m = 0.0;
  // About the centre: front to back, side to side, along the segment.
  double sagittal_kg_m2 = 0.0, transverse_kg_m2 = 0.0, longitudinal_kg_m2 = 0.0;
  double volume_m3 = 0.0;  // the thorax with the air that stays in it (Dempster's specimens)
  // The radius of a circular cylinder of that length and volume.
  double radius_m() const;
};

// Heights 1.2 to 2.3 m and masses 30 to 200 kg are accepted; so is a mean width (mass over height)
// within a factor of 2.2 of the tables' own.
Result<std::array<SegmentMeasures, kSegments>> measure_segments(const Build& build);

// Where joints sit that the tables do not name, as shares of the height: hips beside the middle of
// the hip line, shoulders above it.
inline constexpr double kHipAside = 0.0500;
inline constexpr double kShoulderAside = 0.1028;
inline constexpr double kShoulderAbove = 0.3083;
// The foot: the ankle in front of the heel and above the foot's middle line.
inline constexpr double kAnkleFromHeel = 0.0340;
inline constexpr double kAnkleAboveFoot = 0.0200;

}  // namespace neritic::diver
