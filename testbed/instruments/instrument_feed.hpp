// Where a HUD's numbers come from: a simulation in this process, or one that runs elsewhere.
#pragma once

#include <optional>
#include <vector>

#include "hud/shown.hpp"

namespace neritic::testbed {

struct InstrumentNews {
  hud::DiveData data;
  std::vector<hud::StreamHealth> streams;
  std::optional<Vec3> gaze;  // its direction in the world, where it is measured
};

// Owned by the HUD's thread.
class InstrumentFeed {
 public:
  virtual ~InstrumentFeed() = default;
  // The scene time of what read() gives; it goes on while a connection is lost, and falls where an
  // earlier state was restored.
  virtual double time_s() const = 0;
  virtual InstrumentNews read() = 0;
};

}  // namespace neritic::testbed
