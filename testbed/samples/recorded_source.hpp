// A recording as a source: it pushes each sample of a log before the step that used it, under the
// name of the device that sent it. With every sample of a run, polled before each step, the run
// repeats bit for bit. In another run a group listens to the recorded device as to a live one; the
// groups of other sources are as the scene says. One thread.
#pragma once

#include <vector>

#include "testbed/samples/sample_log.hpp"
#include "testbed/samples/source.hpp"

namespace neritic::testbed {

class RecordedSource final : public SampleSource {
 public:
  // name stands in messages. start_step: of this run, where the log begins. kBadInput as
  // check_streams.
  static Result<RecordedSource> create(SampleLog log, const StreamTable& table, std::string name,
                                       std::uint64_t start_step = 0);

  // Exact if polled before each step. kBadInput if the inbox refuses a sample of the log.
  Status poll(SampleInbox& inbox, double scene_time_s) override;
  // All samples are pushed.
  bool done() const { return next_ == log_.entries.size(); }
  // A sample of the log is pushed; else the scene runs as without it.
  bool has_samples() const;
  const SampleLog& log() const { return log_; }

 private:
  // The last sample of a source in a stream.
  struct Last {
    bool any = false;
    std::uint64_t sequence = 0;
    TimeNs captured_ns = 0;
  };
  RecordedSource(SampleLog log, std::string name, std::uint64_t start_step)
      : log_(std::move(log)), name_(std::move(name)), start_step_(start_step) {}
  Status open_all(SampleInbox& inbox);
  Status push(SampleInbox& inbox, const SampleLog::Entry& entry);
  Result<SourceId> open(SampleInbox& inbox, SourceId logged) const;

  SampleLog log_;
  std::string name_;
  std::uint64_t start_step_ = 0;
  std::vector<StreamId> streams_;  // of the scene, by the log's
  std::vector<SourceId> sources_;  // of the inbox, by the log's; empty before the first poll
  std::vector<Last> last_;         // by the log's source and stream
  std::size_t next_ = 0;           // entry
};

}  // namespace neritic::testbed
