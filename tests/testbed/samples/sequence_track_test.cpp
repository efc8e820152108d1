#include "testbed/samples/sequence_track.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace neritic::testbed {
namespace {

using enum SampleVerdict;

TEST(SequenceTrack, AStreamMayBeginAtAnyNumber) {
  SequenceTrack track;
  EXPECT_EQ(track.take(1'000'000, 0).verdict, kAccepted);
  EXPECT_EQ(track.take(1'000'001, 0).verdict, kAccepted);
}

TEST(SequenceTrack, AGapCountsWhatIsMissingAndALatecomerTakesItBack) {
  SequenceTrack track;
  track.take(10, 0);
  const auto after_gap = track.take(14, 4);
  EXPECT_EQ(after_gap.verdict, kAccepted);
  EXPECT_EQ(after_gap.missing, 3u);
  const auto latecomer = track.take(12, 2);
  EXPECT_EQ(latecomer.verdict, kOutOfOrder);
  EXPECT_TRUE(latecomer.was_missing);
  EXPECT_EQ(track.take(12, 2).verdict, kRepeated);
  EXPECT_EQ(track.take(14, 4).verdict, kRepeated);
}

TEST(SequenceTrack, ACaptureTimeThatRunsBackIsOutOfOrder) {
  SequenceTrack track;
  track.take(1, 100);
  EXPECT_EQ(track.take(2, 99).verdict, kOutOfOrder);
  EXPECT_EQ(track.take(3, 100).verdict, kAccepted);  // not held against the newest one
}

TEST(SequenceTrack, NumbersMoreThan64BackAreOutOfOrder) {
  SequenceTrack track;
  for (std::uint64_t i = 0; i < 100; ++i) track.take(i, 0);
  EXPECT_EQ(track.take(99 - 63, 0).verdict, kRepeated);
  const auto far = track.take(99 - 64, 0);
  EXPECT_EQ(far.verdict, kOutOfOrder);
  EXPECT_FALSE(far.was_missing);
}

// The oracle remembers every number.
TEST(SequenceTrack, AShuffledStreamIsCountedAsASetOfNumbersSays) {
  std::mt19937_64 random(20261123);
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t i = 0; i < 5000; ++i)
    for (std::uint64_t n = random() % 4; n < 3; n += 2) numbers.push_back(i);  // 0 to 2 times
  for (std::size_t i = 0; i + 32 < numbers.size(); i += 32)
    std::shuffle(numbers.begin() + static_cast<std::ptrdiff_t>(i),
                 numbers.begin() + static_cast<std::ptrdiff_t>(i) + 32, random);
  SequenceTrack track;
  std::set<std::uint64_t> seen;
  std::uint64_t missing = 0;
  for (const std::uint64_t number : numbers) {
    const auto found = track.take(number, 0);
    const bool first = seen.empty(), repeated = seen.contains(number);
    const bool newest = first || number > *seen.rbegin();
    ASSERT_EQ(found.verdict, repeated ? kRepeated : newest ? kAccepted : kOutOfOrder) << number;
    missing += found.missing;
    missing -= found.was_missing ? 1 : 0;
    seen.insert(number);
  }
  const auto since_first = std::distance(seen.find(numbers.front()), seen.end());
  EXPECT_GT(missing, 100u);
  EXPECT_EQ(missing,
            *seen.rbegin() - numbers.front() + 1 - static_cast<std::uint64_t>(since_first));
}

TEST(SequenceTrack, ALargeGapCountsOnceTheNextNumberFollowsIt) {
  SequenceTrack track;
  track.take(1, 0);
  EXPECT_EQ(track.take(2 + SequenceTrack::kMostMissing, 0).missing, SequenceTrack::kMostMissing);
  EXPECT_EQ(track.take(50'000, 0).verdict, kOutOfOrder);
  EXPECT_EQ(track.take(70'000, 0).verdict, kOutOfOrder);
  const auto next = track.take(70'001, 0);
  EXPECT_EQ(next.verdict, kAccepted);
  EXPECT_EQ(next.missing, 70'000 - (3 + SequenceTrack::kMostMissing));
  EXPECT_EQ(track.take(70'000, 0).verdict, kRepeated);
}

}  // namespace
}  // namespace neritic::testbed
