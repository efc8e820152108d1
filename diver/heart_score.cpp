#include "diver/heart_score.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

HeartScore score_beats(std::span<const BeatAnnotation> marked, std::span<const Interval> found) {
  HeartScore score;
  std::vector<double> offsets_ms, sizes_ms;
  std::size_t next = 0;
  for (const BeatAnnotation& mark : marked) {
    const bool ectopic = !is_normal_beat(mark.code);
    score.ectopic_marked += ectopic;
    while (next < found.size() && found[next].end_s < mark.time_s - kBeatTolerance_s)
      ++next, ++score.extra;
    // The nearest of those within reach.
    std::size_t best = next;
    while (best + 1 < found.size() && std::abs(found[best + 1].end_s - mark.time_s) <
                                          std::abs(found[best].end_s - mark.time_s))
      ++best;
    if (best >= found.size() || std::abs(found[best].end_s - mark.time_s) > kBeatTolerance_s) {
      ++score.missed;
      continue;
    }
    ++score.found;
    score.extra += static_cast<int>(best - next);
    score.ectopic_both += ectopic && found[best].kind == IntervalKind::kEctopic;
    offsets_ms.push_back(1e3 * (found[best].end_s - mark.time_s));
    sizes_ms.push_back(std::abs(offsets_ms.back()));
    next = best + 1;
  }
  score.extra += static_cast<int>(found.size() - std::min(next, found.size()));
  for (const Interval& i : found) score.ectopic_flagged += i.kind == IntervalKind::kEctopic;
  const auto share = [](int part, int rest) {
    return part + rest > 0 ? static_cast<double>(part) / (part + rest) : 0.0;
  };
  score.sensitivity = share(score.found, score.missed);
  score.predictivity = share(score.found, score.extra);
  score.median_offset_ms = quantile(offsets_ms, 0.5);
  score.p95_offset_ms = quantile(sizes_ms, 0.95);
  return score;
}

}  // namespace neritic::diver
