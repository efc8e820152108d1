#include "testbed/record/step_sink.hpp"

#include <set>

namespace neritic::testbed {
namespace {

std::vector<StreamId> streams_of(const std::vector<StepSink*>& sinks) {
  std::set<StreamId> wanted;
  for (const StepSink* sink : sinks)
    for (const StreamId stream : sink->streams()) wanted.insert(stream);
  return {wanted.begin(), wanted.end()};
}

}  // namespace

StepSinks::StepSinks(const PhysicsWorld& world, std::vector<StepSink*> sinks)
    : sinks_(std::move(sinks)), outputs_(world, streams_of(sinks_)) {}

template <class Give>
void StepSinks::give(Give&& give) {
  for (StepSink* sink : sinks_) {
    if (failed_) return;
    status_ = give(*sink);
    failed_ = !status_.ok();
  }
}

void StepSinks::use(const Sample& sample) {
  give([&](StepSink& sink) { return sink.use(sample); });
}

void StepSinks::accept(const sim::Snapshot<PhysicsState>& step) {
  const std::span<const Sample> outputs = outputs_.of(step);
  give([&](StepSink& sink) { return sink.accept(step, outputs); });
}

Status StepSinks::finish() {
  Status first = status_;
  for (StepSink* sink : sinks_) {
    const Status finished = sink->finish();
    if (first.ok()) first = finished;
  }
  return first;
}

}  // namespace neritic::testbed
