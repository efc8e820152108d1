// The sequence numbers of one source in one stream: which are new, repeated, out of order or
// missing. Remembers the newest 64, over a wrap too. A number far ahead, or far back of a sample
// that was captured later (a sender that began anew), counts only if those after it go on from
// there, since one corrupt header must not make all good samples after it old: at once if the next
// is one or two more, else the fourth that rises by no more than kMostMissing. Loss, repeats and
// late samples meanwhile do not hinder that. A sender that begins anew within 64 numbers of the
// newest is repeated until it has passed that. Plain value; the inbox owns it.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

// The fate of a sample that came in.
enum class SampleVerdict {
  kAccepted,
  kRepeated,       // its sequence number came before
  kOutOfOrder,     // older than what came before, by number or by capture time
  kLate,           // captured too long ago, or after it arrived
  kNotFinite,      // a number is NaN or infinite
  kNotPlausible,   // a place off the Earth, a rotation that is no unit quaternion
  kNotOfStream,    // no such stream, an output, or another kind of payload than the stream's
  kUnknownSource,  // the source was never opened
};

// "out of order", "late".
std::string_view name_of(SampleVerdict verdict);

class SequenceTrack {
 public:
  struct Found {
    SampleVerdict verdict = SampleVerdict::kAccepted;
    std::uint64_t missing = 0;  // numbers between the newest and this one
    bool was_missing = false;   // out of order, and counted as missing until now
  };
  // More numbers than this are missing only if several samples in a row say so.
  static constexpr std::int64_t kMostMissing = 1000;
  static constexpr int kAgree = 3;  // samples that go on from a number far away
  // good: the sample has no other fault. The number of any sample counts, but a stream begins, and
  // capture times rise, by good samples alone.
  Found take(std::uint64_t sequence, TimeNs captured_ns, bool good = true);

 private:
  Found in_turn(std::uint64_t missing, TimeNs captured_ns, bool good);
  Found take_far(std::uint64_t sequence, TimeNs captured_ns, bool good);

  // Numbers after first_ that did not come were counted as missing.
  std::uint64_t first_ = 0, newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: newest_ - i came; 0: nothing came yet
  TimeNs captured_ns_ = 0;  // of the newest good sample in order
  // Good samples far from newest_ whose numbers go on from one another.
  std::uint64_t far_came_ = 0;  // how many; 0: none
  std::uint64_t far_newest_ = 0, far_lowest_ = 0;
  std::uint64_t far_seen_ = 0;  // bit i: far_newest_ - i came
  int agree_ = 0;               // how many rose
};

}  // namespace neritic::testbed
