// Steps due at a time.
#include "engine/sim/step_pacer.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace neritic::sim {

StepPacer::StepPacer(double rate_hz, int max_catch_up, TimeNs start_ns, TimeNs most_late_ns)
    : period_ns_(1e9 / rate_hz),
      max_catch_up_(max_catch_up),
      most_late_(std::max<std::int64_t>(
          max_catch_up, static_cast<std::int64_t>(static_cast<double>(most_late_ns) / period_ns_))),
      origin_ns_(start_ns) {
  NERITIC_CHECK(rate_hz > 0.0 && rate_hz <= 1e6, "{} Hz", rate_hz);
  NERITIC_CHECK(max_catch_up >= 1, "{} steps at once", max_catch_up);
}

TimeNs StepPacer::due_ns(std::int64_t step) const {
  return origin_ns_ + std::llround(static_cast<double>(step) * period_ns_);
}

int StepPacer::take(TimeNs now_ns) {
  if (now_ns < next_ns()) {
    behind_ns_.reset();
    return 0;
  }
  // By division, then corrected, since due times are rounded to nanoseconds.
  auto last = static_cast<std::int64_t>(static_cast<double>(now_ns - origin_ns_) / period_ns_);
  while (due_ns(last) > now_ns) --last;
  while (due_ns(last + 1) <= now_ns) ++last;
  const std::int64_t due = last - done_;
  if (due <= 1)
    behind_ns_.reset();
  else if (!behind_ns_)
    behind_ns_ = now_ns;
  const bool catches_up = behind_ns_ && now_ns - *behind_ns_ <= kMostCatchUp_ns;
  const std::int64_t kept = std::min(due, catches_up ? most_late_ : max_catch_up_);
  const std::int64_t run = std::min<std::int64_t>(kept, max_catch_up_);
  const std::int64_t dropped = due - kept;
  // The latest are kept: what is dropped lies before them.
  const TimeNs dropped_ns = due_ns(done_ + dropped) - due_ns(done_);
  origin_ns_ += dropped_ns;
  done_ += run;
  counts_.steps += static_cast<std::uint64_t>(run);
  counts_.caught_up += static_cast<std::uint64_t>(kept > run ? run : run - 1);
  counts_.dropped += static_cast<std::uint64_t>(dropped);
  counts_.dropped_ns += dropped_ns;
  return static_cast<int>(run);
}

bool StepPacer::take_early(TimeNs now_ns, TimeNs most_early_ns) {
  if (next_ns() - now_ns > most_early_ns) return false;
  ++done_;
  ++counts_.steps;
  return true;
}

}  // namespace neritic::sim
