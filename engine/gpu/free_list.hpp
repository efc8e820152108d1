// The free ranges of one block of memory, sorted by offset, merged where they touch; first fit.
// Plain data without a GPU, so that tests can try to break it. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace neritic::gpu {

class FreeList {
 public:
  explicit FreeList(std::uint64_t size_bytes);

  // The offset of a free range of that size at a multiple of alignment (a power of two); nothing
  // where none fits. size_bytes > 0.
  std::optional<std::uint64_t> allocate(std::uint64_t size_bytes, std::uint64_t alignment);
  // Gives back exactly what allocate gave. Giving back what is free already is a bug and stops.
  void release(std::uint64_t offset, std::uint64_t size_bytes);

  bool all_free() const { return free_bytes_ == size_bytes_; }
  std::uint64_t free_bytes() const { return free_bytes_; }
  std::uint64_t size_bytes() const { return size_bytes_; }
  std::size_t range_count() const { return ranges_.size(); }

 private:
  struct Range {
    std::uint64_t begin, end;
  };
  std::uint64_t size_bytes_, free_bytes_;
  std::vector<Range> ranges_;
};

}  // namespace neritic::gpu
