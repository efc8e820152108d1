// A device's counter that wraps, as one that does not; and which values are new, repeated, older or
// missing. A value far ahead counts only if those after it go on from there, since one corrupt
// packet must not make all good ones after it old: at once if the next is one or two more, else the
// third that rises by no more than kMostMissing. An older value after a silence is that of a device
// that was started again. Plain value; one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/core/clock.hpp"

namespace neritic::net {

struct LinkCounts {
  std::uint64_t datagrams = 0, bytes = 0;
  std::uint64_t malformed = 0;  // no datagram of the device's, or one that is not whole
  std::uint64_t unused = 0;     // whole ones that the scene has no use for
  std::uint64_t used = 0;       // all others that are new
  std::uint64_t repeated = 0, older = 0, lost = 0;
  std::uint64_t restarts = 0;    // of the device
  std::uint64_t refused = 0;     // parts of whole ones: a segment that is not finite
  std::uint64_t overflowed = 0;  // dropped by the full receive queue
  std::uint64_t strangers = 0;   // datagrams of another address than the one used; nobody read them
};

class CounterTrack {
 public:
  // bits: the counter's width, 8 to 64.
  explicit CounterTrack(int bits) : bits_(bits) {}

  enum class Verdict { kNew, kRepeated, kOlder, kDoubtful, kRestarted };
  // The value of a packet that arrived then; counts what it finds. An older value that was counted
  // as lost is so no more. kDoubtful: far ahead; counted as malformed.
  Verdict take(std::uint64_t value, TimeNs arrived_ns, LinkCounts& counts);
  // The next value is that of another device: it counts, as a restart.
  void restart() { other_ = true; }
  // The value of the newest packet without wraps: rises, also over a restart.
  std::uint64_t newest() const { return newest_; }

  // Why no value counts, in words, after kTold in a row that are far ahead; empty: they count.
  std::string trouble() const;

  static constexpr std::int64_t kMostMissing = 1000;
  static constexpr int kAgree = 3;  // values that go on from one far ahead
  static constexpr std::uint64_t kTold = 3;
  static constexpr TimeNs kSilence_ns = 500'000'000;

 private:
  std::int64_t step(std::uint64_t from, std::uint64_t to) const;
  bool goes_on(std::uint64_t value);
  Verdict begin(std::uint64_t value, TimeNs arrived_ns, bool restarted);

  int bits_;
  bool any_ = false;
  bool other_ = false;                     // the next value is of another device
  std::uint64_t value_ = 0;                // the newest, as it came
  std::uint64_t newest_ = 0;               // without wraps
  std::uint64_t seen_ = 0;                 // bit i: newest - i came
  TimeNs heard_ns_ = 0;                    // the newest good value
  std::optional<std::uint64_t> doubtful_;  // the value far ahead that came last
  int agree_ = 0;                          // values in a row that went on to it
  std::uint64_t far_ = 0;                  // values far ahead in a row
};

}  // namespace neritic::net
