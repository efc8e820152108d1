// The table of a live program's times.
#include "testbed/view/dive_times.hpp"

#include <gtest/gtest.h>

namespace neritic::testbed {
namespace {

TEST(DiveTimes, WhatWasNotMeasuredHasNoLine) {
  DiveTimes times(true);
  const gpu::PassTime passes[] = {{"shade", 3.0}};
  times.add_passes(passes, 1);
  EXPECT_EQ(times.summary(1, 0.5).find("frame  "), std::string::npos) << times.summary(1, 0.5);
  EXPECT_NE(times.summary(1, 0.5).find("shade      3.000      3.000       1"), std::string::npos)
      << times.summary(1, 0.5);
  times.add_frame(20.0, 2);
  EXPECT_NE(times.summary(2, 0.5).find("frame     20.000     20.000       1"), std::string::npos)
      << times.summary(2, 0.5);
}

}  // namespace
}  // namespace neritic::testbed
