// The log of a dive as a .csv that grows while the run goes on.
#pragma once

#include "testbed/record/dive_csv.hpp"
#include "testbed/record/queued_file.hpp"

namespace neritic::testbed {

// Takes the rows of a run on the stepping thread.
class RowSink {
 public:
  virtual ~RowSink() = default;
  // The rows of a step; not called where there are none, nor after an Error. The run goes on.
  virtual Status accept(const DiveRows& rows) = 0;
  // After the last step, on the owner's thread. Also after an Error of accept.
  virtual Status finish() = 0;
};

class CsvLog final : public RowSink {
 public:
  // Borrows the world.
  CsvLog(const PhysicsWorld& world, std::filesystem::path path)
      : csv_(world), file_(std::move(path), csv_.heading(), [this](const DiveRows& rows) {
          return csv_.lines(rows);
        }) {}
  Status accept(const DiveRows& rows) override { return file_.add(rows); }
  Status finish() override { return file_.finish(); }

 private:
  DiveCsv csv_;
  QueuedFile<DiveRows> file_;  // last: its thread uses csv_
};

}  // namespace neritic::testbed
