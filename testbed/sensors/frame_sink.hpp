// Takes the results of a run's frames: the files of `render`, a check, a test. The rendering thread
// calls all of it.
#pragma once

#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // Each frame of sensors in turn. An Error ends the run.
  virtual Status accept(const FrameResult& frame) = 0;
  // After the last frame of a run that did not fail; not where there was no frame.
  virtual Status finish() = 0;
};

}  // namespace neritic::testbed
