#include "testbed/view/dive_times.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

constexpr double kSmoothing = 0.08;  // share of a new sample
constexpr TimeNs kRecent_ns = 1'000'000'000;
constexpr double kRecentFrames = 12.0;

}  // namespace

double TimeRow::median_ms() const {
  if (samples_ms.empty()) return 0.0;
  std::vector<float> sorted = samples_ms;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

double TimeRow::max_ms() const {
  return samples_ms.empty() ? 0.0 : *std::max_element(samples_ms.begin(), samples_ms.end());
}

void DiveTimes::add(TimeRow& row, double ms, TimeNs now_ns) const {
  row.smooth_ms = row.last_ns == 0 ? ms : row.smooth_ms + kSmoothing * (ms - row.smooth_ms);
  row.last_ns = now_ns;
  if (keep_samples_) row.samples_ms.push_back(static_cast<float>(ms));
}

void DiveTimes::add_frame(double frame_ms, TimeNs now_ns) {
  add(frame_, frame_ms, now_ns);
}

void DiveTimes::add_passes(std::span<const gpu::PassTime> passes, TimeNs now_ns) {
  for (const gpu::PassTime& pass : passes) {
    auto row = std::find_if(passes_.begin(), passes_.end(),
                            [&](const TimeRow& r) { return r.name == pass.name; });
    if (row == passes_.end()) row = passes_.insert(passes_.end(), TimeRow{.name = pass.name});
    add(*row, pass.ms, now_ns);
  }
}

bool DiveTimes::recent(const TimeRow& row, TimeNs now_ns) const {
  const auto frames_ns = static_cast<TimeNs>(kRecentFrames * frame_.smooth_ms * 1e6);
  return now_ns - row.last_ns < std::max(kRecent_ns, frames_ns);
}

std::string DiveTimes::summary(std::uint64_t frames, double seconds) const {
  std::string text = fmt::format("{} frames in {:.2f} s: {:.1f} a second\n", frames, seconds,
                                 seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0);
  std::size_t widest = 5;
  for (const TimeRow& row : passes_) widest = std::max(widest, row.name.size());
  text += fmt::format("{:{}}  {:>9}  {:>9}  {:>6}\n", "ms", widest, "median", "max", "runs");
  const auto line = [&](const TimeRow& row) {
    if (row.samples_ms.empty()) return;  // a single frame has none before it
    text += fmt::format("{:{}}  {:9.3f}  {:9.3f}  {:6}\n", row.name, widest, row.median_ms(),
                        row.max_ms(), row.samples_ms.size());
  };
  line(frame_);
  for (const TimeRow& row : passes_) line(row);
  return text;
}

}  // namespace neritic::testbed
