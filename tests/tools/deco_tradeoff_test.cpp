// `neritic tradeoff deco`: what the curves say, and that the default lies on their knee.
#include "tools/tradeoff/deco_tradeoff.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diver/deco_live.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

using enum TissueMethod;

DecoPoint point_of(const std::vector<DecoPoint>& points, TissueMethod method, double step_s) {
  for (const DecoPoint& p : points)
    if (p.method == method && p.step_s == step_s) return p;
  ADD_FAILURE() << name_of(method) << " " << step_s;
  return {};
}

// The cost of a sample by count instead of time, so that the knee is the same on any machine: one
// pass over the tissues, six where each takes exponentials (diver/TRADE.md).
DecoTradeoff counted(DecoTradeoff measured) {
  for (DecoPoint& p : measured.points)
    p.us_an_hour = 3600.0 / p.step_s * (p.method == kSchreiner ? 6.0 : 1.0);
  return measured;
}

TEST(DecoTradeoff, ErrorsFallWithTheStepByTheMethodsOrderAndTheDefaultIsFinerThanTheKnee) {
  const DecoTradeoff measured = run_deco_tradeoff({.quick = true});
  EXPECT_EQ(measured.points.size(), 3u * 9u * 5u);
  const std::vector<DecoPoint> worst = worst_of(measured);
  for (const TissueMethod method : {kEuler, kHeld, kMean, kSchreiner, kFactors}) {
    const double order = std::log10(point_of(worst, method, 10.0).error_bar /
                                    point_of(worst, method, 1.0).error_bar);
    EXPECT_NEAR(order, method == kEuler || method == kHeld ? 1.0 : 2.0, 0.25) << name_of(method);
  }
  for (const double step_s : {1.0, 5.0, 10.0, 30.0, 60.0}) {
    const DecoPoint exact = point_of(worst, kSchreiner, step_s);
    EXPECT_LE(exact.error_bar, point_of(worst, kMean, step_s).error_bar);
    EXPECT_LT(exact.error_bar, 0.5 * point_of(worst, kHeld, step_s).error_bar);
    EXPECT_NEAR(exact.error_bar, point_of(worst, kFactors, step_s).error_bar, 1e-12);
  }
  // The default lies on the fine side of the knee, where the alarm of the ascent's rate wants it.
  const DecoPoint chosen = point_of(worst, kFactors, diver::kComputerSample_s);
  EXPECT_NEAR(chosen.error_bar, 1.4e-5, 0.1e-5);
  EXPECT_LT(chosen.ceiling_error_m, 2e-4);
  const DecoPoint best = knee(counted(measured));
  EXPECT_GE(best.step_s, 5.0);
  EXPECT_LE(best.step_s, 30.0);
  EXPECT_EQ(best.method, kFactors);

  const test::ScratchFolder folder;
  ASSERT_TRUE(write_deco_tradeoff(folder / "out", measured).ok());
  for (const char* name : {"deco.csv", "deco.md", "deco.json", "deco.plot.json", "deco.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

}  // namespace
}  // namespace neritic::tools
