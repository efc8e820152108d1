// A scene's physics settings: the step, the current, what drives a vehicle and where it is to go,
// what is solid. Plain data: engine/scene knows neither the simulation nor vehicles. World frame: Y
// up, metres, seconds; headings in radians from north (-z) towards east (+x). Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

// [physics]: absent, nothing is simulated.
struct Physics {
  double rate_hz = 240.0;
  std::string integrator = "guarded";  // guarded, rk4, semi_euler
  double max_error_m = 0.0;            // over 0: the cheapest rate that holds it, in place of both
  double water_kg_m3 = 1028.0;         // of sea water (von Benzon et al. 2022)
  double altitude_m = 0.0;             // of the water's surface above the sea
};

// [current]: absent, the water rests.
struct Current {
  enum class Kind { kUniform, kPowerLaw, kLinear, kGrid };
  Kind kind = Kind::kUniform;
  Vec3 velocity_m_s{0.0};  // power law, linear: at the surface
  Vec3 deep_velocity_m_s{0.0};
  double depth_m = 50.0, exponent = 1.0 / 7.0;
  // A grid's samples, and how they lie.
  std::filesystem::path file;
  Vec3 origin_m{0.0}, spacing_m{1.0};
  double start_s = 0.0, interval_s = 1.0;
};

// A place to face, follow or go round: an object's, or a fixed one.
struct Aim {
  int object = -1;  // index into Scene::objects; -1: the point
  Vec3 point_m{0.0};
};

// Where a vehicle faces. Neither is set: along its path; without a path, as before.
struct Facing {
  std::optional<double> heading_rad;
  std::optional<Aim> look_at;
  bool tilt = false;  // pitch follows too
};

struct MissionWaypoint {
  Vec3 position_m{0.0};
  Facing facing;        // none: the mission's
  double hold_s = 0.0;  // stays so long
};

// Against which a speed counts, ground or water: they differ in a current.
enum class SpeedOver { kGround, kWater };

// Where a vehicle is to go; exactly what kind says.
struct Mission {
  enum class Kind { kStation, kWaypoints, kOrbit, kFollow, kStandBetween };
  Kind kind = Kind::kStation;
  Facing facing;
  // Waypoints: each counts as reached within acceptance_m. speed_m_s of them: along the line
  // between; 0: as fast as it can.
  std::vector<MissionWaypoint> waypoints;
  double acceptance_m = 0.15;
  double speed_m_s = 0.0;  // orbit: positive from north to east
  SpeedOver speed_over = SpeedOver::kGround;
  bool repeat = false;
  // Orbit: round target. Follow: beside it, (starboard, up, back) of its heading.
  Aim target;
  double radius_m = 1.0;
  Vec3 offset_m{0.0};
  // Stand between a and b, so far from b (negative: in the middle), facing it.
  Aim between_a, between_b;
  double distance_m = -1.0;
};

// The source that a group of inputs of an object listens to (testbed/samples/README.md).
struct InputChoice {
  std::string group;               // "body", "wrench"
  std::string from;                // "autopilot", "recording", "nobody", or a live source's name
  std::optional<double> hold_s;    // how long a silent live source's newest value holds
  std::string then = "autopilot";  // afterwards: "autopilot" or "nobody"
};

// An object that grippers and hands can carry: a point with weight, buoyancy and drag.
struct Thing {
  double mass_kg = 1.0;
  double volume_m3 = 0.5e-3;   // of the water that it displaces
  double drag_area_m2 = 0.01;  // C_d A
  bool racked = false;         // stays where it is until it is grabbed for the first time
};
// A vehicle's gripper, or a diver's hands, of which the right one holds.
struct Grip {
  Vec3 position_m{0.0};      // of a gripper, its vehicle's own axes
  double reach_m = 0.12;     // that a thing may be off
  double strength_n = 97.0;  // a larger pull slips (Newton Subsea Gripper, 97 N at the tips)
  double most_m_s = 0.25;    // faster past each other, nothing is grabbed
};

// The jets of a vehicle's thrusters, which push divers and things.
struct Wash {
  double diameter_m = 0.076;  // of a T200's propeller
  double reach_m = 10.0;
};

// A vehicle's tether with weight, drag and sag, from a top in the world or on an object
// (rov/cable.hpp). That top is where the object stands as which the tether is drawn.
struct Tether {
  std::size_t object = 0;  // index into Scene::objects
  Vec3 attachment_m{0.0};  // on the vehicle, its own axes
  double length_m = 50.0;  // paid out at the start
  std::uint32_t segments = 16;
  double diameter_m = 0.0076, net_weight_n_m = 0.0;
  double stiffness_n = 2e4, damping_n_s = 200.0;
  double normal_drag = 1.2, tangential_drag = 0.01, friction = 0.3;
  // Pays out and takes in to keep a tension at the top.
  struct Winch {
    double hold_n = 20.0, speed_m_s = 0.5, least_m = 1.0, most_m = 100.0;
  };
  std::optional<Winch> winch;
};
// As many joints of a drawn tether lie on a segment.
inline constexpr std::uint32_t kTetherJoints = 4;

// Settings of an object that is a vehicle with its own physics.
struct Dynamics {
  std::filesystem::path file;          // its parameters
  std::optional<Mission> mission;      // absent: nobody steers
  std::uint64_t failed_thrusters = 0;  // bit i: the file's thruster i + 1
  std::optional<Vec3> tether_anchor_m;
  std::optional<Tether> tether;  // beside a file without one
  std::optional<Grip> gripper;
  std::optional<Wash> wash;      // absent: thrusters move no water but by their force
  bool near_added_mass = false;  // added mass by how near the bottom and the surface are
  // The state that control and guidance use: the vehicle's own sensors, or its true state.
  // kBySensors: the sensors, if it has enough of them.
  enum class Navigation { kBySensors, kTruth, kMeasured };
  Navigation navigation = Navigation::kBySensors;
  std::vector<InputChoice> inputs;  // groups not named: autopilot
};

// Where a diver swims: from point to point, each counting as reached within acceptance_m. At the
// last one, unless it repeats, the diver stays. Or how the limbs move, recorded, wherever that
// leads.
struct SwimPlan {
  std::vector<Vec3> waypoints_m;
  std::filesystem::path motion;  // instead of waypoints; empty: none
  double speed_m_s = 0.4;
  SpeedOver speed_over = SpeedOver::kWater;
  double acceptance_m = 1.5;
  bool repeat = false;
};

// How gas and cold change a diver who does not notice (diver/condition.hpp).
struct Condition {
  std::vector<std::string> effects;  // empty: all
  bool acts = true;                  // on what the diver does
  std::optional<double> water_c;     // absent: that of the water's layers, or 12
  double fat_share = 0.15;
  std::optional<double> oxygen_tolerance;  // absent: drawn from the scene's seed
};

// A diver's regulator that blows gas off by itself, from at_s until until_s.
struct FreeFlow {
  double at_s = 0.0, until_s = 1e9;
  std::uint64_t tank = 0;  // of the diver's file, from 0
  double area_m2 = 10e-6;  // of the open valve
};
// A diver's regulators: a buddy's second one, and own ones that fail.
struct Regulator {
  std::string donor;  // the diver whose gas this one breathes without any; empty: nobody
  std::uint64_t donor_tank = 0;
  double hose_m = 1.0;      // the farthest that both mouths may be apart
  double reaction_s = 5.0;  // from want in reach until it is breathed
  std::vector<FreeFlow> free_flows;
};

// Settings of an object that is a diver who swims by moving limbs.
struct Human {
  std::filesystem::path file;    // body and gear
  std::optional<SwimPlan> swim;  // absent: hovers
  // The jacket's buttons over time: from its first row on they are pressed so. Empty: none.
  std::filesystem::path jacket_buttons;
  std::optional<Condition> condition;  // absent: not computed
  std::optional<Grip> hands;
  std::optional<Regulator> regulator;  // absent: breathes from its own tanks, which hold
  // Groups not named: their recording where there is a file, else autopilot.
  std::vector<InputChoice> inputs;
};

// Whether vehicles can touch an object, and as what.
enum class Collision { kNone, kMesh, kHull };

}  // namespace neritic::scene
