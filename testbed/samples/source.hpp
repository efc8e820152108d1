// Something that sends samples into a running scene: the keyboard's pilot, a recording, a suit, a
// client. The loop polls each of its sources once before it advances the simulation. A
// source with a thread of its own may push into the inbox at any time and needs no poll.
#pragma once

#include "testbed/samples/inbox.hpp"

namespace neritic::testbed {

class SampleSource {
 public:
  virtual ~SampleSource() = default;
  // The thread of the loop, before each advance. Pushes the samples that arrived since the last
  // poll. scene_time_s: the simulated time from which the advance starts. An Error ends the run.
  virtual Status poll(SampleInbox& inbox, double scene_time_s) = 0;
};

}  // namespace neritic::testbed
