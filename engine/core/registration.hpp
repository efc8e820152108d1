// The rigid transform between two frames from pairs of points that are the same places, by least
// squares: a lab's tracking frame and a scene's. Metres. Pure functions; any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic {

struct PointPair {
  Vec3 from_m{0.0}, to_m{0.0};
};

enum class RegistrationFreedom {
  kLevel,  // a turn about y and a shift: both frames have y up, as tracking systems with gravity do
  kFree,   // any turn and a shift
};

struct Registration {
  Pose to_from;
  double rms_m = 0.0;
  std::vector<double> residual_m;  // of each pair
  // One standard deviation of the turn: that of the residuals over the points' spread across the
  // axis that is known worst. No number if the pairs are as few as the unknowns.
  double turn_error_rad = 0.0;
  // rms_m of the best fit to mirrored points. Where it is far smaller, one frame is left-handed.
  double mirrored_rms_m = 0.0;
};

// Why pairs do not fit, where something simple explains it; empty: they fit, or nothing does.
// Where the residual is above a tenth of how far the points lie apart, "they do not fit".
std::string misfit(std::span<const PointPair> pairs, RegistrationFreedom freedom,
                   const Registration& found);

// Two pairs or more at the least (level), three (free). Errors: too few, no numbers, points that
// spread less than 0.05 m across the axes of the turn, so that it would be a guess.
Result<Registration> register_points(std::span<const PointPair> pairs, RegistrationFreedom freedom);

}  // namespace neritic
