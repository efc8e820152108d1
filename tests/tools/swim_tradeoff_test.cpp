// `neritic tradeoff swim`: what its curves say, and what it writes.
#include "tools/tradeoff/swim_tradeoff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

const SwimPoint& point_of(const SwimTradeoff& t, const std::string& swim, diver::Model model,
                          int strips, double step_ms) {
  for (const SwimPoint& p : t.points)
    if (p.swim == swim && p.model == model && p.strips == strips &&
        std::abs(1e3 * p.step_s - step_ms) < 1e-3)
      return p;
  ADD_FAILURE() << "no such point";
  return t.points[0];
}

TEST(SwimTradeoff, ErrorsFallWithStepsAndStripsAndThePlanarModelIsFarther) {
  int done = 0;
  SwimTradeoffOptions options{.quick = true};
  options.truth_step_s = 0.5e-3;
  options.strips = {1, 4, 6, 16};
  options.steps_ms = {1, 2, 1e3 / 240, 8, 12.5};
  options.step = [&] { ++done; };
  const SwimTradeoff t = run_swim_tradeoff(options);
  EXPECT_EQ(static_cast<std::uint64_t>(done), steps(options));
  EXPECT_LT(t.reference_error_m, 1e-3);
  EXPECT_GT(t.way_m, 0.4);
  const auto error = [&](int strips, double step_ms) {
    return point_of(t, "turning", diver::Model::kFull, strips, step_ms).error_m;
  };
  EXPECT_LT(error(16, 2.0), 0.4 * error(16, 8.0));
  EXPECT_LT(error(4, 1.0), 0.5 * error(1, 1.0));
  EXPECT_LT(error(16, 1.0), error(4, 1.0));
  EXPECT_GT(point_of(t, "turning", diver::Model::kPlanar, 6, 1.0).error_m, error(4, 1.0));
  EXPECT_GT(point_of(t, "straight", diver::Model::kFull, 4, 1.0).strips_a_second,
            12.0 * point_of(t, "straight", diver::Model::kFull, 4, 12.5).strips_a_second);
  EXPECT_EQ(std::ranges::count_if(t.points, is_default), 3);
  ASSERT_NE(knee(t.points, "ascent"), nullptr);
  EXPECT_EQ(knee(t.points, "ascent")->model, diver::Model::kFull);

  test::ScratchFolder folder;
  ASSERT_TRUE(write_swim_tradeoff(folder / "out", t).ok());
  for (const char* name : {"swim.csv", "swim.md", "swim.json", "swim.plot.json", "swim.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  EXPECT_THAT(read_text(folder / "out" / "swim.md").value(), testing::HasSubstr("(default)"));
}

// By errors and counted strips alone, so that the default stays where it is on any machine.
TEST(SwimTradeoff, TheDefaultIsTheCheapestWithinAQuarterPercentOfAnySwim) {
  SwimTradeoffOptions options;
  options.timed = false;
  options.truth_step_s = 0.5e-3;
  options.strips = {4, 5, 6, 16};
  options.steps_ms = {1e3 / 240, 5.0};
  if (test::is_thorough()) options.steps_ms.push_back(3.0);
  const SwimTradeoff t = run_swim_tradeoff(options);
  EXPECT_LT(t.reference_error_m, 1e-3);
  const std::vector<SwimPoint> worst = worst_of_all(t);
  EXPECT_EQ(worst.size(), 5 * options.steps_ms.size());
  const SwimPoint* const best = cheapest_within(worst, kAllSwims, kWithinShare * t.way_m);
  ASSERT_NE(best, nullptr);
  EXPECT_TRUE(is_default(*best)) << best->strips << " strips, " << best->step_s << " s";
  EXPECT_NEAR(best->strips_a_second, 240.0 * (kStepInStrips + 19.0 * 6.0 + 1.0), 1e-6);
  // Straight ahead and up fewer strips would do; it is turns that ask for them.
  const auto fewest = [&](const char* swim) {
    const SwimPoint* const p = cheapest_within(t.points, swim, kWithinShare * t.way_m);
    return p == nullptr ? 0 : p->strips;
  };
  EXPECT_EQ(fewest("straight"), 4);
  EXPECT_EQ(fewest("ascent"), 4);
  EXPECT_EQ(fewest("turning"), 6);
  // More strips than the default's leave what the step does.
  const auto error = [&](int strips) {
    double most = 0.0;
    for (const SwimPoint& p : worst)
      if (p.strips == strips && p.step_s == best->step_s && p.model == diver::Model::kFull)
        most = p.error_m;
    return most;
  };
  EXPECT_LT(error(6), 1.05 * error(16));
  EXPECT_GT(error(5), 1.1 * error(16));
}

}  // namespace
}  // namespace neritic::tools
