// How finely a sonar is sampled for the error that a user accepts. Three named levels a kind, each
// the cheapest setting that `neritic tradeoff sonar` measured under 5, 2 and 1 % (sonar/TRADE.md:
// scene, machine and what the error is). Pure functions; any thread.
//
// A level is kept as densities, so that it holds for sensors of other apertures and beams: gathered
// columns a half-power width of the azimuth pattern, gathered rows a resolution cell of range
// (c / 2B) between the limits. Sensors that look at a bottom from above, whose echo is a few cells
// long, are the exception: their rows (and a cone's columns) are counts over the aperture.
#pragma once

#include <span>

#include "engine/scene/scene.hpp"

namespace neritic::sonar {

struct QualityLevel {
  const char* name;      // "draft", "standard", "reference"
  double gbuffer_scale;  // pixels a gathered cell, linear
  double columns;        // a half-power width; an echo sounder: in its cone
  double rows;           // a range resolution cell; profiling, echo sounder: in elevation
  double bins_a_cell;    // of range, at least, a resolution cell: coarser ones err more
  double error;          // measured: mean relative error of a cell, weighted by its energy
  double ms;             // a ping of the measured sensor on the measured machine
};
// From draft to reference.
std::span<const QualityLevel> quality_levels(scene::SonarKind kind);

// The level that a sonar's `quality` or `max_error` comes to; nullptr where it names neither.
// kBadInput as apply_quality's.
Result<const QualityLevel*> quality_level(const scene::Sonar& sonar);

// Samples a sonar as its `quality` or `max_error` asks for: sets gbuffer_scale, elevation bins and
// beam samples (of an echo sounder its azimuth bins), whatever they were, and multiplies its range
// bins by the least whole number that makes them fine enough, so that bins of the device's own can
// be summed from them. max_error takes the cheapest level whose measured error is at most that.
// Without either it changes nothing; a second time it changes nothing more. kBadInput where no
// level is that good, where both are named, or where the level is not known.
Status apply_quality(scene::Sonar& sonar);

}  // namespace neritic::sonar
