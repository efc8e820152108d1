// Arrays for programs of the same user on the same machine: memory that they map and read, without
// a copy through a socket. The writer goes round and waits for nobody; a reader that was too slow
// finds out and counts its array as lost. The memory goes with its last user, also if that is
// killed.
//
//   0 "NRTCRNG1"   8 u64 token   16 u64 capacity   24 u64 claimed   from 4096 on: the arrays
//
// Positions never fall. The array at position p begins at byte 4096 + p % capacity and lies there
// in one piece; what was read from it is good if claimed - p <= capacity holds after reading. One
// thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/net/socket.hpp"

namespace neritic::net {

class ArrayRing {
 public:
  static constexpr std::size_t kHeader = 4096, kCapacity = std::size_t{64} << 20;

  // kUnsupported where the system gives no such memory.
  static Result<std::unique_ptr<ArrayRing>> create(std::size_t capacity = kCapacity);
  ~ArrayRing();

  // The file that a reader opens. It shows that it could by the token.
  const std::string& path() const { return path_; }
  std::uint64_t token() const { return token_; }
  // Its position. Nothing: more than a quarter of the capacity.
  std::optional<std::uint64_t> put(Bytes bytes);

 private:
  ArrayRing() = default;
  Descriptor memory_;
  std::byte* map_ = nullptr;
  std::size_t capacity_ = 0;
  std::uint64_t token_ = 0, next_ = 0;
  std::string path_;
};

// The reading end.
class ArrayRingReader {
 public:
  // kUnsupported where it does not open: another machine, another user.
  static Result<std::unique_ptr<ArrayRingReader>> open(const std::string& path);
  ~ArrayRingReader();

  std::uint64_t token() const;
  // False: overwritten meanwhile, or no place of an array.
  bool read(std::uint64_t position, std::span<std::byte> to) const;

 private:
  ArrayRingReader() = default;
  const std::byte* map_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace neritic::net
