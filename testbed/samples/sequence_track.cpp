#include "testbed/samples/sequence_track.hpp"

namespace neritic::testbed {

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
  constexpr std::uint64_t kWindow = 64;
  if (seen_ == 0) {
    if (!good) return {};
    first_ = newest_ = sequence;
    seen_ = 1;
    captured_ns_ = captured_ns;
    return {};
  }
  if (sequence <= newest_) {
    const std::uint64_t back = newest_ - sequence;
    if (back >= kWindow) return {SampleVerdict::kOutOfOrder, 0, false};
    const std::uint64_t bit = std::uint64_t{1} << back;
    if ((seen_ & bit) != 0) return {SampleVerdict::kRepeated, 0, false};
    seen_ |= bit;
    return {SampleVerdict::kOutOfOrder, 0, sequence > first_};
  }
  const std::uint64_t ahead = sequence - newest_;
  std::uint64_t missing = ahead - 1;
  if (missing > kMostMissing) {
    if (sequence != after_jump_) {
      after_jump_ = good ? sequence + 1 : 0;
      return {SampleVerdict::kOutOfOrder, 0, false};
    }
    --missing;  // the number before this one came
    seen_ = 3;
  } else {
    seen_ = ahead < kWindow ? seen_ << ahead | 1 : 1;
  }
  newest_ = sequence;
  after_jump_ = 0;
  if (!good) return {SampleVerdict::kAccepted, missing, false};
  const bool in_order = captured_ns >= captured_ns_;
  if (in_order) captured_ns_ = captured_ns;
  return {in_order ? SampleVerdict::kAccepted : SampleVerdict::kOutOfOrder, missing, false};
}

}  // namespace neritic::testbed
