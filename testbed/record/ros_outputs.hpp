// A run's outputs as messages of ROS 2 packages (sensor_msgs, nav_msgs, marine_acoustic_msgs),
// in its axes: world "map" east, north, up; bodies "NAME/base_link" forward, left, up. Beside the
// readings, the true motion of vehicles, divers and tracked objects (NAME/odometry). README.md has
// the topics. The thread that has the steps.
#pragma once

#include <map>
#include <string>

#include "engine/recording/mcap_out.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

inline constexpr double kOdometry_hz = 60.0;

class RosOutputs {
 public:
  // Borrows both.
  RosOutputs(recording::McapOut& out, const PhysicsWorld& world) : out_(out), world_(world) {}

  // The true motions that are due at that state.
  void step(const sim::Snapshot<PhysicsState>& snapshot);
  // A reading of the newest state. log_ns, stamp_ns: the scene's time now, and when it was
  // captured. False: no message of ROS has all that it says.
  bool output(const Sample& sample, std::int64_t log_ns, std::int64_t stamp_ns);

 private:
  std::uint16_t channel(const std::string& topic, const char* type, const std::string& stream);
  void write(const std::string& topic, const char* type, const std::string& stream,
             std::uint64_t sequence, std::int64_t log_ns, std::int64_t stamp_ns,
             const std::string& bytes);
  void odometry(const std::string& name, const Pose& world_from_model, const Vec3& linear_flu,
                const Vec3& angular_flu, std::int64_t now_ns);

  recording::McapOut& out_;
  const PhysicsWorld& world_;
  std::map<std::string, std::uint16_t> channels_;  // by topic
  std::map<std::string, std::uint16_t> schemas_;   // by type
  std::uint64_t odometries_ = 0;                   // due so far
};

}  // namespace neritic::testbed
