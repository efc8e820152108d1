// Forces of water and weight on a moving body, summed over all segments: drag of strips, trailing
// edges, blunt shape; weight and buoyancy at their own centres. Body axes, about the body's origin
// (the middle of the hips). Pure functions without allocation; any thread.
//
// Strips take the crossflow principle (Morison): what flows across a strip's section pulls by its
// speed across, what flows along by friction. A foot's or fin's end sheds the momentum of the water
// that moves with the last section w across while the section itself moves at u ahead:
//   f = m_a w (-u n + 1/2 w t)        (Lighthill 1971, Proc. R. Soc. B 179, 125, eq. 6; u > 0)
// which with the crossflow drag is a wing of low aspect ratio (Jones 1946): C_N = pi/2 A sin a +
// ...
#pragma once

#include "diver/kinematics.hpp"
#include "engine/core/vector6.hpp"

namespace neritic::diver {

// Where the body is in the water.
struct Immersion {
  Vec3 down{0.0, 0.0, 1.0};  // unit, body axes
  double depth_m = 0.0;      // of the body's origin
  // Acceleration of the water itself, Du/Dt, body axes; it acts like a tilted gravity.
  Vec3 water_m_s2{0.0};
};

// Gas that is not part of the body.
struct GasLoad {
  double lungs_m3 = 0.0;
  double jacket_m3 = 0.0;
  Vec3 jacket_at_m{0.0};  // in the thorax
  std::array<double, kMaxTanks> tank_kg{};
};

struct WaterForces {
  Vec6 wrench;
  Mat6 drag;             // the wrench is -drag times velocity, at this speed, where limbs rest
  double power_w = 0.0;  // of the forces on what moves: negative takes energy
};

// velocity: of the body's origin through the water, body axes.
WaterForces water_forces(const Body& body, const Posture& posture, const Vec6& velocity,
                         const Immersion& immersion);

// Weight and buoyancy, as seen from axes that go along with accelerating water: both lean by
// -water_m_s2, so that what has the water's density feels neither (the pull rho V Du/Dt of Froude
// and Krylov, less the body's own inertia).
struct StaticForces {
  Vec6 wrench;
  double power_w = 0.0;
};
StaticForces static_forces(const Body& body, const Posture& posture, const Vec6& velocity,
                           const Immersion& immersion, const GasLoad& load);

// Mass with the water that moves along, about the body's origin, and the momentum that moving limbs
// have while the origin rests: [P; L] = mass nu + limbs.
struct BodyMomentum {
  SpatialMass mass;
  Vec3 linear{0.0}, angular{0.0};
  double limb_energy_j = 0.0;  // of the limbs' own motion
};
BodyMomentum momentum_of(const Body& body, const Posture& posture, const GasLoad& load);

Mat6 matrix_of(const SpatialMass& mass);

}  // namespace neritic::diver
