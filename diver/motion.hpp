// Motion of the whole body by what its limbs do to the water: Newton and Euler for the momentum of
// all segments with the water that moves along,
//   d/dt [P; L] = drag of strips and edges + weight + buoyancy,   [P; L] = M(j) nu + h(j, j')
// which is M p'' + D p' + K p = f_g + f_b + sum f_h,k(j, p, c) of the published model with all its
// couplings: M with added mass inside, D the drag linearised, K from weight and buoyancy at their
// own centres. Because momentum is what is stepped, limbs enter by their rates alone, and what no
// force acts on keeps its momentum to the last digits. World north, east, down; body axes forward
// (to the head), starboard, down (out of the belly) about the middle of the hips.
#pragma once

#include "diver/limb_filter.hpp"
#include "diver/water_forces.hpp"

namespace neritic::diver {

struct RootState {
  Vec3 position_ned_m{0.0};
  Quat attitude{1.0, 0.0, 0.0, 0.0};  // ned_from_body
  Vec6 velocity;                      // over ground, body axes

  static void fields(auto&& field, auto& self) {
    field("position_ned_m", self.position_ned_m);
    field("attitude", self.attitude);
    field("velocity", self.velocity);
  }
};

// The water around the body, north, east, down: what moves at one speed everywhere (a current that
// changes with time) has both accelerations alike.
struct WaterFlow {
  Vec3 current_m_s{0.0};        // at the step's start
  Vec3 change_m_s2{0.0};        // of the current where the body is, as it moves
  Vec3 acceleration_m_s2{0.0};  // of the water itself, Du/Dt
  Vec3 waves_m_s{0.0};          // the part of the current that waves make, to and fro
  double head_m = 0.0;          // its pressure is that of still water deeper by this much (waves)

  WaterFlow() = default;
  WaterFlow(const Vec3& steady_m_s) : current_m_s(steady_m_s) {}
  WaterFlow(const Vec3& current, const Vec3& change, const Vec3& acceleration)
      : current_m_s(current), change_m_s2(change), acceleration_m_s2(acceleration) {}
};

// The limbs' part in a step.
struct LimbWork {
  double power_w = 0.0;  // mean mechanical power of all joints; negative: the water moved them
  // To speed up arms and legs against the trunk, each limb for itself: the internal power (Zamparo
  // et al. 2002, J. Exp. Biol. 205, 2665). Slowing down gives nothing back.
  double moving_w = 0.0;
};

// One step: limbs go from before to after, the root follows. Trapezoidal in time where drag is
// slow, more implicit as it gets stiffer, so that no step overshoots; of second order while dt_s
// times the drag's rate is below 2. Everything is finite if it was. Water that speeds up pulls by
// (rho V + M_A) Du/Dt: in the momentum through the water, M (a - b) + (rho V - M_RB) a, with a the
// water's own acceleration and b the current's change where the body is.
LimbWork move_root(const Body& body, RootState& root, const LimbState& before,
                   const LimbState& after, const GasLoad& load, const WaterFlow& water,
                   double dt_s);

// Momentum of everything, water that moves along included, about a fixed point of the world: what
// no force changes.
struct WorldMomentum {
  Vec3 linear_ned{0.0}, angular_ned{0.0};
};
WorldMomentum world_momentum(const Body& body, const RootState& root, const LimbState& limbs,
                             const GasLoad& load, const Vec3& about_ned_m);
// 1/2 of velocities times momenta, joule.
double kinetic_energy(const Body& body, const RootState& root, const LimbState& limbs,
                      const GasLoad& load);

}  // namespace neritic::diver
