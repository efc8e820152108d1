#include "testbed/samples/sequence_track.hpp"

namespace neritic::testbed {

namespace {

constexpr std::int64_t kWindow = 64;  // numbers that are remembered
constexpr std::int64_t kNear = 2;

// From one number to another; a wrap is a small step.
std::int64_t step(std::uint64_t from, std::uint64_t to) {
  return static_cast<std::int64_t>(to - from);
}

}  // namespace

std::string_view name_of(SampleVerdict verdict) {
  switch (verdict) {
    case SampleVerdict::kAccepted:
      return "accepted";
    case SampleVerdict::kRepeated:
      return "repeated";
    case SampleVerdict::kOutOfOrder:
      return "out of order";
    case SampleVerdict::kLate:
      return "late";
    case SampleVerdict::kNotFinite:
      return "not finite";
    case SampleVerdict::kNotPlausible:
      return "not plausible";
    case SampleVerdict::kNotOfStream:
      return "not of its stream";
    case SampleVerdict::kUnknownSource:
      return "of an unknown source";
  }
  return "";
}

SequenceTrack::Found SequenceTrack::take(std::uint64_t sequence, TimeNs captured_ns, bool good) {
  if (seen_ == 0) {
    if (!good) return {};
    first_ = newest_ = sequence;
    seen_ = 1;
    captured_ns_ = captured_ns;
    return {};
  }
  const std::int64_t ahead = step(newest_, sequence);
  if (ahead <= -kWindow || ahead > kMostMissing + 1) return take_far(sequence, captured_ns, good);
  if (ahead <= 0) {
    const std::uint64_t bit = std::uint64_t{1} << -ahead;
    if ((seen_ & bit) != 0) return {SampleVerdict::kRepeated, 0, false};
    seen_ |= bit;
    return {SampleVerdict::kOutOfOrder, 0, step(first_, sequence) > 0};
  }
  seen_ = ahead < kWindow ? seen_ << ahead | 1 : 1;
  newest_ = sequence;
  far_came_ = 0;
  return in_turn(static_cast<std::uint64_t>(ahead - 1), captured_ns, good);
}

SequenceTrack::Found SequenceTrack::in_turn(std::uint64_t missing, TimeNs captured_ns, bool good) {
  if (!good) return {SampleVerdict::kAccepted, missing, false};
  const bool in_order = captured_ns >= captured_ns_;
  if (in_order) captured_ns_ = captured_ns;
  return {in_order ? SampleVerdict::kAccepted : SampleVerdict::kOutOfOrder, missing, false};
}

SequenceTrack::Found SequenceTrack::take_far(std::uint64_t sequence, TimeNs captured_ns,
                                             bool good) {
  constexpr Found kUnused{SampleVerdict::kOutOfOrder, 0, false};
  // An old sample that comes late has an old capture time; a sender that began anew has not.
  const bool back = step(newest_, sequence) < 0;
  if (!good || captured_ns < captured_ns_ || (back && captured_ns == captured_ns_)) return kUnused;
  const std::int64_t on = step(far_newest_, sequence);
  if (far_came_ > 0 && on <= 0 && on > -kWindow) {  // comes late or twice, which tells nothing
    const std::uint64_t bit = std::uint64_t{1} << -on;
    if ((far_seen_ & bit) != 0) return {SampleVerdict::kRepeated, 0, false};
    far_seen_ |= bit;
    ++far_came_;
    if (step(far_lowest_, sequence) < 0) far_lowest_ = sequence;
    return kUnused;
  }
  if (far_came_ > 0 && on > 0 && on <= kMostMissing) {
    far_seen_ = on < kWindow ? far_seen_ << on | 1 : 1;
    ++far_came_;
    ++agree_;
  } else {
    far_lowest_ = sequence;
    far_seen_ = far_came_ = 1;
    agree_ = 0;
  }
  far_newest_ = sequence;
  if (agree_ < kAgree && !(agree_ > 0 && on <= kNear)) return kUnused;
  // Numbers that were skipped are missing; those before a number that fell are another count's.
  first_ = back ? far_lowest_ - 1 : newest_;
  const std::uint64_t missing = sequence - first_ - far_came_;
  newest_ = sequence;
  seen_ = far_seen_;
  far_came_ = 0;
  return in_turn(missing, captured_ns, good);
}

}  // namespace neritic::testbed
