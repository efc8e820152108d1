// The simplest inbox of a simulation, for tests: messages that replace the inputs.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "engine/sim/simulation.hpp"

namespace neritic::sim::test {

// Messages as they come, from any thread.
template <class M>
class PlainInbox {
 public:
  using Message = M;
  void push(const Message& message) {
    const std::lock_guard lock(mutex_);
    filling_.push_back(message);
  }
  std::span<const Message> drain() {
    draining_.clear();
    const std::lock_guard lock(mutex_);
    std::swap(filling_, draining_);
    return draining_;
  }

 private:
  std::mutex mutex_;
  std::vector<Message> filling_, draining_;
};

template <class Inputs>
void apply_whole(Inputs& inputs, const Inputs& message, std::uint64_t) {
  inputs = message;
}

// A simulation whose messages are whole inputs.
template <class State, class Inputs>
using PlainSimulation = Simulation<State, Inputs, PlainInbox<Inputs>>;

template <class State, class Inputs, class Function>
PlainSimulation<State, Inputs> plain_simulation(const SimulationOptions& options,
                                                const State& state, const Inputs& inputs,
                                                Function step) {
  return PlainSimulation<State, Inputs>(options, state, inputs,
                                        std::make_unique<PlainInbox<Inputs>>(), std::move(step),
                                        apply_whole<Inputs>);
}

}  // namespace neritic::sim::test
