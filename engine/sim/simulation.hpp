// A state that steps at a fixed rate: state <- step(state, inputs, time). Its owner either advances
// it (lock-step) or starts its thread; both give the same states for the same inputs.
//
// Inputs hold until a message changes them. Messages enter through an inbox, which any thread may
// fill; each step drains it first. Its drain() returns what range of messages it likes, bounded and
// all finite; apply() keeps the inputs finite. The messages are logged by step, with the hash of
// each state. A step whose result is not finite is refused and counted: the state before it stays
// while time goes on. Readers get snapshots (snapshot.hpp). State and Inputs list their fields
// (fields.hpp); a state is a plain struct or a block (block.hpp).
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/sim/run_log.hpp"
#include "engine/sim/snapshot.hpp"
#include "engine/sim/state_hash.hpp"
#include "engine/sim/step_thread.hpp"
#include "engine/sim/step_time.hpp"

namespace neritic::sim {

struct SimulationOptions {
  double step_s =
      1.0 / kDefaultRate_hz;       // up to kMaxStep_s; a thread needs kMinRate_hz to kMaxRate_hz
  int max_catch_up = kMaxCatchUp;  // most steps at once in thread mode
  TimeNs most_late_ns = kMostLate_ns;  // how late a step may be in thread mode
  bool log = true;         // keep messages and hashes in memory: 8 bytes a step, and each message
  std::uint64_t seed = 0;  // for the log only
};

// Writes the state after the step into after, which has the layout of before and any content.
template <class State, class Inputs>
using StepFunction = std::function<void(const State& before, const Inputs& inputs,
                                        const StepTime& time, State& after)>;

// step as it is, or of a function that returns State(before, inputs, step_s).
template <class State, class Inputs, class Function>
StepFunction<State, Inputs> step_of(Function step) {
  if constexpr (std::is_invocable_r_v<State, Function&, const State&, const Inputs&, double>)
    return [step = std::move(step)](const State& before, const Inputs& inputs, const StepTime& time,
                                    State& after) { after = step(before, inputs, time.step_s); };
  else
    return step;
}

template <class State, class Inputs, class InboxType>
class Simulation {
 public:
  using Inbox = InboxType;
  using Message = typename Inbox::Message;
  using Step = StepFunction<State, Inputs>;
  // A message that enters before the step of that number.
  using Apply = std::function<void(Inputs&, const Message&, std::uint64_t step)>;
  using Log = RunLog<Inputs, Message>;

  // step and apply are pure: no clock, file, thread; they run on the stepping thread.
  template <class Function>
  Simulation(const SimulationOptions& options, const State& state, const Inputs& inputs,
             std::unique_ptr<Inbox> inbox, Function step, Apply apply)
      : options_(options),
        step_(step_of<State, Inputs>(std::move(step))),
        apply_(std::move(apply)),
        inputs_(inputs),
        source_({state, 0, 0.0, 0, 0, state_hash(0, state)}),
        inbox_(std::move(inbox)) {
    NERITIC_CHECK(options.step_s > 0.0 && options.step_s <= kMaxStep_s, "step {} s",
                  options.step_s);
    check_fields_cover(state);
    check_fields_cover(inputs);
    NERITIC_CHECK(all_finite(state) && all_finite(inputs), "the start is not finite");
    begin_log();
  }

  // Any thread.
  Inbox& inbox() { return *inbox_; }
  const Inbox& inbox() const { return *inbox_; }

  // Any thread, also while the simulation's thread runs. The reader is dropped before this.
  SnapshotReader<State> reader() { return source_.reader(); }

  // each sees every state on the thread that stepped, right after its step; its time is the step's.
  // used sees each message that the next step uses, before that. Not while the thread runs.
  void observe(std::function<void(const Snapshot<State>&)> each,
               std::function<void(const Message&)> used = {}) {
    check_idle();
    observer_ = std::move(each);
    used_ = std::move(used);
  }

  const std::function<void(const Snapshot<State>&)>& observer() const { return observer_; }

  // Lock-step: so many steps now. Not while the thread runs.
  void advance(std::uint64_t steps) {
    check_idle();
    for (std::uint64_t i = 0; i < steps; ++i) {
      const TimeNs due_ns = lock_step_ns(source_.newest().step + 1);
      step_once(due_ns, due_ns);
    }
  }
  // Lock-step at the host's pace: its time when the scene's was 0. 0, the default: simulated time.
  void set_host_zero(TimeNs host_ns) {
    check_idle();
    host_zero_ns_ = host_ns;
  }

  // No step after the one of that number: time stands still there. Not while the thread runs.
  void end_at(std::uint64_t step) {
    check_idle();
    last_step_ = step;
  }
  std::uint64_t last_step() const { return last_step_; }

  // Goes on from a state that was saved after so many steps. Messages not yet applied are dropped;
  // the log begins anew. Layouts as at construction; everything finite. Not while the thread runs.
  void restore(std::uint64_t step, const State& state, const Inputs& inputs) {
    check_idle();
    NERITIC_CHECK(all_finite(state) && all_finite(inputs), "the restored state is not finite");
    (void)inbox_->drain();
    inputs_ = inputs;
    const TimeNs due_ns = lock_step_ns(step);
    source_.restart({state, step, static_cast<double>(step) * options_.step_s, due_ns, due_ns,
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
    now.host_ns = clock.host_at(now.due_ns);
    source_.restart(now);
    const StepPacer pacer(rate_hz, options_.max_catch_up, now.due_ns, options_.most_late_ns);
    thread_ = std::make_unique<StepThread>(
        clock, pacer, [this, &clock](TimeNs due_ns) { step_once(due_ns, clock.host_at(due_ns)); });
  }
  void stop() {
    if (!thread_) return;
    thread_->stop();
    pace_ = thread_->counts() + pace_;
    thread_.reset();
  }
  // With the thread: the steps that are due and, up to a whole step before its time, the next one,
  // on the caller's thread, which the observer then sees too. False where none could be taken
  // (StepThread::hasten). The thread that owns this.
  bool hasten(TimeNs most_step_ns) {
    return thread_ && thread_->hasten(std::llround(options_.step_s * 1e9), most_step_ns);
  }
  bool running() const { return thread_ != nullptr; }
  // The counts of all threads so far.
  StepPacer::Counts pace() const { return thread_ ? thread_->counts() + pace_ : pace_; }

  // The next three: not while the thread runs (readers get snapshots instead).
  const Snapshot<State>& newest() const {
    check_idle();
    return source_.newest();
  }
  const Inputs& inputs() const {
    check_idle();
    return inputs_;
  }
  const Log& log() const {
    check_idle();
    return log_;
  }
  // Any thread: steps whose result was not finite.
  std::uint64_t refused_states() const { return refused_states_; }

 private:
  void check_idle() const { NERITIC_CHECK(!thread_, "the simulation's thread runs"); }

  TimeNs lock_step_ns(std::uint64_t step) const {
    return host_zero_ns_ + std::llround(static_cast<double>(step) * options_.step_s * 1e9);
  }

  void begin_log() {
    log_ = {options_.step_s, options_.seed, source_.newest().step, inputs_, {}, {}};
    if (options_.log) log_.hashes.push_back(source_.newest().hash);
  }

  void take_messages() {
    const std::uint64_t step = source_.newest().step;
    for (const Message& message : inbox_->drain()) {
      apply_(inputs_, message, step);
      if (used_) used_(message);
      if (options_.log) log_.entries.push_back({step, message});
    }
  }

  void step_once(TimeNs due_ns, TimeNs host_ns) {
    const Snapshot<State>& newest = source_.newest();
    if (newest.step >= last_step_) return;
    take_messages();
    Snapshot<State>& next = source_.next();
    step_(newest.state, inputs_, {newest.step, options_.step_s}, next.state);
    if (!all_finite(next.state)) {
      next.state = newest.state;
      ++refused_states_;
    }
    next.step = newest.step + 1;
    next.time_s = static_cast<double>(next.step) * options_.step_s;
    next.due_ns = due_ns;
    next.host_ns = host_ns;
    next.hash = state_hash(next.step, next.state);
    if (options_.log) log_.hashes.push_back(next.hash);
    source_.put();
    if (observer_) observer_(source_.newest());
  }

  SimulationOptions options_;
  Step step_;
  Apply apply_;
  Inputs inputs_;
  SnapshotSource<State> source_;
  std::unique_ptr<Inbox> inbox_;
  std::function<void(const Snapshot<State>&)> observer_;
  std::function<void(const Message&)> used_;
  Log log_;
  std::uint64_t last_step_ = std::numeric_limits<std::uint64_t>::max();
  std::atomic<std::uint64_t> refused_states_{0};
  StepPacer::Counts pace_;
  TimeNs host_zero_ns_ = 0;
  std::unique_ptr<StepThread> thread_;  // last: ends before what it uses
};

// How a recorded run went when it was run again.
struct ReplayReport {
  std::uint64_t steps = 0;                        // taken
  std::optional<std::uint64_t> first_difference;  // the step whose hash differs; 0: the start
};

}  // namespace neritic::sim
