// Poses as functions of simulated time. Metres; right-handed, Y up, as OpenXR. Plain values.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "tests/fakes/openxr/xr.hpp"

namespace neritic::fakes {

struct Pose {
  glm::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};
};

// a_from_b * b_from_c, and the way back.
Pose operator*(const Pose& a_from_b, const Pose& b_from_c);
Pose inverse(const Pose& pose);
glm::dvec3 transform(const Pose& pose, const glm::dvec3& point);
XrPosef to_xr(const Pose& pose);
Pose from_xr(const XrPosef& pose);
// Degrees: yaw to the left about Y, then pitch up about X, then roll about Z.
glm::dquat from_degrees(double yaw, double pitch, double roll);

// Keys over seconds of simulated time; straight lines and shortest arcs between them, held outside.
class PoseTrack {
 public:
  void set(double time_s, const Pose& pose) { keys_[time_s] = pose; }
  void clear() { keys_.clear(); }
  bool empty() const { return keys_.empty(); }
  Pose at(double time_s) const;

 private:
  std::map<double, Pose> keys_;
};

// A value that holds from its key on; before the first key, nothing.
template <class T>
class StepTrack {
 public:
  void set(double time_s, const T& value) { keys_[time_s] = value; }
  // Null before the first key.
  const T* at(double time_s) const {
    auto next = keys_.upper_bound(time_s);
    return next == keys_.begin() ? nullptr : &std::prev(next)->second;
  }
  // The time of the key that holds at time_s.
  double since(double time_s) const {
    auto next = keys_.upper_bound(time_s);
    return next == keys_.begin() ? 0 : std::prev(next)->first;
  }

 private:
  std::map<double, T> keys_;
};

}  // namespace neritic::fakes
