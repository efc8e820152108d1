// The camera that the user of `dive` flies: position, heading and pitch, never rolled. Plain value.
#pragma once

#include "engine/core/math.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/view/dive_input.hpp"

namespace neritic::testbed {

inline constexpr double kMaxPitch_rad = radians(89.0);
// By how much mouse and stick turn the eye; x to starboard, y down.
Vec2 turn_rad_of(const DiveInput& input, double elapsed_s);

// The pose at the same place and heading, without pitch and roll.
Pose level(const Pose& world_from_view);

class FreeCamera {
 public:
  explicit FreeCamera(const Pose& world_from_view) { start_at(world_from_view); }
  void start_at(const Pose& world_from_view);
  // Moves and turns by the controls, which were held for that long.
  void update(const DiveInput& input, double elapsed_s);

  void turn(double to_starboard_rad);

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

// The horizontal course of a body: ahead and the crown of the head point the same way when it
// stands, flies or swims prone. Yaw, positive to port; otherwise_rad where it has none.
double course_of(const Quat& world_from_body, double otherwise_rad = 0.0);

// For scenes without a camera: from above and behind the first sonar, riding along; without
// sonars one that looks at the middle of what the scene holds.
scene::Camera camera_for(const scene::Scene& scene);

}  // namespace neritic::testbed
