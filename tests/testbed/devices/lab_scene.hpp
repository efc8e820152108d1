// A hovering diver whose devices are at ports of this machine, and an outlet into its dive.
#pragma once

#include "engine/net/rough_link.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/simulators/simulated_device.hpp"
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

// All samples that a simulator's packets give, which go to the adapter over a link with faults.
template <class Adapter>
std::vector<Sample> run_device(const char* kind, const PersonActs& acts, double seconds,
                               const net::LinkFaults& faults, Adapter& adapter, Bench& bench,
                               const SimulatedDeviceOptions& options = {}) {
  const auto device = simulated_device(kind, options);
  net::RoughLink link(faults);
  std::vector<Sample> out;
  for (TimeNs now = 4 * kMillisecond_ns; now < static_cast<TimeNs>(seconds * 1e9);
       now += 4 * kMillisecond_ns) {
    device->run(acts, now,
                [&](std::vector<std::byte> bytes, TimeNs at) { link.send(at, std::move(bytes)); });
    while (!link.empty() && link.next().due_ns <= now) {
      const auto packet = link.take_next();
      adapter.take(packet.bytes, false, packet.due_ns, bench.out);
    }
    adapter.tick(now, bench.out);
    for (const Sample& sample : bench.samples()) out.push_back(sample);
  }
  return out;
}

}  // namespace neritic::testbed
