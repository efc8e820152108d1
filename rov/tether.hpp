// A tether, the named option of a vehicle: a straight elastic cable from an anchor at rest (a ship,
// a clump weight, a winch) to the vehicle. Quasi-static: it has no mass of its own. North, east,
// down and body axes; pure functions, any thread.
//
// Model. The cable of length L spans straight from anchor to attachment, in water that moves
// with the current. Drag a metre is Morison's, 1/2 rho C_n d |u_n| u_n + 1/2 rho pi C_t d |u_t| u_t
// (Morison et al. 1950; C_n 1.2, C_t 0.01: Hoerner 1965 for cylinders), with the cable's own
// velocity growing linearly from 0 at the anchor. The vehicle bears the share of each metre's drag
// s by the lever rule, s from 0 at the anchor to 1; of its net weight, one half. Farther than L the
// cable is taut: E A (distance - L) / L plus damping, never a push. Not modelled: sag, the
// cable's inertia and vortex shedding; slack cables drag as straight ones do.
#pragma once

#include "engine/core/result.hpp"
#include "rov/vector6.hpp"

namespace neritic::rov {

struct Tether {
  Vec3 attachment_m{0.0};  // on the body
  double length_m = 50.0;
  double diameter_m = 0.0076;
  double net_weight_n_m = 0.0;  // in water; negative floats
  double stiffness_n = 2e4;     // E A
  double damping_n_s = 200.0;   // N a unit of strain rate
  double normal_drag = 1.2, tangential_drag = 0.01;
  double water_kg_m3 = 1025.0;
};

// Errors name the value, what was found and what is accepted.
Status check_tether(const Tether& tether);

// The force on the attachment, in world axes. attachment_velocity and current in world axes too.
Vec3 tether_force_n(const Tether& tether, const Vec3& anchor_ned_m, const Vec3& attachment_ned_m,
                    const Vec3& attachment_velocity_m_s, const Vec3& current_m_s);

}  // namespace neritic::rov
