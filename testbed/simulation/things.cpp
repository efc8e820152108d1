#include "testbed/simulation/things.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diver/frames.hpp"
#include "diver/kinematics.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Jaws and fingers give way for so long: a jolt counts by what it is over that time, whatever the
// step.
constexpr double kGives_s = 0.02;

constexpr double kSphereAdded = 0.5;  // of the displaced water (Lamb 1932, art. 92)
constexpr double kLeastMoving_kg = 1e-3;
// How far a hand reaches from the shoulder's side of the hips, of the height: an arm of 0.44 and a
// trunk that leans a little.
constexpr double kReachShare = 0.62;

}  // namespace

Result<Things> Things::create(const scene::Scene& scene, const Movers& movers) {
  Things out;
  if (scene.water) out.column_ = scene.water->column;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    const auto add = [&](OwnerSort sort, int owner, const scene::Grip& grip) {
      out.grips_.push_back({sort, static_cast<std::uint32_t>(owner), grip.position_m, grip});
    };
    if (object.dynamics && object.dynamics->gripper)
      add(OwnerSort::kVehicle, movers.vehicle_of_object[i], *object.dynamics->gripper);
    if (object.human && object.human->hands)
      add(OwnerSort::kDiver, movers.human_of_object[i], *object.human->hands);
    if (!object.thing) continue;
    PhysicsThing thing;
    thing.object = static_cast<std::uint32_t>(movers.tracked_of_object[i]);
    thing.settings = *object.thing;
    thing.moving_kg = std::max(
        kLeastMoving_kg, thing.settings.mass_kg +
                             kSphereAdded * scene.physics->water_kg_m3 * thing.settings.volume_m3);
    thing.radius_m = std::max(std::cbrt(0.75 * thing.settings.volume_m3 / std::numbers::pi), 1e-3);
    thing.shape.add_sphere(Vec3(0.0), thing.radius_m);
    // It does not turn while it is free: only its place moves.
    for (std::size_t axis = 0; axis < 3; ++axis)
      thing.inverse_mass[7 * axis] = 1.0 / thing.moving_kg;
    thing.start = scene.world_from(object.mount, 0.0);
    out.things_.push_back(std::move(thing));
  }
  if (out.things_.empty() && !out.grips_.empty())
    return bad_input("{}: gripper or hands found; accepted: beside an object with thing, to hold",
                     scene.path);
  return out;
}

std::optional<std::size_t> Things::find(OwnerSort sort, std::uint32_t owner) const {
  for (std::size_t i = 0; i < grips_.size(); ++i)
    if (grips_[i].sort == sort && grips_[i].owner == owner) return i;
  return std::nullopt;
}

void Things::start(PhysicsState& state) const {
  for (std::size_t i = 0; i < things_.size(); ++i) {
    ObjectState& object = state.objects()[things_[i].object];
    object.placed = 1;
    object.motion = {things_[i].start, Vec3(0.0), Vec3(0.0)};
    state.things()[i].rests = things_[i].settings.racked ? 1 : 0;
  }
}

Vec3 Things::on_body_m(const PhysicsGrip& grip, std::span<const PhysicsHuman> humans,
                       const PhysicsState& state) const {
  if (grip.sort == OwnerSort::kVehicle) return grip.at_m;
  const PhysicsHuman& human = humans[grip.owner];
  const diver::Posture posture =
      diver::posture_of(human.body, state.humans()[grip.owner].human.limbs.rotation, {});
  return world_from_ned(posture[diver::kRightHand].origin_m);
}

Motion Things::grip_motion(std::size_t index, std::span<const PhysicsHuman> humans,
                           const PhysicsState& state) const {
  const PhysicsGrip& grip = grips_[index];
  sim::BodyMotion body;
  if (grip.sort == OwnerSort::kVehicle) {
    const rov::State& at = state.vehicles()[grip.owner].body;
    body = {rov::world_pose(at.position_ned_m, at.attitude),
            {world_from_ned(at.velocity.linear()), world_from_ned(at.velocity.angular())}};
  } else {
    const diver::RootState& at = state.humans()[grip.owner].human.root;
    body = {world_pose(at.position_ned_m, at.attitude),
            {world_from_ned(at.velocity.linear()), world_from_ned(at.velocity.angular())}};
  }
  const Vec3 on = on_body_m(grip, humans, state);
  const Quat& q = body.world_from_body.rotation;
  return {{body.world_from_body.position_m + q * on, q},
          sim::point_velocity(body, on),
          q * body.velocity.angular};
}

std::optional<Vec3> Things::reaches_for_m(std::uint32_t human, std::span<const PhysicsHuman> humans,
                                          const PhysicsState& before) const {
  const auto hand = find(OwnerSort::kDiver, human);
  if (!hand || before.grips()[*hand].held != 0) return std::nullopt;
  const diver::RootState& root = before.humans()[human].human.root;
  const Vec3 chest =
      world_from_ned(root.position_ned_m) +
      world_from_ned(root.attitude * Vec3(0.25 * humans[human].body.height_m, 0.0, 0.0));
  std::optional<Vec3> best;
  double nearest_m = kReachShare * humans[human].body.height_m;
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const std::uint64_t holder = before.things()[i].holder;
    if (holder == 0 || grips_[holder - 1].sort != OwnerSort::kVehicle) continue;
    const Vec3 at = before.objects()[things_[i].object].motion.pose.position_m;
    const double far_m = glm::distance(at, chest);
    if (far_m >= nearest_m) continue;
    nearest_m = far_m;
    best = at;
  }
  return best;
}

void Things::choose(std::span<const PhysicsHuman> humans, const PhysicsInputs& inputs,
                    const PhysicsState& before, PhysicsState& after) const {
  const auto choice = [&](std::size_t grip) { return inputs.grips()[grip].use.choice; };
  const auto give = [&](std::size_t thing, std::uint64_t grip_number) {
    ThingState& state = after.things()[thing];
    if (state.holder != 0) after.grips()[state.holder - 1].held = 0;
    state.holder = grip_number;
    state.rests = 0;
    if (grip_number == 0) return;
    after.grips()[grip_number - 1].held = things_[thing].object + 1;
    ++after.grips()[grip_number - 1].grabs;
    const Quat holder = grip_motion(grip_number - 1, humans, before).pose.rotation;
    state.grip_from_thing = glm::normalize(
        glm::conjugate(holder) * before.objects()[things_[thing].object].motion.pose.rotation);
  };
  for (std::size_t i = 0; i < things_.size(); ++i) {
    ThingState& state = after.things()[i];
    ObjectState& object = after.objects()[things_[i].object];
    if (acting(object.groups.front()) == Authority::kLive) {
      if (state.holder != 0) give(i, 0);  // a device has it
      state.rests = things_[i].settings.racked ? 1 : 0;
      continue;
    }
    object.motion = before.objects()[things_[i].object].motion;
    object.placed = 1;
    const std::uint64_t holder = state.holder;
    const bool slips =
        holder != 0 && after.grips()[holder - 1].load_n > grips_[holder - 1].settings.strength_n;
    if (holder != 0 && (slips || choice(holder - 1) == GripChoice::kOpen)) {
      ++after.grips()[holder - 1].drops;
      give(i, 0);
      continue;  // not grabbed again in the same step
    }
    const Motion& at = before.objects()[things_[i].object].motion;
    for (std::size_t g = 0; g < grips_.size(); ++g) {
      if (g + 1 == state.holder || after.grips()[g].held != 0) continue;
      const scene::Grip& settings = grips_[g].settings;
      const bool by_itself = choice(g) == GripChoice::kByItself;
      // Hands take what a gripper holds out; what nobody holds is grabbed where it is asked for.
      const bool wants = choice(g) == GripChoice::kClose ||
                         (by_itself && grips_[g].sort == OwnerSort::kDiver && state.holder != 0 &&
                          grips_[state.holder - 1].sort == OwnerSort::kVehicle);
      // A closed hand keeps it from another hand: two would take it from one another in every step.
      const bool kept = state.holder != 0 && (grips_[g].sort != OwnerSort::kDiver ||
                                              (grips_[state.holder - 1].sort == OwnerSort::kDiver &&
                                               choice(state.holder - 1) == GripChoice::kClose));
      if (!wants || kept) continue;
      const Motion grip = grip_motion(g, humans, before);
      if (glm::distance(grip.pose.position_m, at.pose.position_m) > settings.reach_m) continue;
      if (glm::distance(grip.velocity_m_s, at.velocity_m_s) > settings.most_m_s) continue;
      if (state.holder != 0) ++state.handovers;
      give(i, g + 1);
      break;
    }
  }
}

double wet_share(const PhysicsThing& thing, double height_m) {
  return std::clamp(0.5 - 0.5 * height_m / thing.radius_m, 0.0, 1.0);
}

Vec3 fallen(const PhysicsThing& thing, const Motion& motion, const ThingWater& water,
            double water_kg_m3, double dt_s) {
  const scene::Thing& settings = thing.settings;
  const Vec3 &velocity_m_s = motion.velocity_m_s, &current_m_s = water.current_m_s;
  const double wet = wet_share(thing, motion.pose.position_m.y - water.head_m);
  const double net_n =
      (settings.mass_kg - wet * water_kg_m3 * settings.volume_m3) * diver::kGravity_m_s2;
  const Vec3 through = velocity_m_s - current_m_s;
  // Water that speeds up pulls at its own mass in the thing's place and at that which moves along.
  const double pulled_kg = water_kg_m3 * settings.volume_m3 + thing.moving_kg - settings.mass_kg;
  const Vec3 pushed = through + Vec3(0.0, -net_n / thing.moving_kg * dt_s, 0.0) +
                      wet * pulled_kg / thing.moving_kg * dt_s * water.acceleration_m_s2;
  // Drag of the speed halfway, implicit: v' = p - k |v'| v', in closed form.
  const double k = wet * 0.5 * water_kg_m3 * settings.drag_area_m2 / thing.moving_kg * dt_s;
  const double speed = glm::length(pushed);
  const double slowed =
      k * speed > 0.0 ? (std::sqrt(1.0 + 4.0 * k * speed) - 1.0) / (2.0 * k) : speed;
  return speed > 0.0 ? current_m_s + pushed * (slowed / speed) : current_m_s;
}

void Things::pull(std::size_t index, std::span<const PhysicsHuman> humans, const CarryingBody& body,
                  const ThingWater& water, double water_kg_m3, double dt_s,
                  PhysicsState& after) const {
  const PhysicsThing& thing = things_[index];
  const ThingState& state = after.things()[index];
  ObjectState& object = after.objects()[thing.object];
  sim::Held held{on_body_m(grips_[state.holder - 1], humans, after),
                 fallen(thing, object.motion, water,
                        density_at(object.motion.pose.position_m.y, water_kg_m3), dt_s),
                 thing.moving_kg};
  const Vec3 impulse = sim::grip_impulse(body.inverse_mass, body.free, held);
  sim::hold(body.inverse_mass, impulse, dt_s, body.free, held);
  object.motion.velocity_m_s = held.velocity_m_s;
  double& load_n = after.grips()[state.holder - 1].load_n;
  load_n += (glm::length(impulse) / dt_s - load_n) * -std::expm1(-dt_s / kGives_s);
}

void Things::finish(std::span<const PhysicsHuman> humans, const sim::StaticWorld& solid,
                    const std::vector<ThingWater>& waters, double water_kg_m3, double dt_s,
                    sim::ContactMemory& memory, PhysicsState& after) const {
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const PhysicsThing& thing = things_[i];
    const ThingState& state = after.things()[i];
    ObjectState& object = after.objects()[thing.object];
    if (acting(object.groups.front()) == Authority::kLive) continue;
    Motion& motion = object.motion;
    if (state.holder != 0) {
      const Motion grip = grip_motion(state.holder - 1, humans, after);
      motion = {{grip.pose.position_m, glm::normalize(grip.pose.rotation * state.grip_from_thing)},
                grip.velocity_m_s,
                grip.angular_velocity_rad_s};
      continue;
    }
    motion.angular_velocity_rad_s = Vec3(0.0);
    if (state.rests != 0) {
      motion.velocity_m_s = Vec3(0.0);
      continue;
    }
    const Quat& q = motion.pose.rotation;
    const Vec3 velocity =
        fallen(thing, motion, waters[i], density_at(motion.pose.position_m.y, water_kg_m3), dt_s);
    const sim::Twist twist{glm::conjugate(q) * velocity, Vec3(0.0)};
    const sim::BodyMotion moved =
        sim::move_body(solid, thing.shape, thing.inverse_mass, motion.pose,
                       {sim::moved(motion.pose, twist, dt_s), twist}, dt_s, memory);
    motion.velocity_m_s = moved.world_from_body.rotation * moved.velocity.linear;
    motion.pose = moved.world_from_body;
  }
  for (GripState& grip : after.grips())
    if (grip.held == 0) grip.load_n = 0.0;
}

GripReading grip_reading(const Things& things, std::size_t index,
                         std::span<const PhysicsHuman> humans, const PhysicsState& state) {
  const GripState& grip = state.grips()[index];
  const Motion at = things.grip_motion(index, humans, state);
  GripReading out{.held = grip.held,
                  .position_m = at.pose.position_m,
                  .velocity_m_s = at.velocity_m_s,
                  .load_n = grip.load_n,
                  .grabs = grip.grabs,
                  .drops = grip.drops};
  for (const PhysicsThing& thing : things.things()) {
    const double far_m =
        glm::distance(state.objects()[thing.object].motion.pose.position_m, at.pose.position_m);
    if (out.nearest_m < 0.0 || far_m < out.nearest_m) out.nearest_m = far_m;
  }
  return out;
}

}  // namespace neritic::testbed
