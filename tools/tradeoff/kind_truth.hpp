// The rays' images of a kind's sensors from every shot, in the order in which its bench gives them.
// Two threads, as term_truth.
#pragma once

#include <span>
#include <vector>

#include "tools/tradeoff/kind_bench.hpp"
#include "tools/tradeoff/term_truth.hpp"

namespace neritic::tools {

struct KindTruth {
  std::vector<std::vector<double>> images;  // by sensor: shots, and heads within each
  double uncertain = 0.0;                   // of the first sensor's: its error, from two halves
  double rays = 0.0;
};

// world: about world_origin_m, axes of the scene's. sonars: as trace_terms takes them.
Result<KindTruth> trace_kind(const RayWorld& world, const Vec3& world_origin_m,
                             std::span<const KindBench::Placed> placed,
                             std::span<const scene::Sonar> sonars, const TruthRays& rays);

}  // namespace neritic::tools
