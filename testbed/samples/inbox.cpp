#include "testbed/samples/inbox.hpp"

#include <algorithm>

#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"

namespace neritic::testbed {
namespace {

constexpr int kDrainAttempts = 200;  // some 10 us

void count(SampleVerdict verdict, SourceCounts& counts) {
  switch (verdict) {
    case SampleVerdict::kAccepted:
      ++counts.accepted;
      break;
    case SampleVerdict::kRepeated:
      ++counts.repeated;
      break;
    case SampleVerdict::kOutOfOrder:
      ++counts.out_of_order;
      break;
    case SampleVerdict::kLate:
      ++counts.late;
      break;
    case SampleVerdict::kNotFinite:
      ++counts.not_finite;
      break;
    case SampleVerdict::kNotPlausible:
      ++counts.not_plausible;
      break;
    case SampleVerdict::kNotOfStream:
      ++counts.not_of_stream;
      break;
    case SampleVerdict::kUnknownSource:
      break;  // no source to count it by
  }
}

// A payload by its numbers alone.
SampleVerdict content_of(const Payload& payload) {
  if (!all_finite(payload)) return SampleVerdict::kNotFinite;
  return plausible(payload) ? SampleVerdict::kAccepted : SampleVerdict::kNotPlausible;
}

}  // namespace

SampleInbox::SampleInbox(const StreamTable& streams, std::size_t capacity)
    : streams_(streams), capacity_(capacity) {
  NERITIC_CHECK(capacity > 0, "capacity {}", capacity);
  filling_.reserve(2 * capacity);
  draining_.reserve(2 * capacity);
  sources_.reserve(kMaxSources);
  sources_.push_back(
      {std::string(kSimulationName), kMaxAge_ns, {}, std::vector<Track>(streams.size())});
}

Result<SourceId> SampleInbox::open(const std::string& name, TimeNs max_age_ns) {
  NERITIC_TRY_STATUS(check_source_name("source", name));
  const std::lock_guard lock(mutex_);
  for (SourceId id = 0; id < sources_.size(); ++id) {
    Source& source = sources_[id];
    if (source.name != name) continue;
    source.max_age_ns = max_age_ns;
    for (Track& track : source.tracks) track.sequence = {};
    return id;
  }
  if (sources_.size() == kMaxSources)
    return refusal("source: " + name, fmt::format("a new one beside {}", sources_.size() - 1),
                   fmt::format("up to {}", kMaxSources - 1));
  sources_.push_back({name, max_age_ns, {}, std::vector<Track>(streams_.size())});
  return static_cast<SourceId>(sources_.size() - 1);
}

SampleVerdict SampleInbox::check(const Sample& sample, SampleVerdict content, Source& source) {
  const SampleHeader& header = sample.header;
  if (header.stream >= streams_.size() || streams_[header.stream].kind != sample.kind() ||
      !enters(sample.kind()))
    return SampleVerdict::kNotOfStream;
  const bool late = header.captured_ns < header.arrived_ns - source.max_age_ns ||
                    header.captured_ns > header.arrived_ns + kMaxAhead_ns;
  // The number counts as come, whatever becomes of the sample; its capture time only if it is good.
  const bool good = content == SampleVerdict::kAccepted;
  const auto found = source.tracks[header.stream].sequence.take(header.sequence, header.captured_ns,
                                                                good && !late);
  source.counts.lost += found.missing;
  if (found.was_missing) --source.counts.lost;
  if (found.verdict != SampleVerdict::kAccepted) return found.verdict;
  if (!good) return content;
  return late ? SampleVerdict::kLate : SampleVerdict::kAccepted;
}

void SampleInbox::store(const Sample& sample) {
  if (filling_.size() < capacity_) {
    filling_.push_back(sample);
    return;
  }
  Track& track = sources_[sample.header.source].tracks[sample.header.stream];
  if (track.slot > 0) {
    filling_[track.slot] = sample;
    ++sources_[sample.header.source].counts.dropped;
  } else if (filling_.size() < 2 * capacity_) {
    track.slot = filling_.size();
    filling_.push_back(sample);
  } else {
    ++sources_[sample.header.source].counts.dropped;
  }
}

SampleVerdict SampleInbox::push(const Sample& sample) {
  const SampleVerdict content = content_of(sample.payload);
  const std::lock_guard lock(mutex_);
  if (sample.header.source >= sources_.size()) {
    ++unknown_sources_;
    return SampleVerdict::kUnknownSource;
  }
  Source& source = sources_[sample.header.source];
  const SampleVerdict verdict = check(sample, content, source);
  count(verdict, source.counts);
  if (verdict == SampleVerdict::kAccepted) store(sample);
  return verdict;
}

std::span<const Sample> SampleInbox::drain() {
  draining_.clear();
  std::unique_lock lock(mutex_, std::defer_lock);
  for (int i = 0; i < kDrainAttempts && !lock.owns_lock(); ++i) (void)lock.try_lock();
  if (!lock.owns_lock()) {
    ++postponed_;
    return {};
  }
  std::swap(filling_, draining_);
  for (std::size_t i = capacity_; i < draining_.size(); ++i) {
    const SampleHeader& header = draining_[i].header;
    sources_[header.source].tracks[header.stream].slot = 0;
  }
  return draining_;
}

std::vector<std::string> SampleInbox::source_names() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const Source& source : sources_) names.push_back(source.name);
  return names;
}

std::optional<SourceId> SampleInbox::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(sources_, name, &Source::name);
  if (found == sources_.end()) return std::nullopt;
  return static_cast<SourceId>(found - sources_.begin());
}

void SampleInbox::begin_anew() {
  const std::lock_guard lock(mutex_);
  for (Source& source : sources_)
    for (Track& track : source.tracks) track.sequence = {};
}

SourceCounts SampleInbox::counts(SourceId source) const {
  const std::lock_guard lock(mutex_);
  return sources_.at(source).counts;
}

std::uint64_t SampleInbox::unknown_sources() const {
  const std::lock_guard lock(mutex_);
  return unknown_sources_;
}

}  // namespace neritic::testbed
