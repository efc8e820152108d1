// The search over all knobs together, on an error and a cost that are known.
#include "tools/tradeoff/joint_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace neritic::tools {
namespace {

const Ladders kLadders{{100, 200, 400}, {0.25, 0.5, 1.0}, {1, 2, 4}, {16, 64, 256}};

// Each knob leaves an error of its own; cost is what it multiplies.
KindPoint known(const Knobs& k) {
  KindPoint p;
  p.sweep = "joint";
  p.knobs = k;
  p.error = 1.2 / k.bins_range + 0.002 / k.scale + 0.004 / k.columns + 0.3 / k.rows;
  p.gather_ms = k.bins_range * k.scale * k.columns * std::sqrt(double(k.rows)) * 1e-3;
  return p;
}

TEST(JointSearch, NothingOfWhatItFindsWithinABoundCanBeCoarser) {
  std::map<std::string, int> repeated;
  const auto found = search_joint(
      kLadders,
      [&](const Knobs& k, int repeats) -> Result<KindPoint> {
        if (repeats == 7)
          ++repeated[fmt::format("{} {} {} {}", k.bins_range, k.scale, k.columns, k.rows)];
        return known(k);
      },
      7);
  ASSERT_TRUE(found.ok()) << found.error().message;
  KindResult result;
  result.points = *found;
  const auto coarser = [](const auto& ladder, auto value) {
    const auto at = std::ranges::find(ladder, value);
    return at == ladder.begin() ? value : *(at - 1);
  };
  for (const ErrorLevel& level : kErrorLevels) {
    const KindPoint* best = cheapest(result, level.max_error);
    ASSERT_NE(best, nullptr) << level.name;
    EXPECT_EQ(best->error, known(best->knobs).error);
    const Knobs& k = best->knobs;
    EXPECT_GT(repeated[fmt::format("{} {} {} {}", k.bins_range, k.scale, k.columns, k.rows)], 0)
        << level.name;
    Knobs one[] = {k, k, k};
    one[0].bins_range = coarser(kLadders.bins, k.bins_range);
    one[1].scale = coarser(kLadders.scales, k.scale);
    one[2].columns = coarser(kLadders.columns, k.columns);
    for (const Knobs& other : one)
      if (known(other).ms() < best->ms()) {
        EXPECT_GT(known(other).error, level.max_error) << level.name;
      }
  }
  EXPECT_LT(found->size(), 81u);  // of 81 settings some are never looked at
}

TEST(JointSearch, AFaultOfOneSettingEndsIt) {
  const auto found = search_joint(
      kLadders, [](const Knobs&, int) -> Result<KindPoint> { return bad_input("no device"); }, 3);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().message, "no device");
}

}  // namespace
}  // namespace neritic::tools
