// A state that steps at a fixed pace: state <- step(state, inputs, step_s). Whoever owns it either
// advances it (lock-step) or starts its thread; both give the same states for the same inputs.
//
// Inputs hold until a message changes them: messages enter by push() from any thread and are
// applied at the next step boundary. What the steps saw is logged, with the hash of each state. A
// step whose result is not finite is refused and counted, and the state before it stays. Readers
// get snapshots (snapshot.hpp). State, Inputs and Message say their fields (fields.hpp).
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/sim/inbox.hpp"
#include "engine/sim/input_log.hpp"
#include "engine/sim/snapshot.hpp"
#include "engine/sim/state_hash.hpp"
#include "engine/sim/step_thread.hpp"

namespace neritic::sim {

struct SimulationOptions {
  double step_s =
      1.0 / kDefaultRate_hz;  // up to kMaxStep_s; a thread needs kMinRate_hz to kMaxRate_hz
  int max_catch_up = 4;       // most steps at once in thread mode
  std::size_t inbox_capacity = 1024;
  int readers = 1;         // ends for snapshots, one a thread that reads
  bool log = true;         // inputs and hashes in memory: 8 bytes a step and what changes
  std::uint64_t seed = 0;  // for the log only
};

template <class State, class Inputs, class Message = Inputs>
class Simulation {
 public:
  using Step = std::function<State(const State&, const Inputs&, double step_s)>;
  using Apply = std::function<void(Inputs&, const Message&)>;

  // step and apply are pure: no clock, file, thread; they run on the stepping thread.
  Simulation(const SimulationOptions& options, const State& state, const Inputs& inputs, Step step,
             Apply apply)
      : options_(options),
        step_(std::move(step)),
        apply_(std::move(apply)),
        inputs_(inputs),
        inbox_(options.inbox_capacity) {
    NERITIC_CHECK(options.step_s > 0.0 && options.step_s <= kMaxStep_s, "step {} s",
                  options.step_s);
    check_fields_cover(state);
    check_fields_cover(inputs);
    NERITIC_CHECK(all_finite(state) && all_finite(inputs), "the start is not finite");
    pair_.newest.state = state;
    pair_.newest.hash = state_hash(state);
    for (int i = 0; i < options.readers; ++i)
      outlets_.push_back(std::make_unique<Outlet>(SnapshotPair<State>{pair_.newest, pair_.newest}));
    log_.step_s = options.step_s;
    log_.seed = options.seed;
    if (options.log) {
      log_.entries.push_back({0, inputs_});
      log_.hashes.push_back(pair_.newest.hash);
    }
  }
  // Messages that are whole inputs replace them.
  Simulation(const SimulationOptions& options, const State& state, const Inputs& inputs,
             Step step) requires std::same_as<Inputs, Message>
      : Simulation(options, state, inputs, std::move(step),
                   [](Inputs& held, const Message& message) { held = message; }) {}

  // Any thread; false where a number in it is not finite.
  bool push(const Message& message) { return inbox_.push(message); }
  InboxCounts inbox_counts() const { return inbox_.counts(); }

  // The index-th end for snapshots, 0 to readers - 1: for one thread, as long as this lives.
  SnapshotReader<State> reader(int index = 0) {
    return SnapshotReader<State>(*outlets_.at(static_cast<std::size_t>(index)));
  }

  // Lock-step: so many steps now. Not while the thread runs.
  void advance(std::uint64_t steps) {
    check_idle();
    for (std::uint64_t i = 0; i < steps; ++i)
      step_once(std::llround(static_cast<double>(pair_.newest.step + 1) * options_.step_s * 1e9));
  }

  // Steps on a thread of its own until stop(); the clock outlives that.
  void start(StepClock& clock) {
    check_idle();
    const double rate_hz = 1.0 / options_.step_s;
    NERITIC_CHECK(rate_hz > kMinRate_hz * 0.999999 && rate_hz < kMaxRate_hz * 1.000001, "{} Hz",
                  rate_hz);
    pair_.newest.due_ns = clock.now();  // blending starts from here
    const StepPacer pacer(rate_hz, options_.max_catch_up, pair_.newest.due_ns);
    thread_ =
        std::make_unique<StepThread>(clock, pacer, [this](TimeNs due_ns) { step_once(due_ns); });
  }
  void stop() {
    if (!thread_) return;
    thread_->stop();
    pace_ = thread_->counts();
    thread_.reset();
  }
  bool running() const { return thread_ != nullptr; }
  // Of the thread that runs or ran last.
  StepPacer::Counts pace() const { return thread_ ? thread_->counts() : pace_; }

  // What follows: not while the thread runs (readers get snapshots instead).
  const Snapshot<State>& newest() const {
    check_idle();
    return pair_.newest;
  }
  const InputLog<Inputs>& log() const {
    check_idle();
    return log_;
  }
  // Any thread: steps whose result was not finite, and inputs that apply() made not finite.
  std::uint64_t refused_states() const { return refused_states_; }
  std::uint64_t refused_inputs() const { return refused_inputs_; }

 private:
  using Outlet = TripleBuffer<SnapshotPair<State>>;

  void check_idle() const { NERITIC_CHECK(!thread_, "the simulation's thread runs"); }

  void take_messages() {
    inbox_.drain(messages_);
    if (messages_.empty()) return;
    const Inputs before = inputs_;
    for (const Message& message : messages_) {
      Inputs changed = inputs_;
      apply_(changed, message);
      if (all_finite(changed))
        inputs_ = changed;
      else
        ++refused_inputs_;
    }
    if (!options_.log || same_bits(before, inputs_)) return;
    // The start's entry stands for step 0 until the first step is taken.
    if (log_.entries.back().step == pair_.newest.step)
      log_.entries.back().inputs = inputs_;
    else
      log_.entries.push_back({pair_.newest.step, inputs_});
  }

  void step_once(TimeNs due_ns) {
    take_messages();
    Snapshot<State>& newest = pair_.newest;
    const State next = step_(newest.state, inputs_, options_.step_s);
    if (!outlets_.empty()) pair_.previous = newest;
    if (all_finite(next)) {
      newest.state = next;
      newest.hash = state_hash(next);
    } else {
      ++refused_states_;
    }
    ++newest.step;
    newest.time_s = static_cast<double>(newest.step) * options_.step_s;
    newest.due_ns = due_ns;
    if (options_.log) log_.hashes.push_back(newest.hash);
    for (const auto& outlet : outlets_) outlet->publish(pair_);
  }

  SimulationOptions options_;
  Step step_;
  Apply apply_;
  Inputs inputs_;
  SnapshotPair<State> pair_;  // the previous one: where there are readers
  Inbox<Message> inbox_;
  std::vector<Message> messages_;  // drained, memory kept
  InputLog<Inputs> log_;
  std::vector<std::unique_ptr<Outlet>> outlets_;
  std::atomic<std::uint64_t> refused_states_{0}, refused_inputs_{0};
  StepPacer::Counts pace_;
  std::unique_ptr<StepThread> thread_;  // last: ends before what it uses
};

struct ReplayReport {
  std::uint64_t steps = 0;                        // taken
  std::optional<std::uint64_t> first_difference;  // the step whose hash differs; 0: the start
};

// Runs a log again. step is the simulation's; stops at the first difference.
template <class State, class Inputs, class Step>
ReplayReport replay(const InputLog<Inputs>& log, const State& start, Step&& step) {
  ReplayReport report;
  State state = start;
  if (log.hashes.empty()) return report;
  if (state_hash(state) != log.hashes[0]) {
    report.first_difference = 0;
    return report;
  }
  std::size_t entry = 0;
  for (std::uint64_t i = 0; i < log.steps(); ++i) {
    while (entry + 1 < log.entries.size() && log.entries[entry + 1].step <= i) ++entry;
    const State next = step(state, log.entries[entry].inputs, log.step_s);
    if (all_finite(next)) state = next;
    ++report.steps;
    if (state_hash(state) != log.hashes[i + 1]) {
      report.first_difference = i + 1;
      return report;
    }
  }
  return report;
}

}  // namespace neritic::sim
