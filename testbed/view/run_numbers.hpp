// The numbers of a run over its last two minutes, for an operator's graphs: of each vehicle and
// diver that moves by physics, and of the frames. Up to four values a second of the scene, and no
// more than one a picture: each keeps its time. Rendering thread.
#pragma once

#include <string>
#include <vector>

#include "engine/sim/snapshot.hpp"
#include "hud/numbers.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

inline constexpr double kNumbers_hz = 4.0;
inline constexpr double kNumbersShown_s = 120.0;
inline constexpr auto kNumbersKept = static_cast<std::size_t>(kNumbersShown_s * kNumbers_hz);

// A number's unit, metric and imperial, and the metric units that the imperial one has.
struct NumberUnit {
  const char *metric = "", *imperial = metric;
  double size = 1.0;
  const char* name(hud::Units units) const {
    return units == hud::Units::kMetric ? metric : imperial;
  }
  double shown(double value, hud::Units units) const {
    return units == hud::Units::kMetric ? value : value / size;
  }
};

struct RunNumber {
  std::string name;         // "diver depth"
  NumberUnit unit;          // of the values; metric
  bool down = false;        // larger is lower: depths
  double newest = 0.0;      // NaN: not known
  std::vector<float> kept;  // a ring of kNumbersKept, NaN where nothing is known
};

class RunNumbers {
 public:
  // At most kNumbers_hz; a scene time before the last one begins anew.
  void look(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot, double frame_ms,
            double view_scale);
  const std::vector<RunNumber>& all() const { return all_; }
  // How many values each has, and the i-th of one, the oldest first.
  std::size_t count() const { return count_; }
  float at(const RunNumber& number, std::size_t i) const {
    return number.kept[(first_ + i) % kNumbersKept];
  }
  // How long before the newest the i-th was, in the scene's time.
  double age_s(std::size_t i) const { return looked_s_ - times_s_[(first_ + i) % kNumbersKept]; }

 private:
  void add(const std::string& name, const NumberUnit& unit, double value, bool down = false);
  void add_vehicles(const PhysicsWorld& world, const PhysicsState& state);
  void add_divers(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot);
  std::vector<RunNumber> all_;
  std::size_t next_ = 0;               // of all_, while a look adds
  std::size_t first_ = 0, count_ = 0;  // of the rings
  std::vector<double> times_s_ = std::vector<double>(kNumbersKept);
  double looked_s_ = -1e9;
};

}  // namespace neritic::testbed
