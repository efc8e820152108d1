#include "tools/tradeoff/joint_search.hpp"

#include <array>
#include <map>
#include <optional>

namespace neritic::tools {
namespace {

// A setting as its place on each knob's ladder: range bins, pixels a cell, columns, rows.
using Place = std::array<std::size_t, 4>;
constexpr std::size_t kRowsKnob = 3;

class JointSearch {
 public:
  JointSearch(const Ladders& ladders, const MeasureKnobs& measure)
      : ladders_(ladders), measure_(measure) {}

  // Rows are tried one by one, since the error does not fall evenly with them: where a row is
  // taller than a bin it is shared out, where it is less tall it is a sample.
  Status run(double bound, int repeats) {
    for (std::size_t rows = 0; rows < ladders_.rows.size(); ++rows)
      NERITIC_TRY_STATUS(descend(bound, rows));
    const Place* best = nullptr;
    double least_ms = 0.0;
    for (const auto& [place, p] : found_)
      if (p.error <= bound && (!best || p.ms() < least_ms)) {
        best = &place;
        least_ms = p.ms();
      }
    if (!best) return {};
    NERITIC_TRY(found_.at(*best), measure_(knobs_at(*best), repeats));
    return {};
  }

  std::vector<KindPoint> found() const {
    std::vector<KindPoint> out;
    for (const auto& [place, p] : found_) out.push_back(p);
    return out;
  }

 private:
  Knobs knobs_at(const Place& place) const {
    return {ladders_.scales[place[1]], ladders_.columns[place[2]], ladders_.rows[place[3]], "plane",
            ladders_.bins[place[0]]};
  }

  Result<KindPoint> at(const Place& place) {
    if (const auto known = found_.find(place); known != found_.end()) return known->second;
    NERITIC_TRY(const KindPoint p, measure_(knobs_at(place), 1));
    found_[place] = p;
    return p;
  }

  // Descends from the finest setting with this number of rows: each step makes that other knob
  // coarser that gives the cheapest ping within the bound.
  Status descend(double bound, std::size_t rows) {
    Place here{ladders_.bins.size() - 1, ladders_.scales.size() - 1, ladders_.columns.size() - 1,
               rows};
    NERITIC_TRY(KindPoint best, at(here));
    while (best.error <= bound) {
      std::optional<Place> next;
      for (std::size_t knob = 0; knob < kRowsKnob; ++knob) {
        if (here[knob] == 0) continue;
        Place coarser = here;
        --coarser[knob];
        NERITIC_TRY(const KindPoint p, at(coarser));
        if (p.error > bound || (next && p.ms() >= best.ms())) continue;
        next = coarser;
        best = p;
      }
      if (!next) break;
      here = *next;
    }
    return {};
  }

  const Ladders& ladders_;
  const MeasureKnobs& measure_;
  std::map<Place, KindPoint> found_;
};

}  // namespace

Result<std::vector<KindPoint>> search_joint(const Ladders& ladders, const MeasureKnobs& measure,
                                            int repeats) {
  JointSearch search(ladders, measure);
  for (const ErrorLevel& level : kErrorLevels)
    NERITIC_TRY_STATUS(search.run(level.max_error, repeats));
  return search.found();
}

}  // namespace neritic::tools
