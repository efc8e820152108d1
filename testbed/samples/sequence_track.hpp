// The sequence numbers of one source in one stream: which are new, repeated, out of order or
// missing. Remembers the newest 64. A number far ahead counts only if the next number follows it:
// one corrupt header must not make all good samples after it old. Plain value; the inbox owns it.
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
  // More numbers than this are missing only if two samples in a row say so.
  static constexpr std::uint64_t kMostMissing = 1000;
  // good: the sample has no other fault. The number of any sample counts, but a stream begins, and
  // capture times rise, by good samples alone.
  Found take(std::uint64_t sequence, TimeNs captured_ns, bool good = true);

 private:
  std::uint64_t first_ = 0, newest_ = 0;
  std::uint64_t seen_ = 0;        // bit i: newest_ - i came; 0: nothing came yet
  TimeNs captured_ns_ = 0;        // of the newest good sample in order
  std::uint64_t after_jump_ = 0;  // follows a number that was too far ahead; 0: none was
};

}  // namespace neritic::testbed
