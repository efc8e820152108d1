// Limbs as the water feels them: joint rotations followed through a low pass that gives their rates
// as well, so that nothing is ever differenced. A millimetre of noise at 120 Hz would be 35 m/s^2.
// Pure functions; any thread.
#pragma once

#include "diver/kinematics.hpp"

namespace neritic::diver {

// A Butterworth filter of second order on rotations, 3 dB down here (Winter 2009: human movement
// has nothing above 6 Hz).
inline constexpr double kLimbCutoff_hz = 6.0;
// A joint that is farther behind than this follows at 20 rad/s at most, the fastest that limbs move
// by themselves: a sensor that jumps does not throw the body about.
inline constexpr double kMostLag_rad = 0.75;

struct LimbState {
  JointRotations rotation = straight_joints();
  JointRates rate{};  // child against parent, child's axes

  static void fields(auto&& field, auto& self) {
    field("rotation", self.rotation);
    field("rate", self.rate);
  }
};

// dt_s later, wanted held; exact for one axis, stable for any step. wanted: unit quaternions.
// Returns how many joints were farther behind than kMostLag_rad.
int follow_limbs(LimbState& limbs, const JointRotations& wanted, double dt_s);

}  // namespace neritic::diver
