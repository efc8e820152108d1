// Waiting on the host's clock and on a simulated one.
#include "engine/sim/step_clock.hpp"

#include <chrono>
#include <thread>

namespace neritic::sim {

void HostClock::wait_until(TimeNs time_ns) {
  std::this_thread::sleep_until(
      std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)));
}

void SimulatedClock::wait_until(TimeNs time_ns) {
  TimeNs seen = now_.load();
  while (seen < time_ns && !now_.compare_exchange_weak(seen, time_ns)) {
  }
}

}  // namespace neritic::sim
