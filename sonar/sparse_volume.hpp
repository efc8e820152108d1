// The published algorithm's volume without its empty cells: a hash table from cell to the last
// value written there. One owner, one thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/random.hpp"

namespace neritic::sonar {

class SparseVolume {
 public:
  struct Entry {
    double value = 0.0;
    std::uint16_t label = 0;
  };

  SparseVolume() : slots_(kFirstSlots) {}

  // I(cell) = entry: whatever was there is overwritten.
  void set(std::uint64_t cell, const Entry& entry) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Slot& slot = find(slots_, cell);
    if (slot.cell == kFree) {
      slot.cell = cell;
      ++count_;
    }
    slot.entry = entry;
  }

  std::size_t size() const { return count_; }

  // Every cell that was written, by rising cell, so that sums have one order.
  std::vector<std::pair<std::uint64_t, Entry>> sorted() const {
    std::vector<std::pair<std::uint64_t, Entry>> out;
    out.reserve(count_);
    for (const Slot& slot : slots_)
      if (slot.cell != kFree) out.emplace_back(slot.cell, slot.entry);
    std::sort(out.begin(), out.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    return out;
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  static constexpr std::size_t kFirstSlots = 1024;  // a power of two, always
  struct Slot {
    std::uint64_t cell = kFree;
    Entry entry;
  };

  static Slot& find(std::vector<Slot>& slots, std::uint64_t cell) {
    const std::size_t mask = slots.size() - 1;
    std::size_t i = static_cast<std::size_t>(mix64(cell)) & mask;
    while (slots[i].cell != kFree && slots[i].cell != cell) i = (i + 1) & mask;
    return slots[i];
  }
  void grow() {
    std::vector<Slot> larger(slots_.size() * 2);
    for (const Slot& slot : slots_)
      if (slot.cell != kFree) find(larger, slot.cell) = slot;
    slots_.swap(larger);
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace neritic::sonar
