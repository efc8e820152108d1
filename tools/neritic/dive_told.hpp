// The report of a dive without pictures on standard output: a line for each vehicle and
// diver, what endangered the divers, or all of it as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "testbed/devices/device_source.hpp"
#include "testbed/record/dive_record.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// How the steps went.
struct Pace {
  double wall_s = 0.0;
  std::uint64_t dropped = 0;
  std::vector<testbed::DeviceHealth> devices = {};  // as they were at the end
};

// By --json as JSON; with --quiet that alone.
void print_summary(const DiveFlags& flags, const testbed::PhysicsWorld& world,
                   const testbed::PhysicsSimulation& simulation,
                   const testbed::DiveRecorder& recorder, const Pace& pace);

// The text that --json prints.
nlohmann::json summary_json(const DiveFlags& flags, const testbed::PhysicsWorld& world,
                            const testbed::PhysicsSimulation& simulation,
                            const testbed::DiveRecorder& recorder, const Pace& pace);

// Dangers to a diver, and the changes to another tank: keys of the summary and of the
// picture's data (testbed/record/LOG.md). Null: it did not happen.
nlohmann::json dangers_json(const testbed::PhysicsHuman& human,
                            const testbed::HumanFigures& figures);
nlohmann::json changes_json(const testbed::PhysicsHuman& human,
                            const testbed::HumanFigures& figures);

// Words that both forms share: a tank by its number and gas; whether a source's samples were
// refused.
std::string tank_words(const testbed::PhysicsHuman& human, std::uint64_t tank);
bool in_trouble(const testbed::SourceCounts& counts);

}  // namespace neritic::tools
