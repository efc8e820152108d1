#include "testbed/samples/recorded_source.hpp"

#include <algorithm>

#include "engine/core/source_name.hpp"

namespace neritic::testbed {
namespace {

// Times in a log are those of the run that was recorded, so none of its samples is too old.
constexpr TimeNs kAnyAge_ns = TimeNs{1} << 61;
// The rounding of the time of a poll.
constexpr double kRounding_s = 1e-9;

}  // namespace

Result<RecordedSource> RecordedSource::create(SampleLog log, const StreamTable& table,
                                              std::string name, std::uint64_t start_step) {
  NERITIC_TRY_STATUS(check_streams(log, table, name));
  RecordedSource source(std::move(log), std::move(name), start_step);
  for (const SampleLog::LoggedStream& stream : source.log_.streams)
    source.streams_.push_back(table.find(stream.name).value_or(0));  // 0: of no sample
  source.last_.resize(source.log_.sources.size() * source.log_.streams.size());
  return source;
}

bool RecordedSource::has_samples() const {
  return std::ranges::any_of(
      log_.entries, [](const SampleLog::Entry& entry) { return enters(entry.sample.kind()); });
}

Result<SourceId> RecordedSource::open(SampleInbox& inbox, SourceId logged) const {
  if (log_.sources[logged] == kSimulationName) return kSimulation;
  return inbox.open(log_.sources[logged], kAnyAge_ns);
}

// In the order of the log, so that the sources of a repeated run have their numbers again.
Status RecordedSource::open_all(SampleInbox& inbox) {
  for (SourceId i = 0; i < log_.sources.size(); ++i) {
    NERITIC_TRY(const SourceId id, open(inbox, i));
    sources_.push_back(id);
  }
  return {};
}

Status RecordedSource::push(SampleInbox& inbox, const SampleLog::Entry& entry) {
  const SampleHeader& logged = entry.sample.header;
  Last& last = last_[logged.source * log_.streams.size() + logged.stream];
  // A device that was restarted while it was recorded began to count anew. In a burst the inbox
  // replaced samples that it had accepted: they left a gap.
  if (last.any &&
      (logged.sequence <= last.sequence || logged.captured_ns < last.captured_ns ||
       logged.sequence - last.sequence > static_cast<std::uint64_t>(SequenceTrack::kMostMissing)))
    NERITIC_TRY_STATUS(open(inbox, logged.source));
  last = {true, logged.sequence, logged.captured_ns};

  Sample sample = entry.sample;
  sample.header.stream = streams_[logged.stream];
  sample.header.source = sources_[logged.source];
  if (Event* event = std::get_if<Event>(&sample.payload)) {
    // A number that the log does not name may be another device's here.
    if (event->source >= sources_.size())
      return bad_input("{}: {} at step {}: an event of source {} found; accepted: of the log's {}",
                       name_, log_.streams[logged.stream].name, entry.step, event->source,
                       sources_.size());
    event->source = sources_[event->source];
  }
  const SampleVerdict verdict = inbox.push(sample);
  if (verdict == SampleVerdict::kAccepted) return {};
  return bad_input("{}: {} at step {}: sample {} is {}; accepted: samples as an inbox takes them",
                   name_, log_.streams[logged.stream].name, entry.step, logged.sequence,
                   name_of(verdict));
}

Status RecordedSource::poll(SampleInbox& inbox, double scene_time_s) {
  if (sources_.empty()) NERITIC_TRY_STATUS(open_all(inbox));
  for (; !done(); ++next_) {
    const SampleLog::Entry& entry = log_.entries[next_];
    const auto step = static_cast<double>(start_step_ + entry.step);
    if (step * log_.step_s > scene_time_s + kRounding_s) break;
    if (enters(entry.sample.kind())) NERITIC_TRY_STATUS(push(inbox, entry));
  }
  return {};
}

}  // namespace neritic::testbed
