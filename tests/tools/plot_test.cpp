// The axes of plots.
#include "tools/common/plot.hpp"

#include <gtest/gtest.h>

namespace neritic::tools {
namespace {

TEST(PlotTicks, AreOneTwoFiveTimesPowersOfTen) {
  EXPECT_EQ(ticks({"", 1.0, 100.0, true}),
            (std::vector<double>{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}));
  EXPECT_EQ(ticks({"", 0.0, 6.0, false}), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ticks({"", 6.0, 0.0, false}), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(PlotTicks, ALogarithmicAxisOfLessThanADecadeHasEnough) {
  EXPECT_EQ(ticks({"", 28.0, 92.0, true}), (std::vector<double>{40.0, 60.0, 80.0}));
  EXPECT_EQ(ticks({"", 3.0, 4.0, true}).size(), 6u);  // 3, 3.2, ... 4
}

}  // namespace
}  // namespace neritic::tools
