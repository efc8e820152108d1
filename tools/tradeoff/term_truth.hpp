// The images that infinitely fine beams would give, term by term: many rays a cell through a scene
// of triangles, each heard with its own range, bearing, incidence and loss, in double. A mirror's
// ghosts are rays that bounce: out by the mirror and straight back, where nothing stands in the
// way. Two threads.
#pragma once

#include <span>
#include <vector>

#include "tools/tradeoff/ray_world.hpp"
#include "tools/tradeoff/term_image.hpp"

namespace neritic::tools {

struct TruthRays {
  double columns_per_step = 4.0;    // of azimuth, at least, a beam
  double columns_per_width = 12.0;  // and a beam pattern's half-power width
  std::uint32_t rays = 4000;        // a column
};

struct TermTruth {
  sonar::BeamGrid grid;
  std::vector<double> image;      // [range][beams]
  std::vector<double> uncertain;  // of each, about
  double rays = 0.0;              // out of the head
};

// Sonars that differ in terms and bins only: kind, range limits and apertures are those of the
// first, and so are its patterns where they have any. head: which of plan_heads.
Result<std::vector<TermTruth>> trace_terms(const RayWorld& world, const TruthView& view,
                                           std::span<const scene::Sonar> sonars, std::size_t head,
                                           const TruthRays& rays);

}  // namespace neritic::tools
