// Arrays for programs of the same user on the same machine: memory that they map and read, without
// a copy through a socket. The writer goes round and waits for nobody; a reader that was too slow
// finds out and counts its array as lost. The memory goes with its last user, also if that is
// killed.
//
//   0 "NRTCRNG1"   8 u64 token   16 u64 capacity   24 u64 claimed   from 4096 on: the arrays
//
// Positions never fall. The array at position p begins at byte 4096 + p % capacity and lies there
// in one piece, alone on its pages of 4096 bytes; what was read from it is good if
// claimed - p <= capacity holds after reading. A reader that wants to use an array in its place
// locks these bytes for reading (F_OFD_SETLK) before it compares: the writer passes over locked
// bytes, and the system unlocks those of a reader that ends. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/net/socket.hpp"

namespace neritic::net {

class ArrayRing {
 public:
  static constexpr std::size_t kPage = 4096, kHeader = kPage, kCapacity = std::size_t{64} << 20;

  // capacity: a multiple of kPage. kUnsupported where the system gives no such memory.
  static Result<std::unique_ptr<ArrayRing>> create(std::size_t capacity = kCapacity);
  ~ArrayRing();

  // The file that a reader opens. It shows that it could by the token.
  const std::string& path() const { return path_; }
  std::uint64_t token() const { return token_; }
  // Its position. Nothing: more than a quarter of the capacity, or readers hold what it would need.
  std::optional<std::uint64_t> put(Bytes bytes);

 private:
  ArrayRing() = default;
  // The first position from next_ on, and before next_ + capacity_, with that many bytes in one
  // piece that no reader holds. The writer's lock is then on them.
  std::optional<std::uint64_t> lock_free_bytes(std::size_t size);

  Descriptor memory_;
  std::byte* map_ = nullptr;
  std::size_t capacity_ = 0;
  std::uint64_t token_ = 0, next_ = 0;
  std::string path_;
};

// The reading end. What is written into its memory stays there: neither the writer nor another
// reader sees it.
class ArrayRingReader {
 public:
  // kUnsupported where it does not open: another machine, another user.
  static Result<std::unique_ptr<ArrayRingReader>> open(const std::string& path);
  ~ArrayRingReader();

  std::uint64_t token() const;
  // Touches each page, which costs microseconds the first time, so that no array has to.
  void prepare() const;
  // A copy. False: overwritten meanwhile, or no place of an array.
  bool read(std::uint64_t position, std::span<std::byte> to) const;

  // An array in its place, which the writer leaves alone until it is given back.
  struct Loan {
    std::span<std::byte> bytes;
    int forks = 0;
  };
  // Nothing: as with read(), or a quarter of the capacity is lent (a copy may be had).
  std::optional<Loan> lend(std::uint64_t position, std::size_t size);
  // Once. Forgets what was written into it.
  void give_back(const Loan& loan);
  // Before the process forks: what is lent stays so, since the other process has it, too.
  void forking() { ++forks_; }

 private:
  ArrayRingReader() = default;
  bool whole(std::uint64_t position, std::size_t size) const;
  Descriptor file_;  // has the locks
  std::byte* map_ = nullptr;
  std::size_t capacity_ = 0, lent_ = 0;
  int forks_ = 0;
};

}  // namespace neritic::net
