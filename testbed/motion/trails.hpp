// Where points that leave bubbles or silt behind were, for as long as what they left is seen:
// places 40 times a second, on the line between. Plain value; one thread. Times are scene time, in
// seconds.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "testbed/simulation/followed_points.hpp"

namespace neritic::testbed {

class Trails {
 public:
  explicit Trails(std::vector<FollowedPoint> points);

  // Whether a state of that time is to be added: the first in each fortieth of a second. Never
  // where there are no points.
  bool due(double time_s) const;
  // The speed of the water that thrusters drive at a point of the world.
  using Wash = std::function<double(const Vec3&)>;
  // Times rise. moved, wash: the state of that time.
  void add(const scene::SimulatedMotion& moved, double time_s, const Wash& wash);
  void clear();
  // Nothing: such a point is not followed, or time_s is not before the newest place. Before
  // the oldest it was there.
  std::optional<scene::FollowedPlace> at(std::size_t object, int joint, const Vec3& position_m,
                                         double time_s) const;

 private:
  struct Place {
    double time_s;
    scene::FollowedPlace place;
  };
  std::vector<FollowedPoint> points_;
  std::vector<std::deque<Place>> places_;  // by point, times rising
  std::optional<std::int64_t> newest_;     // fortieth of a second
};

}  // namespace neritic::testbed
