// Beats that were found against beats that a person marked. Pure functions; any thread.
#pragma once

#include <span>
#include <vector>

#include "diver/hrv.hpp"
#include "diver/physio_recording.hpp"

namespace neritic::diver {

// ANSI/AAMI EC57 (1998): a beat is found where one was marked within 150 ms; each counts once.
inline constexpr double kBeatTolerance_s = 0.150;

struct HeartScore {
  int found = 0, extra = 0, missed = 0;  // true positives, false positives, false negatives
  double sensitivity = 0.0;              // found / (found + missed)
  double predictivity = 0.0;             // +P: found / (found + extra)
  double median_offset_ms = 0.0, p95_offset_ms = 0.0;  // of the found: signed; absolute
  // Ectopic beats: the share of marked ones that are flagged, and of flagged ones that are marked.
  int ectopic_marked = 0, ectopic_flagged = 0, ectopic_both = 0;
};
// Both in rising order; intervals: of the beats found, one each.
HeartScore score_beats(std::span<const BeatAnnotation> marked, std::span<const Interval> found);

}  // namespace neritic::diver
