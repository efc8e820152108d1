// Things that grippers and hands hold, carry and hand over: a part of the step. A thing is a point
// mass with weight, buoyancy, drag and the added mass of a sphere; while it is held, an impulse at
// the grip in each step makes it move as the grip does (engine/sim/grip), so that its weight, its
// drag and its inertia pull at the holder, and grabbing keeps momentum. Built once, then only read;
// the step is pure. World axes: x east, y up, z south.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/sim/grip.hpp"
#include "testbed/simulation/human_world.hpp"
#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {

// Where something is held: a vehicle's gripper, a diver's right hand.
struct PhysicsGrip {
  OwnerSort sort = OwnerSort::kVehicle;
  std::uint32_t owner = 0;
  Vec3 at_m{0.0};  // of a vehicle: its model axes. A diver's: the joints say
  scene::Grip settings;
};
struct PhysicsThing {
  std::uint32_t object = 0;  // in PhysicsState::objects()
  scene::Thing settings;
  double moving_kg = 1.0;  // with its added mass
  sim::BodyShape shape;    // a sphere of its volume
  double radius_m = 1e-3;  // of that sphere
  sim::InverseMass inverse_mass{};
  Pose start;
};

// Bodies on the way through a step.
struct CarryingBody {
  const sim::InverseMass& inverse_mass;
  sim::BodyMotion& free;
};

// The water at a thing, world axes.
struct ThingWater {
  Vec3 current_m_s{0.0};
  double head_m = 0.0;          // of waves: the surface lies that much higher
  Vec3 acceleration_m_s2{0.0};  // of waves: of the water itself
};

class Things {
 public:
  static Result<Things> create(const scene::Scene& scene, const Movers& movers);

  bool any() const { return !things_.empty(); }
  const std::vector<PhysicsThing>& things() const { return things_; }
  const std::vector<PhysicsGrip>& grips() const { return grips_; }
  std::optional<std::size_t> find(OwnerSort sort, std::uint32_t owner) const;
  void start(PhysicsState& state) const;
  // The place of a grip, and its velocity.
  Motion grip_motion(std::size_t grip, std::span<const PhysicsHuman> humans,
                     const PhysicsState& state) const;
  // Where a diver's hand reaches for what a gripper holds out; none: for nothing.
  std::optional<Vec3> reaches_for_m(std::uint32_t human, std::span<const PhysicsHuman> humans,
                                    const PhysicsState& before) const;

  // At the step's start, in the order of the scene: what is let go, handed over and grabbed.
  void choose(std::span<const PhysicsHuman> humans, const PhysicsInputs& inputs,
              const PhysicsState& before, PhysicsState& after) const;
  // A thing, which must be held, pulls at its holder; body: of the grip in this step.
  void pull(std::size_t thing, std::span<const PhysicsHuman> humans, const CarryingBody& body,
            const ThingWater& water, double water_kg_m3, double dt_s, PhysicsState& after) const;
  // At the step's end: held things are where their grip is, free ones fall among what is solid.
  void finish(std::span<const PhysicsHuman> humans, const sim::StaticWorld& solid,
              const std::vector<ThingWater>& waters, double water_kg_m3, double dt_s,
              sim::ContactMemory& memory, PhysicsState& after) const;

 private:
  double density_at(double height_m, double otherwise_kg_m3) const {
    return column_ ? column_->density_kg_m3(-height_m) : otherwise_kg_m3;
  }
  Vec3 on_body_m(const PhysicsGrip& grip, std::span<const PhysicsHuman> humans,
                 const PhysicsState& state) const;

  std::vector<PhysicsThing> things_;
  std::optional<WaterColumn> column_;  // whose density carries them, where it is named
  std::vector<PhysicsGrip> grips_;
};

// The share of a thing that is under water, as of a float between its radius above and below.
double wet_share(const PhysicsThing& thing, double height_m);

// The velocity of a thing after dt_s of weight, buoyancy and drag in that water; stable for any
// dt_s. Closed form of a fall from rest: v_t tanh(t / tau), v_t = sqrt(2 (m - rho V) g / (rho C_d
// A)), tau = (m + 0.5 rho V) v_t / ((m - rho V) g).
Vec3 fallen(const PhysicsThing& thing, const Motion& motion, const ThingWater& water,
            double water_kg_m3, double dt_s);

GripReading grip_reading(const Things& things, std::size_t grip,
                         std::span<const PhysicsHuman> humans, const PhysicsState& state);

}  // namespace neritic::testbed
