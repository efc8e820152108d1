#include "testbed/samples/sequence_track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
  constexpr auto kMost = static_cast<std::uint64_t>(SequenceTrack::kMostMissing);
  EXPECT_EQ(track.take(2 + kMost, 0).missing, kMost);
  EXPECT_EQ(track.take(50'000, 0).verdict, kOutOfOrder);
  EXPECT_EQ(track.take(70'000, 0).verdict, kOutOfOrder);
  const auto next = track.take(70'001, 0);
  EXPECT_EQ(next.verdict, kAccepted);
  EXPECT_EQ(next.missing, 70'000 - (3 + kMost));
  EXPECT_EQ(track.take(70'000, 0).verdict, kRepeated);
}

// Numbers of samples captured a millisecond apart, as they arrive over a link with loss, repeats
// and jitter.
struct Sent {
  std::uint64_t number = 0;
  TimeNs captured_ns = 0;
};
std::vector<Sent> over_a_link(const std::vector<Sent>& sent, double loss, bool rough,
                              std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<std::pair<double, Sent>> arrived;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (share(random) < loss) continue;
    const auto arrives = [&] {
      return static_cast<double>(i) + (rough ? 8.0 * share(random) : 0.0);
    };
    arrived.push_back({arrives(), sent[i]});
    if (rough && share(random) < 0.05) arrived.push_back({arrives(), sent[i]});
  }
  std::ranges::stable_sort(arrived, {}, &std::pair<double, Sent>::first);
  std::vector<Sent> out;
  for (const auto& [at, one] : arrived) out.push_back(one);
  return out;
}

// A sender goes on at another number, or begins anew. The oracle knows which numbers came since.
TEST(SequenceTrack, ALeapIsRecognisedUnderLossRepeatsAndReordering) {
  constexpr std::uint64_t kBefore = 5000, kLast = ~std::uint64_t{0};
  struct Leap {
    std::uint64_t from, to;
  };
  for (const Leap leap : {Leap{10'000, 70'000}, Leap{10'000, 0}, Leap{kLast - kBefore - 40, 90'000},
                          Leap{kLast - 60'000 - kBefore, kLast - 100}, Leap{0, kLast - 3}})
    for (const double loss : {0.0, 0.02, 0.1})
      for (const bool rough : {false, true})
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
          SCOPED_TRACE(testing::Message() << leap.from << " to " << leap.to << ", loss " << loss
                                          << ", rough " << rough << ", seed " << seed);
          std::mt19937_64 random(seed);
          std::vector<Sent> sent;
          TimeNs at_ns = 0;
          for (std::uint64_t i = 0; i < kBefore; ++i)
            sent.push_back({leap.from + i, at_ns += 1'000'000});
          const TimeNs leapt_ns = at_ns;
          for (std::uint64_t i = 0; i < 400; ++i) sent.push_back({leap.to + i, at_ns += 1'000'000});
          SequenceTrack track;
          int unused = 0;  // new numbers after the leap, until one is accepted
          bool found = false;
          std::uint64_t accepted = 0, refused = 0, newest = 0;
          std::set<std::uint64_t> seen, used;
          for (const Sent& one : over_a_link(sent, loss, rough, random)) {
            const auto got = track.take(one.number, one.captured_ns);
            if (one.captured_ns <= leapt_ns) continue;
            const std::uint64_t number = one.number - leap.to;
            if (got.verdict == kAccepted) {
              ASSERT_TRUE(used.insert(number).second);
            }
            if (!seen.insert(number).second) continue;
            if (!found && got.verdict != kAccepted) ++unused;
            if (got.verdict == kAccepted) {
              ASSERT_TRUE(!found || number > newest);
              found = true;
              newest = number;
              ++accepted;
            } else if (found && number > newest) {
              ++refused;
            }
          }
          ASSERT_TRUE(found);
          EXPECT_EQ(refused, 0u);
          // One with neither loss nor jitter. With jitter, until the last before the leap has come.
          EXPECT_LE(unused, rough ? 20 : loss == 0.0 ? 1 : 4);
          EXPECT_GT(accepted, rough ? 50u : 330u);
        }
}

TEST(SequenceTrack, ASampleThatIsLostAfterALeapIsMissingAlone) {
  SequenceTrack track;
  track.take(5, 5);
  EXPECT_EQ(track.take(70'000, 6).verdict, kOutOfOrder);
  const auto after = track.take(70'002, 8);
  EXPECT_EQ(after.verdict, kAccepted);
  EXPECT_EQ(after.missing, 70'002u - 5 - 2);
  const auto late = track.take(70'001, 7);
  EXPECT_EQ(late.verdict, kOutOfOrder);
  EXPECT_TRUE(late.was_missing);
  // It begins anew: what went before is not missing.
  EXPECT_EQ(track.take(0, 9).verdict, kOutOfOrder);
  const auto anew = track.take(2, 11);
  EXPECT_EQ(anew.verdict, kAccepted);
  EXPECT_EQ(anew.missing, 1u);
  EXPECT_TRUE(track.take(1, 10).was_missing);
  EXPECT_EQ(track.take(3, 12).verdict, kAccepted);
}

// Old samples come late in a row: the sender did not begin anew.
TEST(SequenceTrack, OldSamplesInARowAreOutOfOrder) {
  SequenceTrack track;
  for (std::uint64_t i = 0; i < 2000; ++i) track.take(i, static_cast<TimeNs>(i));
  for (std::uint64_t i = 0; i < 1900; ++i)
    ASSERT_EQ(track.take(i, static_cast<TimeNs>(i)).verdict, kOutOfOrder);
  EXPECT_EQ(track.take(2000, 2000).verdict, kAccepted);
}

// Random numbers agree with nothing; between them the good ones go on.
TEST(SequenceTrack, NumbersThatAgreeWithNothingAreNotUsed) {
  std::mt19937_64 random(20261129);
  SequenceTrack track;
  track.take(0, 0);
  for (std::uint64_t i = 1; i < 20'000; ++i) {
    for (int k = 0; k < 5; ++k)
      ASSERT_EQ(track.take(random() | std::uint64_t{1} << 40, static_cast<TimeNs>(i)).verdict,
                kOutOfOrder);
    const auto found = track.take(i, static_cast<TimeNs>(i));
    ASSERT_EQ(found.verdict, kAccepted);
    ASSERT_EQ(found.missing, 0u);
  }
  // Samples with other faults lead nowhere either.
  for (std::uint64_t i = 0; i < 10; ++i)
    EXPECT_EQ(track.take(500'000 + i, 20'000, false).verdict, kOutOfOrder);
  EXPECT_EQ(track.take(20'000, 20'000).verdict, kAccepted);
}

}  // namespace
}  // namespace neritic::testbed
