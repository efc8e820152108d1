// Shared by tests of the sonar's GPU passes: one gather of images on the shared device.
#pragma once

#include "sonar/image_gather.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::test {

inline double total(const sonar::SonarImage& image) {
  double sum = 0.0;
  for (const float value : image.intensity) sum += value;
  return sum;
}

class SonarGpuTest : public GpuTest {
 protected:
  // Silence, and a failed test, where it cannot be made.
  sonar::SonarImage run(const sonar::BeamGrid& grid, std::span<const sonar::SonarInput> inputs,
                        sonar::Gather gather) {
    const auto heard = [&]() -> Result<sonar::SonarImage> {
      NERITIC_TRY(const auto made, sonar::ImageGather::create(device(), grid, inputs, gather));
      return made->run();
    }();
    if (heard.ok()) return *heard;
    ADD_FAILURE() << heard.error().message;
    const std::size_t cells = std::size_t{grid.bins.range} * grid.bins.azimuth;
    return {grid.bins.range, grid.bins.azimuth, std::vector<float>(cells),
            std::vector<std::uint16_t>(cells)};
  }
};

}  // namespace neritic::test
