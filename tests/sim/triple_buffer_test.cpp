#include "engine/sim/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "engine/core/clock.hpp"
#include "tests/support/support.hpp"

namespace neritic::sim {
namespace {

// Every order of up to nine publishes (P) and updates (U), against what a single variable would
// hold.
TEST(TripleBuffer, EveryOrderOfPublishingAndTakingGivesTheNewest) {
  constexpr int kLength = 12;
  for (int order = 0; order < (1 << kLength); ++order) {
    TripleBuffer<int> buffer(0);
    int published = 0, seen = 0;
    for (int i = 0; i < kLength; ++i) {
      if ((order >> i & 1) != 0) {
        buffer.publish(++published);
      } else {
        const bool is_new = published != seen;
        ASSERT_EQ(buffer.update(), is_new) << order << " " << i;
        seen = published;
      }
      ASSERT_EQ(buffer.newest(), seen) << order << " " << i;  // untouched by publishing
    }
  }
}

TEST(TripleBuffer, AReaderBesideTheWriterNeverSeesAMixtureNorGoesBack) {
  using Block = std::array<std::uint64_t, 64>;
  TripleBuffer<Block> buffer(Block{});
  std::atomic<bool> done{false};
  constexpr std::uint64_t kLast = 200'000;
  std::thread writer([&] {
    Block block{};
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      block.fill(i);
      buffer.publish(block);
    }
    done = true;
  });
  std::uint64_t last = 0, mixtures = 0, backwards = 0;
  for (bool finished = false; !finished;) {
    finished = done;
    buffer.update();
    const Block& block = buffer.newest();
    for (const std::uint64_t word : block) mixtures += word != block[0];
    backwards += block[0] < last;
    last = block[0];
  }
  writer.join();
  EXPECT_EQ(mixtures, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(last, kLast);
}

// The price of one hand-off, publish and take together, of a state of 1 KiB: the median of many,
// since a machine under load may stop any of them.
TEST(TripleBuffer, HandsOverAKilobyteInLessThanAMicrosecond) {
  using Block = std::array<double, 128>;
  TripleBuffer<Block> buffer(Block{});
  constexpr int kBatch = 100, kBatches = 201;
  std::vector<double> per_hand_off_ns;
  Block block{};
  double sum = 0.0;
  for (int batch = 0; batch < kBatches; ++batch) {
    const TimeNs start = now_ns();
    for (int i = 0; i < kBatch; ++i) {
      block[0] = i;
      buffer.publish(block);
      buffer.update();
      const Block copy = buffer.newest();
      sum += copy[0];
    }
    per_hand_off_ns.push_back(static_cast<double>(now_ns() - start) / kBatch);
  }
  std::nth_element(per_hand_off_ns.begin(), per_hand_off_ns.begin() + kBatches / 2,
                   per_hand_off_ns.end());
  EXPECT_EQ(sum, kBatches * (kBatch - 1) * kBatch / 2.0);
  RecordProperty("median_ns", std::to_string(per_hand_off_ns[kBatches / 2]));
  if (neritic::test::kFast) {
    EXPECT_LT(per_hand_off_ns[kBatches / 2], 1000.0);
  }
}

}  // namespace
}  // namespace neritic::sim
