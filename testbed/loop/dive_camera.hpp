// The camera that the user of `dive` flies: position, heading and pitch, never rolled. Plain value.
#pragma once

#include "engine/core/math.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/loop/dive_input.hpp"

namespace neritic::testbed {

class FreeCamera {
 public:
  explicit FreeCamera(const Pose& world_from_view) { start_at(world_from_view); }
  void start_at(const Pose& world_from_view);
  // Moves and turns by the controls, which were held for that long.
  void update(const DiveInput& input, double elapsed_s);

  Pose world_from_view() const;
  const Vec3& position_m() const { return position_m_; }
  double speed_m_s() const { return speed_m_s_; }
  double pitch_rad() const { return pitch_rad_; }
  double heading_deg() const;  // from -z (north) towards +x (east), 0 to 360

 private:
  Vec3 position_m_{0.0};
  double yaw_rad_ = 0.0, pitch_rad_ = 0.0;  // yaw positive to port
  double speed_m_s_ = 1.5;
};

// A camera that looks at the middle of what the scene holds, for scenes without one.
scene::Camera camera_for(const scene::Scene& scene);

}  // namespace neritic::testbed
