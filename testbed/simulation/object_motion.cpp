#include "testbed/simulation/object_motion.hpp"

#include "rov/frames.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {
namespace {

// velocity: linear and angular, body axes, marine.
ObjectMotion moving(const Pose& world_from_object, const Quat& ned_from_body,
                    const Vec6& velocity) {
  return {world_from_object, world_from_ned(ned_from_body * velocity.linear()),
          world_from_ned(ned_from_body * velocity.angular())};
}

}  // namespace

ObjectMotion motion_of(const VehicleState& vehicle) {
  const rov::State& body = vehicle.body;
  return moving(world_pose(body.position_ned_m, body.attitude), body.attitude, body.velocity);
}

ObjectMotion motion_of(const HumanPhysics& human) {
  const diver::RootState& root = human.human.root;
  return moving(drawn_pose(human), root.attitude, root.velocity);
}

}  // namespace neritic::testbed
