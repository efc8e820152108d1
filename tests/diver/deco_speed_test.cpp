// Cost of decompression: processor time, the least of several runs, whoever else is at
// work.
#include <gtest/gtest.h>

#include "diver/deco_live.hpp"
#include "tests/diver/deco_cases.hpp"
#include "tests/support/cpu_time.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

DivePlanRequest trimix_dive() {
  DivePlanRequest request = square_dive(60.0, 25.0, {0.18, 0.45});
  request.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  request.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  return request;
}

TEST(DiverSpeed, APlanWithTrimixAndThreeGasesTakesUnderAMillisecond) {
  const DivePlanRequest request = trimix_dive();
  constexpr int kPlans = 50;
  double run_min = 0.0;
  const double ms = test::least_cpu_ms(1.0 * kPlans,
                                       [&] {
                                         for (int i = 0; i < kPlans; ++i)
                                           run_min = plan_dive(request)->run_min();
                                       }) /
                    kPlans;
  EXPECT_GT(run_min, 60.0);
  RecordProperty("us_a_plan", fmt::format("{:.1f}", 1e3 * ms));
  if (test::kFast) {
    EXPECT_LT(ms, 1.0);
  }
}

// Each at a depth of its own, with all that a computer keeps: a second of them in less than one.
TEST(DiverSpeed, TheTissuesOfTenThousandDiversAreFasterThanRealTime) {
  const DivePlanRequest request = trimix_dive();
  const auto computer = DiveComputer::create(
      {request.conventions, request.gf_low, request.gf_high, request.gases, {}});
  ASSERT_TRUE(computer.ok());
  constexpr std::size_t kDivers = 10000;
  std::vector<DiveComputerState> divers(kDivers, computer->start());
  const double ms = test::least_cpu_ms(1000.0, [&] {
    for (std::size_t i = 0; i < kDivers; ++i)
      divers[i] = computer->step(divers[i], {60.0 * static_cast<double>(i) / kDivers, 0}, 1.0);
  });
  EXPECT_GT(divers.back().tissues.he_bar[0], divers.front().tissues.he_bar[0]);
  RecordProperty("ms_a_second", fmt::format("{:.2f}", ms));
  if (test::kFast) {
    EXPECT_LT(ms, 1000.0);
  }
}

}  // namespace
}  // namespace neritic::diver
