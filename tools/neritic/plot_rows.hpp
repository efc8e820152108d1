// Rows of a dive, thinned as they come, so that the memory of a picture stays bounded. One thread.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "testbed/record/dive_record.hpp"

namespace neritic::tools {

// The rows of one participant: evenly thinned, from most / 2 to most of them, the last one
// included; and each row that differs from the one before it in its marks.
template <class Row>
class ThinnedRows {
 public:
  explicit ThinnedRows(std::size_t most) : most_(most) {}

  void add(const Row& row, std::size_t marks) {
    const bool stays = count_ == 0 || marks != marks_;
    marks_ = marks;
    if (stays || count_ % every_ == 0) kept_.push_back({count_, stays, row});
    if (!stays && count_ % every_ == 0 && ++even_ > most_) thin();
    ++count_;
    last_ = row;
  }
  std::vector<Row> rows() const {
    std::vector<Row> out;
    for (const Kept& kept : kept_) out.push_back(kept.row);
    if (count_ > 0 && kept_.back().index + 1 != count_) out.push_back(*last_);
    return out;
  }

 private:
  struct Kept {
    std::size_t index;
    bool stays;
    Row row;
  };
  void thin() {
    every_ *= 2;
    std::erase_if(kept_, [&](const Kept& kept) { return !kept.stays && kept.index % every_ != 0; });
    even_ = static_cast<std::size_t>(
        std::ranges::count_if(kept_, [](const Kept& kept) { return !kept.stays; }));
  }

  std::size_t most_, every_ = 1, even_ = 0, count_ = 0, marks_ = 0;
  std::vector<Kept> kept_;
  std::optional<Row> last_;
};

// The rows of all participants. Rows in which a danger, the tank or the waypoint changes stay.
class PlotRows {
 public:
  explicit PlotRows(const testbed::PhysicsWorld& world);
  void add(const testbed::DiveRows& rows);
  std::vector<testbed::DiveRow> vehicle(std::size_t i) const { return vehicles_[i].rows(); }
  std::vector<testbed::HumanRow> human(std::size_t i) const { return humans_[i].rows(); }

 private:
  std::vector<ThinnedRows<testbed::DiveRow>> vehicles_;
  std::vector<ThinnedRows<testbed::HumanRow>> humans_;
};

// Dangers of that row as bits: 1 and 2 the ascent alarm, 4 the ceiling, 8 a risk is high, 16 that
// of oxygen, 32 out of gas.
std::size_t danger_bits(const testbed::HumanRow& row);

}  // namespace neritic::tools
