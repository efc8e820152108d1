#include "testbed/motion/snapshot_motion.hpp"

#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {
namespace {

scene::Motion motion_from(const ObjectMotion& object) {
  return {object.world_from_object, object.velocity_m_s, object.angular_velocity_rad_s};
}

}  // namespace

std::vector<MotionHistory::Moved> moved_objects(const PhysicsWorld& world) {
  std::vector<MotionHistory::Moved> moved;
  for (const PhysicsVehicle& vehicle : world.vehicles()) moved.push_back({vehicle.object, {}});
  for (const PhysicsHuman& human : world.humans()) moved.push_back({human.object, human.nodes});
  return moved;
}

MotionSnapshot motion_of(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot) {
  MotionSnapshot out;
  out.time_s = snapshot.time_s;
  for (const VehicleState& vehicle : snapshot.state.vehicles())
    out.motions.push_back(motion_from(motion_of(vehicle)));
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const HumanPhysics& state = snapshot.state.humans()[i];
    out.motions.push_back(motion_from(motion_of(state)));
    out.joints.push_back(drawn_joints(world.humans()[i], state, snapshot.time_s));
  }
  return out;
}

}  // namespace neritic::testbed
