// A cable that hangs, drags, lies and snags: segments that only pull, masses where they meet, from
// a top whose motion is given to an end on a body. North, east, down. Pure functions over plain
// bytes; no clock, thread or allocation beyond the work's; any thread.
//
// Model. A length L of n segments of rest length l = L / n. Segment tension T = max(0, E A (l' - l)
// / l + C (l' - max(l_before, l)) / (l dt)), C the damping a unit of strain rate: it never pushes,
// and a slack one does not damp. Half of each segment's mass, weight and drag is at either end.
// Weight in water is given; the line's mass is weight / g + rho A. Drag is Morison's,
// 1/2 rho C_n d |u_n| u_n + 1/2 rho pi C_t d |u_t| u_t a metre, and a moved line carries C_a rho A
// of water along across itself (Morison et al. 1950; C_n 1.2, C_t 0.01: Hoerner 1965; C_a 1). Above
// the surface there is neither, and the weight is that in air. Contacts are half-spaces on points
// of segments with a stiffness of 1e6 N/m and Coulomb's friction, which creeps below 1 mm/s. No
// bending or torsion, no vortex shedding.
//
// The step is backward Euler. All of its forces are gradients of convex functions of the new
// velocities (tension-only springs, powers of speed, half-spaces), so their sum has one minimum,
// whatever the step's length, and Newton's method with a search along each line finds it: blocks of
// 3 x 3 on three diagonals, solved in the number of segments. The body at the end takes part with
// its mass at that point, so that a stiff cable on a light body is stable too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::rov {

inline constexpr std::uint32_t kMostCableSegments = 128;

struct Cable {
  std::uint32_t segments = 16;
  double diameter_m = 0.0076;
  double net_weight_n_m = 0.0;  // in water; negative floats
  double stiffness_n = 2e4;     // E A
  double damping_n_s = 200.0;   // N a unit of strain rate
  double normal_drag = 1.2, tangential_drag = 0.01, added_mass = 1.0;
  double water_kg_m3 = 1028.0, gravity_m_s2 = 9.80665;

  double area_m2() const { return 0.25 * kPi * diameter_m * diameter_m; }
  double line_kg_m() const { return net_weight_n_m / gravity_m_s2 + water_kg_m3 * area_m2(); }
};
// Errors name the value, what was found and what is accepted.
Status check_cable(const Cable& cable);

struct CableNode {
  Vec3 position_ned_m{0.0}, velocity_ned_m_s{0.0};

  static void fields(auto&& field, auto& self) {
    field("position_ned_m", self.position_ned_m);
    field("velocity_ned_m_s", self.velocity_ned_m_s);
  }
};

// Where both ends are in a step. The end moves from position - dt * free_velocity by the velocity
// that the step finds; without a cable it would be the free one.
struct CableEnds {
  Vec3 top_before_ned_m{0.0}, top_after_ned_m{0.0};
  Vec3 end_free_ned_m{0.0};  // after the step, as if there were no cable
  Vec3 end_free_velocity_m_s{0.0};
  Vec3 end_before_velocity_m_s{0.0};
  Mat3 end_mass_kg{0.0};  // of the body at that point; 0: the end is free
};

// A plane that a segment must not pass: gap + n . (its point's way in this step) >= 0.
struct CableContact {
  std::uint32_t segment = 0;  // 0 is at the top
  double share = 0.0;         // of the segment, from its upper end: the point
  Vec3 normal{0.0};           // unit, towards the cable
  double gap_m = 0.0;         // at the step's start
  double friction = 0.3;
};

struct CablePull {
  Vec3 end_velocity_m_s{0.0};
  Vec3 impulse_n_s{0.0};                          // of the cable on the body at its end
  double top_n = 0.0, end_n = 0.0, most_n = 0.0;  // tension of the first, last, tautest segment
  std::uint32_t touching = 0;                     // segments that press on something
  std::uint32_t rounds = 0;                       // of Newton's method
  bool converged = true;
};

// Memory of a step, kept so that none allocates. Its content means nothing between steps.
struct CableWork {
  struct Segment {
    Vec3 along{0.0};  // at the step's start, unit
    double before_m = 0.0;
    double rest_m = 0.0, stiffness_n_m = 0.0;  // with damping
  };
  struct Row {
    Vec3 start{0.0}, velocity{0.0}, inertial{0.0}, constant{0.0}, gradient{0.0}, step{0.0};
    Mat3 mass{0.0}, diagonal{0.0}, coupling{0.0};  // to the next row
    Vec3 current{0.0};
    double wet = 1.0;
  };
  std::vector<Segment> segments;
  std::vector<Row> rows;          // the top is row 0
  std::vector<double> presses_n;  // of each contact
  void reserve(std::uint32_t segments);
};

// currents: at top, nodes and end: segments + 1. nodes: the segments - 1 between them, before and
// after. Precondition: all finite, dt_s > 0, length_m > 0, a checked cable; work for as many
// segments. If a result is not finite, the nodes stay as they were and converged is false.
CablePull step_cable(const Cable& cable, double length_m, const CableEnds& ends,
                     std::span<const Vec3> currents_ned_m_s, std::span<const CableContact> contacts,
                     double dt_s, std::span<CableNode> nodes, CableWork& work);

// At rest between two points in still water: a catenary, which without weight hangs as the
// lightest would; straight where it is too short. Points of equal length of line.
void hang_cable(const Cable& cable, double length_m, const Vec3& top_ned_m, const Vec3& end_ned_m,
                std::span<CableNode> nodes);

// A winch that keeps a tension: the rate of its line, out is positive; none within a tenth.
double winch_rate_m_s(double tension_n, double wanted_n, double most_m_s);

}  // namespace neritic::rov
