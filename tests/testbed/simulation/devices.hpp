// Devices that send samples into a dive, and a diver who hovers for them.
#pragma once

#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {

// inputs: of the scene's table.
inline std::string hover_text(const std::string& inputs) {
  return kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                  "inputs = { " + inputs + " }\n");
}

// A device of one stream, open in an inbox.
struct Device {
  Device(SampleInbox& into, const StreamTable& table, const std::string& name,
         const std::string& stream)
      : inbox(into), source(inbox.open(name).value()), stream(table.find(stream).value()) {}
  Device(const TestDive& dive, const std::string& name, const std::string& stream)
      : Device(dive.simulation->inbox(), dive.world->streams(), name, stream) {}
  SampleVerdict say(const Payload& payload) {
    return inbox.push({{stream, source, sequence++, 0, 0}, payload});
  }
  SampleInbox& inbox;
  SourceId source;
  StreamId stream;
  std::uint64_t sequence = 0;
};

inline const GroupState& group(const TestDive& dive, DiverGroup group) {
  return dive.state().humans()[0].groups[static_cast<std::size_t>(group)];
}

}  // namespace neritic::testbed
