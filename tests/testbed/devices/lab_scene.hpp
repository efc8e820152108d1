// A hovering diver whose devices are at ports of this machine, and an outlet into its dive.
#pragma once

#include "testbed/devices/devices.hpp"
#include "tests/net/vectors.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {

inline std::string lab_text(
    const std::string& sources,
    const std::string& swim = "swim = { waypoints_m = [[0, -12, -60]] }\n") {
  return kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne + swim) +
         "[sources]\n" + sources;
}

// One adapter at a dive, without sockets.
struct Bench {
  explicit Bench(const std::string& sources)
      : dive(dive_of(lab_text(sources))),
        source(
            dive.simulation->inbox().open(dive.scene.sources.at(0).name, 15'000'000'000).value()),
        out(dive.simulation->inbox(), source, dive.world->streams(), 0) {}
  // The samples since the last call.
  std::vector<Sample> samples() {
    const auto drained = dive.simulation->inbox().drain();
    return {drained.begin(), drained.end()};
  }
  TestDive dive;
  SourceId source;
  Outlet out;
};

inline void expect_adds_up(const net::LinkCounts& c) {
  EXPECT_EQ(c.datagrams, c.used + c.malformed + c.unused + c.repeated + c.older);
}

}  // namespace neritic::testbed
