#include "diver/gaze_noise.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr std::size_t kFewest = 8;
// Medians of 256 lengths are needed no more often.
constexpr std::size_t kEvery = 8;
constexpr double kRayleighMedian = 1.1774100225154747;  // sqrt(2 ln 2)
constexpr double kNextAfter_s = 0.0045, kNextWithin_s = 0.15;

}  // namespace

void MedianDeviation::push(double length) {
  lengths_[count_++ % lengths_.size()] = static_cast<float>(length);
  if (count_ < kFewest || (count_ % kEvery != 0 && count_ > 4 * kEvery)) return;
  auto sorted = lengths_;
  const auto known = static_cast<std::ptrdiff_t>(std::min(count_, sorted.size()));
  const auto middle = sorted.begin() + known / 2;
  std::nth_element(sorted.begin(), middle, sorted.begin() + known);
  deviation_ = static_cast<double>(*middle) / kRayleighMedian;
}

// How far a direction lies off the line between its neighbours: an eye that turns evenly adds
// nothing. With weights w and 1 - w of the neighbours the error's variance is 1 + w^2 + (1 - w)^2
// times that of a sample.
void GazeNoise::push(double time_s, const Vec3& direction) {
  if (seen_ > 0) {
    const double step_s = time_s - last_[1].time_s;
    if (step_s > kNextWithin_s || step_s < 0.0) seen_ = 0;  // a gap, or the clock was set
    if (seen_ > 0 && step_s < kNextAfter_s) return;
  }
  const Seen now{time_s, direction};
  if (seen_ >= 2) {
    const double w = (last_[1].time_s - last_[0].time_s) / (time_s - last_[0].time_s);
    const Vec3 between = (1.0 - w) * last_[0].direction + w * direction;
    deviation_.push(glm::length(last_[1].direction - between) /
                    std::sqrt(1.0 + w * w + (1.0 - w) * (1.0 - w)));
  }
  last_[0] = seen_ > 0 ? last_[1] : now;
  last_[1] = now;
  seen_ = std::min(seen_ + 1, 2);
}

}  // namespace neritic::diver
