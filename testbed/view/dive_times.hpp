// How long frames and their passes take: smoothed for a person to read while they run, with median
// and maximum for the summary at the end. Plain value; rendering thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/gpu/frames.hpp"

namespace neritic::testbed {

struct TimeRow {
  std::string name;
  double smooth_ms = 0.0;
  TimeNs last_ns = 0;             // when it last ran
  std::vector<float> samples_ms;  // kept only for a summary
  double median_ms() const;
  double max_ms() const;
};

class DiveTimes {
 public:
  explicit DiveTimes(bool keep_samples) : keep_samples_(keep_samples) {}
  void add_frame(double frame_ms, TimeNs now_ns);
  void add_passes(std::span<const gpu::PassTime> passes, TimeNs now_ns);

  const TimeRow& frame() const { return frame_; }
  // In the order in which they first ran. "record" is the host's recording.
  const std::vector<TimeRow>& passes() const { return passes_; }
  // Ran within the last second, or few frames where frames take long.
  bool recent(const TimeRow& row, TimeNs now_ns) const;
  // A table: pass, median ms, maximum ms, times run.
  std::string summary(std::uint64_t frames, double seconds) const;

 private:
  void add(TimeRow& row, double ms, TimeNs now_ns) const;
  bool keep_samples_;
  TimeRow frame_{.name = "frame"};
  std::vector<TimeRow> passes_;
};

}  // namespace neritic::testbed
