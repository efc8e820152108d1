// The messages that a run used, by step, and the hash of its state after each step: enough to run
// it again and to see whether it went the same way. Plain values; any thread.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace neritic::sim {

// The longest step a simulation takes, in seconds.
inline constexpr double kMaxStep_s = 1.0;

template <class Inputs, class Message>
struct RunLog {
  struct Entry {
    std::uint64_t step = 0;  // that used it first
    Message message{};
  };
  double step_s = 0.0;
  std::uint64_t seed = 0;        // the run's, for setting the run up again
  std::uint64_t first_step = 0;  // where it begins: not 0 after a restored state
  Inputs start{};                // before the first message
  std::deque<Entry> entries;  // a deque: to add one never moves the others, which would take long
  std::vector<std::uint64_t> hashes;  // one more than there are steps

  std::uint64_t steps() const { return hashes.empty() ? 0 : hashes.size() - 1; }
};

}  // namespace neritic::sim
