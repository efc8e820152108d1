#include "engine/net/mxtp_frames.hpp"

#include <algorithm>
#include <utility>

namespace neritic::net {

// The place where the parts of the datagram's frame gather. A new frame takes the oldest place.
SuitFrames::Pending* SuitFrames::pending_of(const MxtpHeader& header, TimeNs arrived_ns,
                                            LinkCounts& counts) {
  const auto same = std::ranges::find_if(
      pending_, [&](const Pending& p) { return p.used && p.sample == header.sample; });
  if (same != pending_.end()) return &*same;
  const auto free = std::ranges::min_element(
      pending_, {}, [](const Pending& p) { return p.used ? p.at_ns : TimeNs{INT64_MIN}; });
  if (free->used) {  // a frame that never became whole
    ++counts.refused;
    ++incomplete_;
  }
  free->sample = header.sample;
  free->time_ms = header.time_ms;
  free->parts = 0;
  free->last = -1;
  free->at_ns = arrived_ns;
  free->poses.clear();
  free->refused = 0;
  free->hands = false;
  free->used = true;
  return &*free;
}

const SuitFrame* SuitFrames::take(const MxtpDatagram& datagram, TimeNs arrived_ns,
                                  LinkCounts& counts) {
  const auto* poses = std::get_if<std::vector<MxtpPose>>(&datagram.items);
  const MxtpHeader& header = datagram.header;
  counts.refused += datagram.refused_items;
  if (!poses || header.character != character_) {
    ++counts.unused;
    return nullptr;
  }
  if (header.datagram >= kMostParts) {
    ++counts.malformed;
    return nullptr;
  }
  Pending& pending = *pending_of(header, arrived_ns, counts);
  const std::uint32_t bit = 1U << header.datagram;
  if ((pending.parts & bit) != 0) {
    ++counts.repeated;
    return nullptr;
  }
  pending.parts |= bit;
  if (header.last) pending.last = header.datagram;
  pending.hands = pending.hands || header.finger_segments >= 2 * kMxtpHandSegments;
  pending.refused += datagram.refused_items;
  pending.poses.insert(pending.poses.end(), poses->begin(), poses->end());
  if (pending.last < 0 || pending.parts != (2U << pending.last) - 1) return nullptr;
  pending.used = false;
  using Verdict = CounterTrack::Verdict;
  const Verdict verdict = samples_.take(pending.sample, arrived_ns, counts);
  if (verdict == Verdict::kRestarted) {
    timed_ = false;
    restarted_ = true;
  }
  if (verdict != Verdict::kNew && verdict != Verdict::kRestarted) return nullptr;
  return publish(pending, header.props, counts);
}

// Whether each of the body's segments came, good or refused. A frame with fewer is not used,
// whatever its header says.
bool SuitFrames::has_body(const Pending& pending) {
  std::array<bool, kMxtpBodySegments> came{};
  for (const MxtpPose& pose : pending.poses)
    if (const std::size_t i = pose.id - 1u; i < came.size()) came[i] = true;
  const auto good = static_cast<std::size_t>(std::ranges::count(came, true));
  return good + pending.refused >= kMxtpBodySegments;
}

const SuitFrame* SuitFrames::publish(Pending& pending, std::uint8_t props, LinkCounts& counts) {
  const std::size_t hands = kMxtpBodySegments + props;
  for (const MxtpPose& pose : pending.poses) {
    const std::size_t i = pose.id - 1u;
    if (i < kMxtpBodySegments) {
      frame_.body[i] = pose;
      body_ns_[i] = pending.at_ns;
    } else if (i >= hands && i < hands + 2 * kMxtpHandSegments) {
      hands_ns_[i - hands] = pending.at_ns;
      frame_.hands[(i - hands) / kMxtpHandSegments][(i - hands) % kMxtpHandSegments] = pose;
    }
  }
  const auto fresh = [&](const std::optional<TimeNs>& at_ns) {
    return at_ns && pending.at_ns - *at_ns <= kKept_ns;
  };
  frame_.has_hands = pending.hands && std::ranges::all_of(hands_ns_, fresh);
  frame_.first_ns = pending.at_ns;
  // The clock of 32 bits, in ms, wraps after 50 days.
  const auto step = static_cast<std::int32_t>(pending.time_ms - time_ms_);
  frame_.time_ms =
      timed_ ? frame_.time_ms + static_cast<std::uint64_t>(std::int64_t{step}) : pending.time_ms;
  timed_ = true;
  time_ms_ = pending.time_ms;
  frame_.sample = samples_.newest();
  const bool whole = has_body(pending) && std::ranges::all_of(body_ns_, fresh);
  if (!whole) {
    ++counts.refused;
    ++incomplete_;
    return nullptr;
  }
  incomplete_ = 0;
  frame_.restarted = std::exchange(restarted_, false);
  return &frame_;
}

}  // namespace neritic::net
