// The time of a run that a person watches: stopped, slowed down, sped up or stepped, over the time
// of another clock. It never falls. Any thread may call any of it.
#pragma once

#include <mutex>

#include "engine/sim/step_clock.hpp"

namespace neritic::sim {

class RunClock final : public StepClock {
 public:
  static constexpr double kSlowest = 0.1, kFastest = 10.0;

  // host: outlives this. Run time begins at its time, at a speed of 1.
  explicit RunClock(StepClock& host);

  TimeNs now() override;
  // The run time at a time of the host near now: when a picture will be seen.
  TimeNs at(TimeNs host_ns);
  // Waits in short pieces, since speed and pause may change meanwhile.
  void wait_until(TimeNs run_ns) override;
  bool stands() override { return paused(); }
  // A time at which the run stood gives when it went on, or now.
  TimeNs host_at(TimeNs run_ns) override;

  // Run seconds a host second; clamped to kSlowest to kFastest.
  void set_speed(double speed);
  double speed();
  void pause(bool paused);
  bool paused();
  // While paused: time passes once more, for so long.
  void step(TimeNs duration_ns);

 private:
  TimeNs at_locked(TimeNs host_ns) const;
  void rebase();

  StepClock& host_;
  std::mutex mutex_;
  // At the last change: run time passes from there on at speed_, up to limit_ns_ while paused.
  TimeNs host_base_ns_, run_base_ns_, limit_ns_ = 0;
  double speed_ = 1.0;
  bool paused_ = false;
};

}  // namespace neritic::sim
