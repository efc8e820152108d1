#include "engine/sim/workers.hpp"

#include <gtest/gtest.h>

namespace neritic::sim {
namespace {

TEST(Workers, EveryTaskRunsOnceOnAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const std::size_t count : {0u, 1u, 8u, 9u, 1000u}) {
      std::vector<int> done(count, 0);
      for (int round = 0; round < 50; ++round)
        workers.run(count, [&](std::size_t i, unsigned thread) {
          EXPECT_LT(thread, threads);
          ++done[i];
        });
      EXPECT_EQ(done, std::vector<int>(count, 50)) << threads << " " << count;
    }
  }
}

}  // namespace
}  // namespace neritic::sim
