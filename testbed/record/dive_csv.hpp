// Rows as lines of a table: world axes, degrees, body axes forward, starboard, down. The table has
// the thrusters of the vehicle with most, and the sensors that any vehicle has; a cell is empty if
// the vehicle lacks that sensor or has no reading of it yet. Divers have columns of their own
// (LOG.md). Read only after construction: any thread.
#pragma once

#include <memory>
#include <string>

#include "testbed/record/dive_record.hpp"

namespace neritic::testbed {

class DiveCsv {
 public:
  // Borrows the world.
  explicit DiveCsv(const PhysicsWorld& world);
  ~DiveCsv();
  std::string heading() const;  // with its line end
  // In the order of time; of an instant, vehicles first.
  std::string lines(const DiveRows& rows) const;

 private:
  struct Columns;
  void append(std::string& out, const DiveRow& row) const;
  void append(std::string& out, const HumanRow& row) const;
  // Columns silent, in a scene that names live sources, and hash.
  void append_end(std::string& out, std::uint64_t silent, std::uint64_t hash) const;

  const PhysicsWorld& world_;
  std::unique_ptr<const Columns> columns_;
};

}  // namespace neritic::testbed
