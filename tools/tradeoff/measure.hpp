// One point of a trade-off: how far a sonar image lies from the truth, and what it costs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sonar/image_gather.hpp"
#include "tools/tradeoff/gbuffer_images.hpp"
#include "tools/tradeoff/truth.hpp"

namespace neritic::tools {

struct ImageError {
  double energy = 0.0;    // total over the truth's, less 1
  double l1 = 0.0;        // sum of absolute differences over the truth's total
  double shift_mm = 0.0;  // mean distance that energy would have to move along range in its column
};
ImageError compare(std::span<const float> image, const Truth& truth, double range_span_m);

struct Point {
  std::string scene, sweep, images;  // images: "rays" or "renderer"
  std::string gather, normals;
  double scale = 0.0;  // G-buffer pixels a cell, linear
  std::uint32_t width = 0, height = 0;
  sonar::Bins bins;
  ImageError error;
  double gather_ms = 0.0, raster_ms = 0.0;
  double cost_ms() const { return gather_ms + raster_ms; }
};

// Gathers on the GPU; the least time of repeats.
Result<Point> measure_gather(gpu::Device& device, const sonar::BeamGrid& grid,
                             std::span<const sonar::SonarInput> inputs, sonar::Gather gather,
                             const Truth& truth, int repeats);

// The point where a curve of falling error over rising cost bends most: farthest below the chord
// between its ends, both axes scaled to 0..1 (Satopaa et al. 2011, "Kneedle"). Points in any order;
// returns an index.
std::size_t knee_of(std::span<const double> cost, std::span<const double> error);

}  // namespace neritic::tools
