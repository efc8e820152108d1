// The allocator's free list against a byte map, in random order: no GPU needed.
#include "engine/gpu/free_list.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "engine/core/random.hpp"

namespace neritic::gpu {
namespace {

TEST(FreeList, TakesTheFirstRangeThatFits) {
  FreeList list(100);
  EXPECT_EQ(list.allocate(40, 1), 0u);
  EXPECT_EQ(list.allocate(40, 1), 40u);
  list.release(0, 40);
  EXPECT_EQ(list.allocate(10, 1), 0u);
  EXPECT_EQ(list.allocate(31, 1), std::nullopt);  // 30 and 20 bytes are free, apart
  EXPECT_EQ(list.allocate(30, 1), 10u);
}

TEST(FreeList, KeepsTheRangeThatAlignmentSkips) {
  FreeList list(256);
  EXPECT_EQ(list.allocate(1, 1), 0u);
  EXPECT_EQ(list.allocate(64, 64), 64u);
  EXPECT_EQ(list.allocate(63, 1), 1u);  // the gap is used
  EXPECT_EQ(list.free_bytes(), 128u);
}

TEST(FreeList, MergesWithBothNeighbours) {
  FreeList list(30);
  for (const std::uint64_t at : {0u, 10u, 20u}) EXPECT_EQ(list.allocate(10, 1), at);
  list.release(0, 10);
  list.release(20, 10);
  EXPECT_EQ(list.range_count(), 2u);
  list.release(10, 10);
  EXPECT_EQ(list.range_count(), 1u);
  EXPECT_TRUE(list.all_free());
  EXPECT_EQ(list.allocate(30, 1), 0u);
}

TEST(FreeList, AFullListRefuses) {
  FreeList list(16);
  EXPECT_EQ(list.allocate(17, 1), std::nullopt);
  EXPECT_EQ(list.allocate(16, 16), 0u);
  EXPECT_EQ(list.allocate(1, 1), std::nullopt);
  FreeList empty(0);
  EXPECT_EQ(empty.allocate(1, 1), std::nullopt);
}

TEST(FreeList, HugeSizesDoNotWrapAround) {
  FreeList list(~0ull);
  EXPECT_EQ(list.allocate(1, 1), 0u);
  EXPECT_EQ(list.allocate(~0ull, 1ull << 63), std::nullopt);
  EXPECT_EQ(list.allocate(8, 1ull << 63), 1ull << 63);
}

TEST(FreeListDeathTest, GivingBackTwiceStops) {
  FreeList list(64);
  ASSERT_EQ(list.allocate(16, 1), 0u);
  ASSERT_EQ(list.allocate(16, 1), 16u);
  list.release(0, 16);
  EXPECT_DEATH(list.release(0, 16), "free already");
  EXPECT_DEATH(list.release(8, 16), "free already");
  EXPECT_DEATH(list.release(60, 16), "of 64");
}

// Whatever is done in whatever order: no two live ranges share a byte, each is aligned and inside,
// the free bytes are those nobody has, a refusal is right, and in the end all is one free range.
TEST(FreeList, RandomUseNeverOverlapsLeaksOrRefusesWrongly) {
  constexpr std::uint64_t kSize = 4096;
  struct Live {
    std::uint64_t offset, size;
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    FreeList list(kSize);
    std::vector<bool> taken(kSize, false);
    std::vector<Live> live;
    std::uint64_t index = 0, refusals = 0, free_bytes = kSize;
    const auto random = [&](std::uint64_t below) {
      return random_bits({seed, 1, 0}, index++) % below;
    };
    for (int step = 0; step < 1500; ++step) {
      if (live.empty() || random(5) < 3) {
        const std::uint64_t size = 1 + random(random(8) == 0 ? 900 : 90);
        const std::uint64_t alignment = 1ull << random(9);
        const auto offset = list.allocate(size, alignment);
        if (!offset) {
          ++refusals;
          for (std::uint64_t at = 0; at + size <= kSize; at += alignment) {
            bool fits = true;
            for (std::uint64_t b = at; b < at + size && fits; ++b) fits = !taken[b];
            ASSERT_FALSE(fits) << size << " bytes fit at " << at << " and were refused";
          }
          continue;
        }
        ASSERT_EQ(*offset % alignment, 0u);
        ASSERT_LE(*offset + size, kSize);
        for (std::uint64_t b = *offset; b < *offset + size; ++b) {
          ASSERT_FALSE(taken[b]) << "byte " << b << " given twice";
          taken[b] = true;
        }
        live.push_back({*offset, size});
        free_bytes -= size;
      } else {
        const std::size_t at = random(live.size());
        const Live gone = live[at];
        live[at] = live.back();
        live.pop_back();
        list.release(gone.offset, gone.size);
        for (std::uint64_t b = gone.offset; b < gone.offset + gone.size; ++b) taken[b] = false;
        free_bytes += gone.size;
      }
      ASSERT_EQ(list.free_bytes(), free_bytes);
    }
    EXPECT_GT(refusals, 0u) << "the run never filled the list: it proves little";
    for (const Live& rest : live) list.release(rest.offset, rest.size);
    EXPECT_TRUE(list.all_free());
    EXPECT_EQ(list.range_count(), 1u);
  }
}

}  // namespace
}  // namespace neritic::gpu
