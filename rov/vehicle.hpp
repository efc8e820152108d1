// A vehicle: its parameters as a person writes them, and a Vehicle that was checked and
// prepared from them. Body axes forward, starboard, down (Fossen's), about the body's origin. Plain
// values that do not change while a simulation runs; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "rov/battery.hpp"
#include "rov/tether.hpp"
#include "rov/thruster_lag.hpp"
#include "rov/vector6.hpp"

namespace neritic::rov {

// So that a state can be copied as bytes.
inline constexpr std::size_t kMaxThrusters = 16;

// A thruster pushes the body with its force along direction (a unit vector), at position_m.
struct Thruster {
  Vec3 position_m{0.0};
  Vec3 direction{1.0, 0.0, 0.0};
  // The motor's limits; a command beyond is clamped.
  double min_n = -1e9, max_n = 1e9;
  double propeller_m = 0.076;  // its diameter: near the surface it draws air (ventilation.hpp)
};

// Symbols as in Fossen, "Handbook of Marine Craft Hydrodynamics and Motion Control" (2011).
struct VehicleParameters {
  std::string name;
  double mass_kg = 0.0;
  Mat3 inertia_kg_m2{0.0};      // I_CO, about the body's origin
  Vec3 gravity_centre_m{0.0};   // r_g
  Vec3 buoyancy_centre_m{0.0};  // r_b
  double weight_n = 0.0;        // W
  double buoyancy_n = 0.0;      // B
  Mat6 added_mass;              // M_A, positive
  Mat6 linear_damping;          // D_L, positive
  Vec6 quadratic_damping;       // D_Q, positive; each axis its own |v| v
  std::vector<Thruster> thrusters;
  ThrusterLag lag;  // of all thrusters
  std::optional<Tether> tether;
  std::optional<Battery> battery;
};

// Number of step lengths for which the lag's exact map is stored.
inline constexpr std::size_t kMaxPrepared = 16;

// Checked and prepared. Trivially destructible: steps only read it.
struct Vehicle {
  double mass_kg = 0.0, weight_n = 0.0, buoyancy_n = 0.0;
  double displaced_kg = 0.0;  // rho V, m B / W; the mass where nothing has weight
  Vec3 gravity_centre_m{0.0}, buoyancy_centre_m{0.0};
  Mat6 rigid_mass;    // M_RB
  Mat6 mass;          // M = M_RB + M_A
  Mat6 inverse_mass;  // contacts are solved against it too
  Mat6 linear_damping;
  Vec6 quadratic_damping;
  std::uint32_t thruster_count = 0;
  std::array<Thruster, kMaxThrusters> thrusters;
  std::array<Vec6, kMaxThrusters> thruster_wrench;  // of one newton each: the columns of B
  double ventilates_m = 0.0;  // none of its propellers draws air where the origin is deeper
  PreparedLag lag;
  std::optional<Tether> tether;
  // Cached for quick steps (prepare_steps()); other steps compute it.
  std::array<LagPropagator, kMaxPrepared> prepared;
  // Bounds of how fast things change, for the choice of substeps (step.cpp).
  double damping_rate = 0.0;   // 1/s, of linear damping
  Vec6 quadratic_rate;         // 1/s a m/s or rad/s, of quadratic damping
  double righting_rate = 0.0;  // rad/s, of weight and buoyancy
  double munk_rate = 0.0;      // rad/s a m/s, of the Munk moment
  double tether_rate = 0.0;    // 1/s, of a taut tether
};

// Errors name the parameter, what was found and what is accepted: masses are positive, matrices
// positive definite (damping: semidefinite), everything finite.
Result<Vehicle> make_vehicle(const VehicleParameters& parameters);

// Computes once what steps of these lengths compute again and again, so that they take less time
// and keep their bits. Up to three lengths.
void prepare_steps(Vehicle& vehicle, std::span<const double> steps_s);
// The lag's exact map over h_s.
LagPropagator propagator(const Vehicle& vehicle, double h_s);

// M_RB of Fossen 2011, eq. 3.44: the rigid body's own mass matrix about the body's origin.
Mat6 rigid_mass_matrix(double mass_kg, const Vec3& gravity_centre_m, const Mat3& inertia_kg_m2);

}  // namespace neritic::rov
