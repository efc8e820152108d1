// The opponent of benchmarks: Algorithm 1 as one writes it first in C++, with the whole volume of
// floats, cleared, filled and summed. Compiled at -O3. The result is reference_image's within float
// rounding. One owner, one thread.
#pragma once

#include <span>
#include <vector>

#include "sonar/reference.hpp"

namespace neritic::sonar {

// The inputs of such a program, as floats.
struct LiteralInput {
  std::uint32_t width = 0, height = 0;
  float fx = 1, fy = 1, cx = 0, cy = 0;
  std::vector<float> depth_m, normals;
};
LiteralInput literal_input(const SonarInput& input);

class LiteralVolume {
 public:
  explicit LiteralVolume(const BeamGrid& grid);
  // The image [n_range][n_azimuth]; valid until the next call. Normals face the sensor.
  std::span<const float> run(const LiteralInput& input);

 private:
  void fill(const LiteralInput& input);
  void sum();
  BeamGrid grid_;
  std::vector<float> volume_, image_;
};

}  // namespace neritic::sonar
