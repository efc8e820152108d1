// `neritic tradeoff optics`: the error of light shafts falls with their samples.
#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"
#include "tools/tradeoff/shaft_error.hpp"

namespace neritic::tools {
namespace {

using OpticsTradeoffOnDevice = test::GpuTest;

TEST_F(OpticsTradeoffOnDevice, ShaftsComeNearerToEvenStepsWithMoreSamples) {
  double last = 0.1;  // a tenth of the light without waves
  for (const std::uint32_t samples : {2u, 8u, 48u}) {
    const auto point = shaft_point(device(), samples, true);
    ASSERT_TRUE(point.ok()) << point.error().message;
    EXPECT_GT(point->error, 0.0) << samples;
    EXPECT_LT(point->error, samples == 2 ? last : 0.7 * last) << samples;
    last = point->error;
  }
}

}  // namespace
}  // namespace neritic::tools
