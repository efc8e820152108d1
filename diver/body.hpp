// A diver's body with gear, prepared for motion: what each segment weighs, how much water it
// displaces and drags along, and the strips on which water pulls. Checked once by make_body, then
// only read; trivially copyable. Body axes forward (to the head), starboard, down (out of the
// belly); the body's origin is the middle of the hips, each segment's its joint.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "diver/anthropometry.hpp"
#include "diver/exertion.hpp"
#include "diver/gear.hpp"
#include "diver/spatial_mass.hpp"
#include "engine/core/layered_water.hpp"

namespace neritic::diver {

inline constexpr double kGravity_m_s2 = 9.80665;
inline constexpr double kSurfacePressure_pa = 101325.0;
inline constexpr double kSeaWater_kg_m3 = 1025.0;

// The joints and axes in which the body may move.
enum class Model : std::uint32_t {
  kFull,    // all joints, six degrees of freedom
  kPlanar,  // hips, knees, ankles and spine bend in the body's middle plane: surge, heave, pitch
};

struct BodyParameters {
  Build build;
  Fitness fitness;
  Gear gear;
  Model model = Model::kFull;
  int strips_a_segment = 6;  // 1 to 64; `neritic tradeoff swim`
  double water_kg_m3 = kSeaWater_kg_m3;
  double surface_pa = kSurfacePressure_pa;  // of the air over it
  double start_depth_m = 5.0;  // where a diver without a jacket is neutral with the default lead
};

// A piece of the body that water flows past: straight, of one section along its length, cut into
// strips. Its axes: along it away from the joint, then across it, first and second.
struct Part {
  std::size_t segment = 0;
  int strips = 1;
  bool flat = false;  // a plate, whose edge feels nothing
  Vec3 start_m{0.0};
  Mat3 segment_from_part{1.0};
  double length_m = 0.0;
  // Half of rho C_d times width, a metre: of motion across (first, second) and of friction along.
  double drag_first = 0.0, drag_second = 0.0, drag_along = 0.0;
  double added_first_kg_m = 0.0, added_second_kg_m = 0.0, added_twist_kg_m = 0.0;
  // Water displaced: by what keeps its volume, and by suit gas at the surface.
  double volume_m3 = 0.0, suit_gas_m3 = 0.0;
  double radius_m = 0.0;  // for what is half out of the water
};

// Where the flow leaves a trailing edge: the end of a foot or a fin.
struct Edge {
  std::size_t part = 0;
  double added_kg_m = 0.0;  // of the section there, across (first axis)
};

// Drag of blunt shape, against the flow, by what of it comes along a segment (forward or back).
struct BluntDrag {
  std::size_t segment = 0;
  Vec3 position_m{0.0};
  double half_rho_area = 0.0;  // 1/2 rho C_d A
  // How much more of it at incidence: times the sine of the angle between flow and segment.
  double incidence = 0.0;
};

struct SegmentBody {
  Vec3 joint_m{0.0};        // in the parent's axes
  SpatialMass rigid, mass;  // without and with the water that moves along; tanks empty
  double mass_kg = 0.0;
  Vec3 mass_centre_m{0.0};
};

struct TankPlace {
  Vec3 position_m{0.0};  // in the thorax
  double water_volume_m3 = 0.0;
  GasMix mix;
  double start_pa = 0.0;
};

// Lung volumes of a man of 75 kg in water up to the neck, in proportion to mass: residual, at rest
// after breathing out, and total (Agostoni et al. 1966, J. Appl. Physiol. 21, 251: immersion takes
// a litre from the resting volume).
struct LungSizes {
  double residual_m3 = 1.3e-3, rest_m3 = 2.5e-3, total_m3 = 6.0e-3;
};

inline constexpr std::size_t kMaxParts = 16 + 2 + 1 + kMaxTanks;

struct Body {
  std::array<SegmentBody, kSegments> segments;
  std::array<Part, kMaxParts> parts;
  std::size_t part_count = 0;
  std::array<Edge, 2> edges;
  std::array<BluntDrag, 2> blunt;
  std::array<TankPlace, kMaxTanks> tanks;
  std::size_t tank_count = 0;
  LungSizes lungs;
  Fitness fitness;       // with the most oxygen of that mass
  Vec3 lungs_at_m{0.0};  // in the thorax
  Jacket jacket;         // scaled to the body; capacity 0: none
  Model model = Model::kFull;
  double height_m = 0.0, water_kg_m3 = 0.0;
  // Whose density carries the body and whose weight presses on it, where it is named.
  std::optional<LayeredWater> layers = {};
  double density_kg_m3(double depth_m) const {
    return layers ? layers->density_kg_m3(depth_m) : water_kg_m3;
  }
  double surface_pa = kSurfacePressure_pa;
  double lead_kg = 0.0;
  // Whether a segment moves by itself; else it is part of the one it hangs on.
  std::array<bool, kSegments> moves{};
};

// Errors name the parameter, what was found and what is accepted.
Result<Body> make_body(const BodyParameters& parameters);

// All of the body and its gear, without gas in tanks; and water displaced at a depth without lungs
// and jacket.
double dry_mass(const Body& body);
double solid_volume(const Body& body, double depth_m);
// Pressure of the water, by the weight of all above; at or above the surface that of the air.
double pressure_at(const Body& body, double depth_m);

}  // namespace neritic::diver
