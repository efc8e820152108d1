// Notes for the user about one sonar image made from images: whether any surface lies in the wedge,
// and whether the images are fine enough for its cells. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sonar/depth_normals.hpp"
#include "sonar/reference.hpp"

namespace neritic::tools {

struct Coverage {
  std::size_t in_wedge = 0;     // pixels with a depth, within the limits of range and both angles
  std::size_t in_aperture = 0;  // pixels with a depth within both angles
  std::size_t facing_away = 0;  // of in_wedge, those that are silent since their normals face away
  std::size_t no_normal = 0;    // of in_wedge, those that are silent for want of a normal
  double nearest_m = 0.0, farthest_m = 0.0;  // ranges found in the image; 0, 0 where none has any
  double of_wedge = 1.0;  // the part of the wedge's directions that the image looks in
  // Where its edges are, straight across and straight up from the middle.
  std::array<double, 2> azimuth_rad{}, elevation_rad{};
  double pixels_per_cell = 0.0;  // of the image, over cells of azimuth times elevation
};
// Whether a direction from the sonar, of any length, lies within both angles.
bool in_aperture(const sonar::Limits& limits, const Vec3& direction);
Coverage coverage_of(const sonar::BeamGrid& grid, const sonar::SonarInput& in);

// A line about missing coverage, if there is any. published: each pixel adds to one cell.
std::optional<std::string> coverage_note(const sonar::BeamGrid& grid, const Coverage& coverage,
                                         bool published);
// Where a good part of what lies in the wedge is silent by its normals. estimated: from the depth.
std::optional<std::string> normals_note(const Coverage& coverage, bool estimated);

// Where the depth's noise would have tilted estimated normals by much.
std::optional<std::string> noise_note(const sonar::NormalEstimate& estimate);

// Where the published gather would count a cell in more range bins than its surface crosses.
std::optional<std::string> smoothing_note(const sonar::SmoothedDepth& smoothed, double bin_m);
// Noise of this part of a bin changes the published gather's energy by some per cent.
inline constexpr double kAcceptedNoise_bins = 0.25;

// Notes that are printed once in a run, however many frames they concern. Any thread.
class SonarNotes {
 public:
  enum class About : unsigned { kWholeMetres, kCoverage, kNoise, kSmoothed };

  // Whether nothing was said about it yet; true once.
  bool first(About about);
  // Held until release(), so that a run which fails says why and no more; from then on said at
  // once.
  void say(std::string line);
  void release();

 private:
  std::mutex mutex_;
  bool hold_ = true;
  unsigned said_ = 0;  // a bit an About
  std::vector<std::string> held_;
};

}  // namespace neritic::tools
