#include "testbed/view/quality_governor.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

constexpr std::array<Quality, 16> kRungs{{{1.0, 1, 0},
                                          {0.9, 1, 0},
                                          {0.8, 1, 0},
                                          {0.8, 1, 1},
                                          {0.7, 1, 1},
                                          {0.6, 1, 1},
                                          {0.6, 2, 2},
                                          {0.5, 2, 2},
                                          {0.42, 2, 2},
                                          {0.42, 4, 3},
                                          {0.35, 4, 3},
                                          {0.3, 4, 3},
                                          {0.26, 4, 3},
                                          {0.23, 4, 3},
                                          {0.2, 4, 3},
                                          {0.2, 8, 3}}};

// The cost of a level of light beside the best (measured in software: wreck, 320 x 180).
constexpr std::array<double, kLightLevels> kLightCost{1.0, 0.75, 0.6, 0.5};

constexpr double kMissed = 1.08;  // of the budget: slower is a miss
constexpr double kRoom =
    0.85;  // of the budget: the most work that a better rung may be expected to take
constexpr std::size_t kInFlight = 3;  // frames after a change that were begun before it
constexpr double kSettled_s = 5.0, kLongestWait_s = 60.0;

// As if all work went with it.
double cost(const Quality& quality) {
  return quality.view_scale * quality.view_scale * kLightCost[quality.light];
}

double middle(std::array<double, 5> values) {
  std::nth_element(values.begin(), values.begin() + 2, values.end());
  return values[2];
}

}  // namespace

std::span<const Quality> quality_rungs() {
  return kRungs;
}

void QualityGovernor::add(double interval_ms, double work_ms) {
  if (!(std::isfinite(interval_ms) && interval_ms > 0.0 && work_ms > 0.0)) return;
  on_rung_s_ += interval_ms * 1e-3;
  if (skip_ > 0) {
    --skip_;
    return;
  }
  interval_ms_[frames_ % kFrames] = interval_ms;
  work_ms_[frames_ % kFrames] = std::min(work_ms, interval_ms);
  if (++frames_ < kFrames) return;
  const double interval = middle(interval_ms_);
  if (interval > kMissed * budget_ms_) {
    go_down(interval);
  } else {
    if (climbed_ && on_rung_s_ > kSettled_s) wait_s_[rung_] = 1.0;  // it holds
    go_up(middle(work_ms_));
  }
}

// To the rung whose cost is expected to fit: at least one, at most three, since fixed costs make the
// guess too good.
void QualityGovernor::go_down(double interval_ms) {
  if (rung_ + 1 >= kRungs.size()) return;
  if (climbed_ && on_rung_s_ <= kSettled_s)
    wait_s_[rung_] = std::min(2.0 * wait_s_[rung_], kLongestWait_s);
  const double wanted = cost(quality()) * budget_ms_ / interval_ms;
  const std::size_t farthest = std::min(rung_ + 3, kRungs.size() - 1);
  std::size_t next = rung_ + 1;
  while (next < farthest && cost(kRungs[next]) > wanted) ++next;
  rung_ = next;
  climbed_ = false;
  forget();
}

void QualityGovernor::go_up(double work_ms) {
  if (rung_ == 0 || on_rung_s_ < wait_s_[rung_ - 1]) return;
  const Quality& better = kRungs[rung_ - 1];
  if (work_ms * cost(better) / cost(quality()) > kRoom * budget_ms_) return;
  --rung_;
  climbed_ = true;
  forget();
}

void QualityGovernor::forget() {
  frames_ = 0;
  skip_ = kInFlight;
  on_rung_s_ = 0.0;
}

}  // namespace neritic::testbed
