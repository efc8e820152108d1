// A state that steps at a fixed rate: state <- step(state, inputs, time). Its owner either advances
// it (lock-step) or starts its thread; both give the same states for the same inputs.
//
// Inputs hold until a message changes them: messages enter by push() from any thread and are
// applied at the next step boundary. The inputs of each step are logged, with the hash of each
// state. A step whose result is not finite is refused and counted: the state before it stays while
// time goes on. Readers get snapshots (snapshot.hpp). State, Inputs and Message list their fields
// (fields.hpp); a state is a plain struct or a block (block.hpp).
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
#include "engine/sim/step_time.hpp"

namespace neritic::sim {

struct SimulationOptions {
  double step_s =
      1.0 / kDefaultRate_hz;  // up to kMaxStep_s; a thread needs kMinRate_hz to kMaxRate_hz
  int max_catch_up = 4;       // most steps at once in thread mode
  std::size_t inbox_capacity = 1024;
  bool log = true;         // keep inputs and hashes in memory: 8 bytes a step, and each change
  std::uint64_t seed = 0;  // for the log only
};

template <class State, class Inputs, class Message = Inputs>
class Simulation {
 public:
  // Writes the state after the step into after, which has the layout of before and any content.
  using Step = std::function<void(const State& before, const Inputs& inputs, const StepTime& time,
                                  State& after)>;
  using Apply = std::function<void(Inputs&, const Message&)>;

  // step is as above, or returns State(before, inputs, step_s). step and apply are pure: no clock,
  // file, thread; they run on the stepping thread.
  template <class StepFunction>
  Simulation(const SimulationOptions& options, const State& state, const Inputs& inputs,
             StepFunction step, Apply apply)
      : options_(options),
        step_(step_of(std::move(step))),
        apply_(std::move(apply)),
        inputs_(inputs),
        source_({state, 0, 0.0, 0, state_hash(0, state)}),
        inbox_(options.inbox_capacity) {
    NERITIC_CHECK(options.step_s > 0.0 && options.step_s <= kMaxStep_s, "step {} s",
                  options.step_s);
    check_fields_cover(state);
    check_fields_cover(inputs);
    NERITIC_CHECK(all_finite(state) && all_finite(inputs), "the start is not finite");
    begin_log();
  }
  // Messages that are whole inputs replace them.
  template <class StepFunction>
  Simulation(const SimulationOptions& options, const State& state, const Inputs& inputs,
             StepFunction step) requires std::same_as<Inputs, Message>
      : Simulation(options, state, inputs, std::move(step),
                   [](Inputs& held, const Message& message) { held = message; }) {}

  // Any thread; false where a number in it is not finite.
  bool push(const Message& message) { return inbox_.push(message); }
  InboxCounts inbox_counts() const { return inbox_.counts(); }

  // Any thread, also while the simulation's thread runs. The reader is dropped before this.
  SnapshotReader<State> reader() { return source_.reader(); }

  // Lock-step: so many steps now. Not while the thread runs.
  void advance(std::uint64_t steps) {
    check_idle();
    for (std::uint64_t i = 0; i < steps; ++i) step_once(simulated_ns(source_.newest().step + 1));
  }

  // Goes on from a state that was saved after so many steps. Messages not yet applied are dropped;
  // the log begins anew. Layouts as at construction; everything finite. Not while the thread runs.
  void restore(std::uint64_t step, const State& state, const Inputs& inputs) {
    check_idle();
    NERITIC_CHECK(all_finite(state) && all_finite(inputs), "the restored state is not finite");
    inbox_.drain(messages_);
    inputs_ = inputs;
    source_.restart({state, step, static_cast<double>(step) * options_.step_s, simulated_ns(step),
                     state_hash(step, state)});
    begin_log();
  }

  // Steps on a thread of its own until stop(); the clock outlives that.
  void start(StepClock& clock) {
    check_idle();
    const double rate_hz = 1.0 / options_.step_s;
    NERITIC_CHECK(rate_hz > kMinRate_hz * 0.999999 && rate_hz < kMaxRate_hz * 1.000001, "{} Hz",
                  rate_hz);
    Snapshot<State> now = source_.newest();
    now.due_ns = clock.now();  // blending starts from here
    source_.restart(now);
    const StepPacer pacer(rate_hz, options_.max_catch_up, now.due_ns);
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
  // The counts of the thread that runs or ran last.
  StepPacer::Counts pace() const { return thread_ ? thread_->counts() : pace_; }

  // The next three: not while the thread runs (readers get snapshots instead).
  const Snapshot<State>& newest() const {
    check_idle();
    return source_.newest();
  }
  const Inputs& inputs() const {
    check_idle();
    return inputs_;
  }
  const InputLog<Inputs>& log() const {
    check_idle();
    return log_;
  }
  // Any thread: steps whose result was not finite, and inputs that apply() made not finite.
  std::uint64_t refused_states() const { return refused_states_; }
  std::uint64_t refused_inputs() const { return refused_inputs_; }

 private:
  template <class StepFunction>
  static Step step_of(StepFunction step) {
    if constexpr (std::is_invocable_r_v<State, StepFunction&, const State&, const Inputs&, double>)
      return
          [step = std::move(step)](const State& before, const Inputs& inputs, const StepTime& time,
                                   State& after) { after = step(before, inputs, time.step_s); };
    else
      return step;
  }

  void check_idle() const { NERITIC_CHECK(!thread_, "the simulation's thread runs"); }

  TimeNs simulated_ns(std::uint64_t step) const {
    return std::llround(static_cast<double>(step) * options_.step_s * 1e9);
  }

  void begin_log() {
    log_ = {options_.step_s, options_.seed, source_.newest().step, {}, {}};
    if (!options_.log) return;
    log_.entries.push_back({log_.first_step, inputs_});
    log_.hashes.push_back(source_.newest().hash);
  }

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
    // The start's entry stands for the first step until that is taken.
    if (log_.entries.back().step == source_.newest().step)
      log_.entries.back().inputs = inputs_;
    else
      log_.entries.push_back({source_.newest().step, inputs_});
  }

  void step_once(TimeNs due_ns) {
    take_messages();
    const Snapshot<State>& newest = source_.newest();
    Snapshot<State>& next = source_.next();
    step_(newest.state, inputs_, {newest.step, options_.step_s}, next.state);
    if (!all_finite(next.state)) {
      next.state = newest.state;
      ++refused_states_;
    }
    next.step = newest.step + 1;
    next.time_s = static_cast<double>(next.step) * options_.step_s;
    next.due_ns = due_ns;
    next.hash = state_hash(next.step, next.state);
    if (options_.log) log_.hashes.push_back(next.hash);
    source_.put();
  }

  SimulationOptions options_;
  Step step_;
  Apply apply_;
  Inputs inputs_;
  SnapshotSource<State> source_;
  Inbox<Message> inbox_;
  std::vector<Message> messages_;  // drained, memory kept
  InputLog<Inputs> log_;
  std::atomic<std::uint64_t> refused_states_{0}, refused_inputs_{0};
  StepPacer::Counts pace_;
  std::unique_ptr<StepThread> thread_;  // last: ends before what it uses
};

struct ReplayReport {
  std::uint64_t steps = 0;                        // taken
  std::optional<std::uint64_t> first_difference;  // the step whose hash differs; 0: the start
};

// Runs a log again. step is the simulation's, either form; stops at the first difference.
template <class State, class Inputs, class StepFunction>
ReplayReport replay(const InputLog<Inputs>& log, const State& start, StepFunction step) {
  ReplayReport report;
  if (log.hashes.empty()) return report;
  Simulation<State, Inputs> run({.step_s = log.step_s, .log = false}, start,
                                log.entries.front().inputs, std::move(step));
  run.restore(log.first_step, start, log.entries.front().inputs);
  std::size_t entry = 0;
  for (std::uint64_t i = 0;; ++i) {
    if (run.newest().hash != log.hashes[i]) {
      report.first_difference = log.first_step + i;
      return report;
    }
    if (i == log.steps()) return report;
    for (; entry + 1 < log.entries.size() && log.entries[entry + 1].step <= run.newest().step;)
      run.push(log.entries[++entry].inputs);
    run.advance(1);
    ++report.steps;
  }
}

}  // namespace neritic::sim
