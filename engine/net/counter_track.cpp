#include "engine/net/counter_track.hpp"

namespace neritic::net {

// From the newest value; a wrap is a small step.
std::int64_t CounterTrack::step_to(std::uint64_t value) const {
  const int shift = 64 - bits_;
  return static_cast<std::int64_t>((value - value_) << shift) >> shift;
}

CounterTrack::Verdict CounterTrack::begin(std::uint64_t value, TimeNs arrived_ns, bool restarted) {
  any_ = true;
  value_ = value;
  newest_ = restarted ? newest_ + 1 : value;
  seen_ = 1;
  heard_ns_ = arrived_ns;
  doubtful_.reset();
  return restarted ? Verdict::kRestarted : Verdict::kNew;
}

CounterTrack::Verdict CounterTrack::take(std::uint64_t value, TimeNs arrived_ns,
                                         LinkCounts& counts) {
  if (!any_) return begin(value, arrived_ns, false);
  const std::int64_t step = step_to(value);
  const bool silent = arrived_ns - heard_ns_ >= kSilence_ns;
  if (step <= 0) {
    const auto back = static_cast<std::uint64_t>(-step);
    const bool seen = back < 64 && (seen_ >> back & 1) != 0;
    if (silent && step < 0) {
      ++counts.restarts;
      return begin(value, arrived_ns, true);
    }
    if (seen) {
      ++counts.repeated;
      return Verdict::kRepeated;
    }
    if (back < 64) {
      seen_ |= std::uint64_t{1} << back;
      if (counts.lost > 0) --counts.lost;
    }
    ++counts.older;
    return Verdict::kOlder;
  }
  if (step > kMostMissing) {
    const bool follows = doubtful_ && value - *doubtful_ <= 2 && value != *doubtful_;
    if (!follows) {
      doubtful_ = value;
      ++counts.malformed;
      return Verdict::kDoubtful;
    }
    ++counts.restarts;
    return begin(value, arrived_ns, true);
  }
  counts.lost += static_cast<std::uint64_t>(step - 1);
  seen_ = step < 64 ? seen_ << step | 1 : 1;
  value_ = value;
  newest_ += static_cast<std::uint64_t>(step);
  heard_ns_ = arrived_ns;
  doubtful_.reset();
  return Verdict::kNew;
}

}  // namespace neritic::net
