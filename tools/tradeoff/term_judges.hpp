// The error of a sonar's image against the rays', and the statistics of its speckle and noise. Pure
// functions; any thread.
#pragma once

#include <span>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::tools {

// The error of an image, cell by cell. l1: the mean relative error of cells, weighted by their true
// energy: the sum of absolute differences over the truth's total.
struct ImageDifference {
  double l1 = 0.0, energy = 0.0;  // energy: total over the truth's, less 1
};
// scaled: the image is first scaled to the truth's total.
ImageDifference difference(std::span<const float> image, std::span<const double> truth,
                           bool scaled = false);

// Deviation of a Rayleigh amplitude over its mean: sqrt(4 / pi - 1) (Goodman 2007, Speckle
// Phenomena in Optics, sec. 3.2).
inline constexpr double kRayleighContrast = 0.522723;

struct SpeckleFound {
  double contrast = 0.0, mean = 0.0;  // of amplitudes; of power over the smooth image's
  double departure = 0.0;             // mean of |power / smooth - 1|: 2 / e where fully developed
};
// Cells that hold more than a thousandth of the strongest, each over what it holds without speckle.
class SpeckleMoments {
 public:
  void add(std::span<const float> image, std::span<const float> smooth);
  SpeckleFound found() const;

 private:
  double n_ = 0.0, power_ = 0.0, amplitude_ = 0.0, departure_ = 0.0;
};

struct NoiseFound {
  double mean_over_expected = 0.0;  // where nothing else is heard
  std::size_t cells = 0;            // that it is the mean of
  double share = 0.0;               // of noise in the whole image: what leaving it out is off by
};
// image: of a sonar with those terms; clean: without noise; grid: its kind and bins.
NoiseFound judge_noise(std::span<const float> image, std::span<const double> clean,
                       const scene::Sonar& grid, const scene::Sonar& terms);

}  // namespace neritic::tools
