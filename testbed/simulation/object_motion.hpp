// The pose and velocity of a scene's object that moves by physics, from its state: for cameras and
// sonars, missions and histories. World axes. Pure functions; any thread.
#pragma once

#include "testbed/simulation/physics_state.hpp"

namespace neritic::testbed {

struct ObjectMotion {
  Pose world_from_object;  // as drawn: a diver's model stands
  Vec3 velocity_m_s{0.0};  // of the object's origin, over ground
  Vec3 angular_velocity_rad_s{0.0};

  // The velocity of a point that the object carries.
  Vec3 velocity_at(const Vec3& world_m) const {
    return velocity_m_s +
           glm::cross(angular_velocity_rad_s, world_m - world_from_object.position_m);
  }
};

ObjectMotion motion_of(const VehicleState& vehicle);
ObjectMotion motion_of(const HumanPhysics& human);

}  // namespace neritic::testbed
