#include "testbed/simulation/object_motion.hpp"

#include <cmath>

#include "diver/frames.hpp"
#include "diver/human_step.hpp"
#include "rov/frames.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {
namespace {

// velocity: linear and angular, body axes, marine.
Motion moving(const Pose& world_from_object, const Quat& ned_from_body, const Vec6& velocity) {
  return {world_from_object, world_from_ned(ned_from_body * velocity.linear()),
          world_from_ned(ned_from_body * velocity.angular())};
}

// How much wider and deeper the drawn jacket is with its gas than empty, as it was built. The gas
// lies about it in a layer of even thickness d: in section the jacket is an ellipse of half axes
// a = 0.195 and b = 0.146 m, over h = 0.33 m of the trunk's height (bcd() of
// tools/assets/diver_gear.py), and
//   V = pi h ((a + d)(b + d) - a b)
// 18 litres are d = 45 mm. In metres of the model.
Vec3 swollen_jacket(const PhysicsHuman& human, const diver::HumanState& state) {
  constexpr double kHalfWidth_m = 0.195, kHalfDepth_m = 0.146, kHeight_m = 0.33;
  if (!(human.body.jacket.capacity_m3 > 0.0)) return Vec3(1.0);
  const double gas_m3 =
      diver::jacket_gas(human.body, state.life.jacket_moles, diver::thorax_place(human.body, state))
          .volume_m3;
  const double scaled_m3 = gas_m3 / (human.scale * human.scale * human.scale);
  constexpr double kSum_m = kHalfWidth_m + kHalfDepth_m;
  const double d_m =
      0.5 * (std::sqrt(kSum_m * kSum_m + 4.0 * scaled_m3 / (kPi * kHeight_m)) - kSum_m);
  return {1.0 + d_m / kHalfWidth_m, 1.0, 1.0 + d_m / kHalfDepth_m};
}

}  // namespace

Motion motion_of(const VehicleState& vehicle) {
  const rov::State& body = vehicle.body;
  return moving(world_pose(body.position_ned_m, body.attitude), body.attitude, body.velocity);
}

Motion motion_of(const HumanPhysics& human) {
  const diver::RootState& root = human.human.root;
  return moving(drawn_pose(human), root.attitude, root.velocity);
}

std::optional<Motion> motion_of(const ObjectState& object) {
  if (object.placed == 0) return std::nullopt;
  return object.motion;
}

Movers::Movers(const scene::Scene& scene)
    : vehicle_of_object(scene.objects.size(), -1),
      human_of_object(vehicle_of_object),
      tracked_of_object(vehicle_of_object) {
  int vehicles = 0, humans = 0, tracked = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    if (object.dynamics) vehicle_of_object[i] = vehicles++;
    if (object.human) human_of_object[i] = humans++;
    if (!object.inputs.empty() || object.thing) tracked_of_object[i] = tracked++;
  }
}

std::optional<scene::MotionAt> StateMotion::at(std::size_t object, double) const {
  const auto place = [object](const std::vector<int>& of) { return of.at(object); };
  if (const int i = place(movers_.vehicle_of_object); i >= 0)
    return scene::MotionAt{motion_of(state_.vehicles()[static_cast<std::size_t>(i)])};
  if (const int i = place(movers_.human_of_object); i >= 0)
    return scene::MotionAt{motion_of(state_.humans()[static_cast<std::size_t>(i)])};
  if (const int i = place(movers_.tracked_of_object); i >= 0)
    if (const auto motion = motion_of(state_.objects()[static_cast<std::size_t>(i)]))
      return scene::MotionAt{*motion};
  return std::nullopt;
}

Pose drawn_pose(const HumanPhysics& state) {
  return diver::standing_pose(state.human.root.position_ned_m, state.human.root.attitude);
}

scene::NodeKey drawn_joints(const PhysicsHuman& human, const HumanPhysics& state, double time_s) {
  const auto joints = diver::standing_joints(state.human.limbs.rotation, human.arms_spread_rad);
  scene::NodeKey key{time_s, {Quat(1.0, 0.0, 0.0, 0.0)}, {}};
  for (const Quat& joint : joints) key.rotations.push_back(joint);
  key.scales.assign(diver::kSegments, Vec3(1.0));
  key.scales[diver::kPelvis] = Vec3(human.scale);
  // A breath of a litre makes the chest some 2.5 % wider and 5 % deeper (Konno and Mead 1967, J.
  // Appl. Physiol. 22, 407), the belly likewise; what hangs on the chest keeps its size.
  const double litres = 1e3 * (state.human.life.lungs.volume_m3 - human.body.lungs.rest_m3);
  const Vec3 wider(1.0 + 0.025 * litres, 1.0, 1.0 + 0.05 * litres);
  key.scales[diver::kAbdomen] = wider;
  for (const diver::Segment on_chest : {diver::kHead, diver::kLeftUpperArm, diver::kRightUpperArm})
    key.scales[on_chest] = 1.0 / wider;
  const Vec3 swollen = swollen_jacket(human, state.human);
  for (const DrawnGear& gear : human.gear) {
    key.rotations.push_back(Quat(1.0, 0.0, 0.0, 0.0));
    key.scales.push_back(gear.swells ? gear.scale * swollen : gear.scale);
  }
  return key;
}

scene::NodeKey drawn_joints(const DrawnJoints& drawn, const LimbState& state, double time_s) {
  scene::NodeKey key{time_s, {}, {}};
  if (state.shown == 0) return key;
  key.rotations.push_back(Quat(1.0, 0.0, 0.0, 0.0));
  for (const Quat& joint : diver::standing_joints(state.joints, drawn.arms_spread_rad))
    key.rotations.push_back(joint);
  key.scales.assign(diver::kSegments, Vec3(1.0));
  return key;
}

}  // namespace neritic::testbed
