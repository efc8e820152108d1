// The log of a run as text.
#pragma once

#include "testbed/record/csv_log.hpp"

namespace neritic::testbed {

inline std::string csv_of(const PhysicsWorld& world, const DiveRows& rows) {
  const DiveCsv csv(world);
  return csv.heading() + csv.lines(rows);
}

// Appends the log's lines to a text that outlives it.
class CsvText final : public RowSink {
 public:
  CsvText(const PhysicsWorld& world, std::string& text) : csv_(world), text_(text) {
    text_ = csv_.heading();
  }
  Status accept(const DiveRows& rows) override {
    text_ += csv_.lines(rows);
    return {};
  }
  Status finish() override { return {}; }

 private:
  DiveCsv csv_;
  std::string& text_;
};

}  // namespace neritic::testbed
