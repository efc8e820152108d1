// The pairs of vehicles and divers that may touch in a step: a sweep along one axis over spheres
// that contain each body's way through the step. Pairs come in the fixed order in which they are
// solved: vehicles first, then each diver with all vehicles and with the divers after it. Owns its
// memory, kept from step to step; one thread.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::testbed {

// Where a body may touch another in the step. A reach that is not finite meets everything.
struct PairSphere {
  Vec3 centre_m{0.0};  // finite
  double reach_m = 0.0;
};

// Two bodies by their index among vehicles, then divers. first < second, but a diver comes before
// the vehicle that it meets: so that the order of pairs is that of their numbers.
struct MeetingPair {
  std::uint32_t first = 0, second = 0;
  auto operator<=>(const MeetingPair&) const = default;
};

class PairFinder {
 public:
  // Begins a step with this many bodies; set() then places every one of them.
  void begin(std::size_t vehicles, std::size_t bodies);
  void set(std::size_t body, const PairSphere& sphere);
  // Finds the pairs of all spheres.
  void find();
  // The next pair in order; nothing after the last.
  std::optional<MeetingPair> next();
  // A body's reach changed because it parted from another. If it grew, pairs still to come may be
  // more.
  void set_reach(std::size_t body, double reach_m);

 private:
  MeetingPair pair_of(std::size_t a, std::size_t b) const;
  bool near(std::size_t a, std::size_t b) const;

  std::vector<PairSphere> spheres_;
  std::vector<std::uint32_t> order_;  // by where spheres begin along the axis
  std::vector<MeetingPair> pairs_;    // ascending
  std::size_t vehicles_ = 0, taken_ = 0;
};

}  // namespace neritic::testbed
