// Runs a simulation's log again with nothing but its step function: an oracle of its hashes that
// shares neither its loop nor its inbox.
#pragma once

#include "engine/sim/simulation.hpp"

namespace neritic::sim::test {

// Runs a log again. step and apply are the simulation's; stops at the first difference.
template <class State, class Inputs, class Message, class Function, class Apply>
ReplayReport replay(const RunLog<Inputs, Message>& log, const State& start, Function function,
                    Apply&& apply) {
  ReplayReport report;
  const auto step = step_of<State, Inputs>(std::move(function));
  State state = start, next = start;
  Inputs inputs = log.start;
  std::size_t entry = 0;
  for (std::uint64_t i = 0; i < log.hashes.size(); ++i) {
    const std::uint64_t now = log.first_step + i;
    if (state_hash(now, state) != log.hashes[i]) {
      report.first_difference = now;
      return report;
    }
    if (i == log.steps()) return report;
    for (; entry < log.entries.size() && log.entries[entry].step <= now; ++entry)
      apply(inputs, log.entries[entry].message, now);
    step(state, inputs, StepTime{now, log.step_s}, next);
    if (all_finite(next)) std::swap(state, next);
    ++report.steps;
  }
  return report;
}

}  // namespace neritic::sim::test
