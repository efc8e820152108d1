#include "engine/gpu/free_list.hpp"

#include <algorithm>
#include <bit>

#include "engine/core/check.hpp"

namespace neritic::gpu {

FreeList::FreeList(std::uint64_t size_bytes) : size_bytes_(size_bytes), free_bytes_(size_bytes) {
  if (size_bytes > 0) ranges_.push_back({0, size_bytes});
}

std::optional<std::uint64_t> FreeList::allocate(std::uint64_t size_bytes, std::uint64_t alignment) {
  NERITIC_CHECK(size_bytes > 0 && std::has_single_bit(alignment), "size {} alignment {}",
                size_bytes, alignment);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const Range range = ranges_[i];
    const std::uint64_t offset = (range.begin + alignment - 1) & ~(alignment - 1);
    if (offset < range.begin || offset > range.end || range.end - offset < size_bytes) continue;
    const Range before{range.begin, offset}, after{offset + size_bytes, range.end};
    const auto at = ranges_.begin() + static_cast<std::ptrdiff_t>(i);
    if (before.begin < before.end && after.begin < after.end) {
      *at = after;
      ranges_.insert(at, before);
    } else if (before.begin < before.end) {
      *at = before;
    } else if (after.begin < after.end) {
      *at = after;
    } else {
      ranges_.erase(at);
    }
    free_bytes_ -= size_bytes;
    return offset;
  }
  return std::nullopt;
}

void FreeList::release(std::uint64_t offset, std::uint64_t size_bytes) {
  const std::uint64_t end = offset + size_bytes;
  NERITIC_CHECK(size_bytes > 0 && end > offset && end <= size_bytes_, "offset {} size {} of {}",
                offset, size_bytes, size_bytes_);
  const auto next = std::lower_bound(ranges_.begin(), ranges_.end(), offset,
                                     [](const Range& r, std::uint64_t at) { return r.begin < at; });
  const bool has_previous = next != ranges_.begin();
  const auto previous = has_previous ? std::prev(next) : next;
  NERITIC_CHECK(next == ranges_.end() || next->begin >= end, "[{}, {}) is free already", offset,
                end);
  NERITIC_CHECK(!has_previous || previous->end <= offset, "[{}, {}) is free already", offset, end);
  const bool joins_previous = has_previous && previous->end == offset;
  const bool joins_next = next != ranges_.end() && next->begin == end;
  if (joins_previous && joins_next) {
    previous->end = next->end;
    ranges_.erase(next);
  } else if (joins_previous) {
    previous->end = end;
  } else if (joins_next) {
    next->begin = offset;
  } else {
    ranges_.insert(next, {offset, end});
  }
  free_bytes_ += size_bytes;
}

}  // namespace neritic::gpu
