// Ranges that share out work: every item once, few items on the calling thread.
#include "engine/core/parallel.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace neritic {
namespace {

TEST(Parallel, EveryItemIsInOneRange) {
  for (const std::size_t count : {0, 1, 2, 7, 1000})
    for (const std::size_t ranges : {1, 2, 3, 8}) {
      std::vector<int> done(count, 0);
      std::vector<std::size_t> ends(ranges, 0);
      in_ranges(count, ranges, [&](std::size_t range, std::size_t begin, std::size_t end) {
        EXPECT_LE(begin, end);
        ends[range] = end;
        for (std::size_t i = begin; i < end; ++i) ++done[i];
      });
      EXPECT_EQ(done, std::vector<int>(count, 1)) << ranges << " ranges";
      EXPECT_TRUE(std::ranges::is_sorted(ends));
      EXPECT_EQ(ends.back(), count);
    }
}

TEST(Parallel, FewItemsStayOnTheCallingThread) {
  EXPECT_EQ(ranges_of(0, 1000), 1u);
  EXPECT_EQ(ranges_of(1999, 1000), 1u);
  EXPECT_LE(ranges_of(1000000, 1), std::max(1u, std::thread::hardware_concurrency()));
  std::thread::id by;
  in_ranges(5, 1, [&](std::size_t, std::size_t, std::size_t) { by = std::this_thread::get_id(); });
  EXPECT_EQ(by, std::this_thread::get_id());
}

}  // namespace
}  // namespace neritic
