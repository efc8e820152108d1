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
  EXPECT_GT(point_of(t, "turning", diver::Model::kPlanar, 4, 1.0).error_m, error(4, 1.0));
  EXPECT_GT(point_of(t, "straight", diver::Model::kFull, 4, 1.0).us_a_second,
            5.0 * point_of(t, "straight", diver::Model::kFull, 4, 12.5).us_a_second);
  EXPECT_EQ(std::ranges::count_if(t.points, is_default), 2);
  ASSERT_NE(knee(t, "straight"), nullptr);
  EXPECT_EQ(knee(t, "straight")->model, diver::Model::kFull);

  test::ScratchFolder folder;
  ASSERT_TRUE(write_swim_tradeoff(folder / "out", t).ok());
  for (const char* name : {"swim.csv", "swim.md", "swim.json", "swim.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  EXPECT_THAT(read_text(folder / "out" / "swim.md").value(), testing::HasSubstr("(default)"));
}

}  // namespace
}  // namespace neritic::tools
