// How noisy gaze is, as it comes: the deviation of its directions from sample to sample, whatever
// the eye does. By medians, which saccades and blinks do not move (as Engbert and Kliegl 2003,
// Vision Research 43, 1035, do with velocities). Bounded memory. One owner, one thread.
#pragma once

#include <array>
#include <cstddef>

#include "engine/core/math.hpp"

namespace neritic::diver {

// The deviation of one component of a plane vector with normal errors, from its lengths: their
// median is 1.1774 deviations (Rayleigh's distribution). Over the last 256 lengths; 0 below eight.
class MedianDeviation {
 public:
  void push(double length);
  double deviation() const { return deviation_; }
  std::size_t count() const { return count_; }

 private:
  std::array<float, 256> lengths_{};
  std::size_t count_ = 0;  // of all that came
  double deviation_ = 0.0;
};

class GazeNoise {
 public:
  // A valid sample, of length 1.
  void push(double time_s, const Vec3& direction);
  // The deviation of one axis, radians; 0 until known. Uses samples 5 ms apart or more, so that the
  // filter of a fast tracker does not hide it.
  double deviation_rad() const { return deviation_.deviation(); }
  std::size_t count() const { return deviation_.count(); }

 private:
  struct Seen {
    double time_s = 0.0;
    Vec3 direction{0.0};
  };
  std::array<Seen, 2> last_{};  // the older one first
  int seen_ = 0;
  MedianDeviation deviation_;
};

}  // namespace neritic::diver
