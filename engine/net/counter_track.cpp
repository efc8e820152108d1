#include "engine/net/counter_track.hpp"

#include <fmt/format.h>

namespace neritic::net {
namespace {

constexpr std::int64_t kNear = 2, kLate = 64;

}  // namespace

// A wrap is a small step.
std::int64_t CounterTrack::step(std::uint64_t from, std::uint64_t to) const {
  const int shift = 64 - bits_;
  return static_cast<std::int64_t>((to - from) << shift) >> shift;
}

std::string CounterTrack::trouble() const {
  if (far_ < kTold) return {};
  return fmt::format("its packets' numbers leap by more than {}", kMostMissing);
}

// Whether a value far ahead and those before it are the numbers of one device. One that is repeated
// or comes late does not change what they say.
bool CounterTrack::goes_on(std::uint64_t value) {
  const std::int64_t on = doubtful_ ? step(*doubtful_, value) : kMostMissing + 1;
  if (on <= 0 && on > -kLate) return false;
  agree_ = on > 0 && on <= kMostMissing ? agree_ + 1 : 0;
  doubtful_ = value;
  return agree_ >= kAgree || (agree_ > 0 && on <= kNear);
}

CounterTrack::Verdict CounterTrack::begin(std::uint64_t value, TimeNs arrived_ns, bool restarted) {
  any_ = true;
  other_ = false;
  value_ = value;
  newest_ = restarted ? newest_ + 1 : value;
  seen_ = 1;
  heard_ns_ = arrived_ns;
  doubtful_.reset();
  far_ = 0;
  return restarted ? Verdict::kRestarted : Verdict::kNew;
}

CounterTrack::Verdict CounterTrack::take(std::uint64_t value, TimeNs arrived_ns,
                                         LinkCounts& counts) {
  if (!any_) return begin(value, arrived_ns, false);
  if (other_) {
    ++counts.restarts;
    return begin(value, arrived_ns, true);
  }
  const std::int64_t step = this->step(value_, value);
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
    if (goes_on(value)) {
      ++counts.restarts;
      return begin(value, arrived_ns, true);
    }
    ++far_;
    ++counts.malformed;
    return Verdict::kDoubtful;
  }
  counts.lost += static_cast<std::uint64_t>(step - 1);
  seen_ = step < 64 ? seen_ << step | 1 : 1;
  value_ = value;
  newest_ += static_cast<std::uint64_t>(step);
  heard_ns_ = arrived_ns;
  doubtful_.reset();
  far_ = 0;
  return Verdict::kNew;
}

}  // namespace neritic::net
