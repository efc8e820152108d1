// Where samples enter: any thread pushes, the stepping thread drains at a step boundary.
//
// The inbox takes `capacity` samples between two drains. After that it keeps the newest sample of
// each source and stream and counts those that it replaces, so that a burst costs old values, never
// the newest one, and a drain never returns more than twice the capacity. Samples that are lost,
// late, repeated, out of order, not finite or not plausible are counted by source; only accepted
// ones are drained.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "testbed/samples/sequence_track.hpp"
#include "testbed/samples/stream_table.hpp"

namespace neritic::testbed {

struct SourceCounts {
  std::uint64_t accepted = 0;
  std::uint64_t dropped = 0;  // accepted, then replaced by newer ones while the inbox was full
  std::uint64_t lost = 0;     // sequence numbers that never came
  std::uint64_t late = 0, repeated = 0, out_of_order = 0, not_finite = 0, not_plausible = 0;
  std::uint64_t not_of_stream = 0;

  std::uint64_t refused() const {
    return late + repeated + out_of_order + not_finite + not_plausible + not_of_stream;
  }
};

class SampleInbox {
 public:
  using Message = Sample;
  // Usual: a step uses 2048 samples at most, which takes it less than a millisecond.
  static constexpr std::size_t kCapacity = 1024;
  static constexpr std::size_t kMaxSources = 256;
  // A sample is refused as late if it arrived longer after its capture, unless open() says more.
  static constexpr TimeNs kMaxAge_ns = 500'000'000;
  // Clocks are mapped: a sample may seem to be captured a little after it arrived.
  static constexpr TimeNs kMaxAhead_ns = 20'000'000;

  // Borrows the table.
  SampleInbox(const StreamTable& streams, std::size_t capacity);

  // Any thread. The number under which a source sends. A known name gets its number again with its
  // sequences anew: a restart. An Error beyond kMaxSources and by engine/core/source_name.hpp.
  Result<SourceId> open(const std::string& name, TimeNs max_age_ns = kMaxAge_ns);

  // Any thread. Precondition: header.arrived_ns is now, on the clock of header.captured_ns.
  SampleVerdict push(const Sample& sample);

  // The stepping thread: accepted samples, oldest first, valid until the next drain. Waits for
  // nobody: while other threads hold the inbox for some 10 us it returns nothing, and the next
  // drain returns all.
  std::span<const Sample> drain();

  // Any thread.
  std::vector<std::string> source_names() const;  // by SourceId
  std::optional<SourceId> find(const std::string& name) const;
  // After a leap in time: any source's next samples may have any sequence numbers and capture
  // times.
  void begin_anew();
  SourceCounts counts(SourceId source) const;
  std::uint64_t unknown_sources() const;  // samples of sources that were never opened
  // Drains that returned nothing because others held the inbox.
  std::uint64_t postponed() const { return postponed_; }

 private:
  struct Track {
    SequenceTrack sequence;
    std::size_t slot = 0;  // of filling_, where it holds the newest of a full inbox; 0: none
  };
  struct Source {
    std::string name;
    TimeNs max_age_ns = kMaxAge_ns;
    SourceCounts counts;
    std::vector<Track> tracks;  // by stream
  };

  SampleVerdict check(const Sample& sample, SampleVerdict content, Source& source);
  void store(const Sample& sample);

  const StreamTable& streams_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<Source> sources_;
  std::vector<Sample> filling_;   // up to twice the capacity: then the newest of each track
  std::vector<Sample> draining_;  // the stepping thread's
  std::uint64_t unknown_sources_ = 0;
  std::atomic<std::uint64_t> postponed_{0};
};

}  // namespace neritic::testbed
