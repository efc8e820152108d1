// A recorded run again, without a loop: its samples enter before the steps that used them, and each
// state's hash is compared.
#pragma once

#include "testbed/record/run_record.hpp"

namespace neritic::testbed {

struct Replayed {
  std::uint64_t steps = 0;  // taken
  std::optional<std::uint64_t> first_difference;
};

inline Result<Replayed> replay_run(const PhysicsWorld& world, SampleLog log,
                                   const std::string& name) {
  NERITIC_TRY(RecordedSource source, source_of(world, std::move(log), name));
  const auto simulation = world.simulation({.log = false});
  const auto& hashes = source.log().hashes;
  Replayed replayed;
  for (std::uint64_t step = 0; step < hashes.size(); ++step) {
    if (simulation->newest().hash != hashes[step]) {
      replayed.first_difference = step;
      return replayed;
    }
    if (step + 1 == hashes.size()) break;
    NERITIC_TRY_STATUS(source.poll(simulation->inbox(), simulation->newest().time_s));
    simulation->advance(1);
    ++replayed.steps;
  }
  return replayed;
}

}  // namespace neritic::testbed
