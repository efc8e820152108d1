// A school: how the copies of an object swim (flock_motion.hpp). Plain values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

struct Flock {
  std::uint32_t count = 100;
  bool mill = true;  // round the object's place; else all with the object, along its track
  Vec3 radius_m{3.0, 1.5, 3.0};
  double speed_m_s = 0.5;  // of a mill's fish
  std::uint64_t seed = 0;
  double avoid_m = 2.0;                  // how far the nearest fish stay from what they avoid
  std::vector<std::string> avoid_names;  // of objects
  std::vector<std::size_t> avoid;        // the same as indices into Scene::objects
  double scale = 1.0;
  std::string place_avoid;  // "file:line: key", for errors
};
inline constexpr std::uint32_t kMostFlock = 20000;

}  // namespace neritic::scene
