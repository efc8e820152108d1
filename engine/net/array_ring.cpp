#include "engine/net/array_ring.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <random>

namespace neritic::net {
namespace {

constexpr char kMagic[] = "NRTCRNG1";
constexpr std::size_t kToken = 8, kCapacityAt = 16, kClaimed = 24, kAlign = 64;

std::atomic_ref<std::uint64_t> claimed(std::byte* map) {
  return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(map + kClaimed));
}

std::uint64_t number_at(const std::byte* map, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, map + at, sizeof value);
  return value;
}

}  // namespace

Result<std::unique_ptr<ArrayRing>> ArrayRing::create(std::size_t capacity) {
  std::unique_ptr<ArrayRing> ring(new ArrayRing);
  ring->memory_ = Descriptor(memfd_create("neritic arrays", MFD_CLOEXEC));
  const std::size_t size = kHeader + capacity;
  if (!ring->memory_.open() || ftruncate(ring->memory_.get(), static_cast<off_t>(size)) != 0)
    return failure(ErrorCode::kUnsupported, "shared memory of {} bytes: {}", size,
                   std::strerror(errno));
  void* const map = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, ring->memory_.get(), 0);
  if (map == MAP_FAILED)
    return failure(ErrorCode::kUnsupported, "shared memory of {} bytes: {}", size,
                   std::strerror(errno));
  ring->map_ = static_cast<std::byte*>(map);
  ring->capacity_ = capacity;
  std::random_device random;
  ring->token_ = static_cast<std::uint64_t>(random()) << 32 | random();
  const std::uint64_t facts[] = {ring->token_, capacity, 0};
  std::memcpy(ring->map_, kMagic, 8);
  std::memcpy(ring->map_ + kToken, facts, sizeof facts);
  ring->path_ = fmt::format("/proc/{}/fd/{}", getpid(), ring->memory_.get());
  return ring;
}

ArrayRing::~ArrayRing() {
  if (map_) munmap(map_, kHeader + capacity_);
}

std::optional<std::uint64_t> ArrayRing::put(Bytes bytes) {
  if (bytes.size() > capacity_ / 4) return std::nullopt;
  std::uint64_t at = next_;
  if (at % capacity_ + bytes.size() > capacity_) at += capacity_ - at % capacity_;
  next_ = (at + bytes.size() + kAlign - 1) / kAlign * kAlign;
  // Claimed before the first byte changes: a reader that sees a new byte sees the claim.
  claimed(map_).store(next_, std::memory_order_seq_cst);
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (!bytes.empty()) std::memcpy(map_ + kHeader + at % capacity_, bytes.data(), bytes.size());
  return at;
}

Result<std::unique_ptr<ArrayRingReader>> ArrayRingReader::open(const std::string& path) {
  const auto refused = [&](const char* why) {
    return failure(ErrorCode::kUnsupported, "{}: {}", path, why);
  };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.open()) return refused(std::strerror(errno));
  struct stat facts {};
  if (fstat(file.get(), &facts) != 0 || !S_ISREG(facts.st_mode) ||
      static_cast<std::size_t>(facts.st_size) <= ArrayRing::kHeader)
    return refused("no memory of arrays");
  const auto size = static_cast<std::size_t>(facts.st_size);
  void* const map = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (map == MAP_FAILED) return refused(std::strerror(errno));
  std::unique_ptr<ArrayRingReader> reader(new ArrayRingReader);
  reader->map_ = static_cast<const std::byte*>(map);
  reader->capacity_ = size - ArrayRing::kHeader;
  if (std::memcmp(reader->map_, kMagic, 8) != 0 ||
      number_at(reader->map_, kCapacityAt) != reader->capacity_)
    return refused("no memory of arrays");
  return reader;
}

ArrayRingReader::~ArrayRingReader() {
  if (map_) munmap(const_cast<std::byte*>(map_), ArrayRing::kHeader + capacity_);
}

std::uint64_t ArrayRingReader::token() const {
  return number_at(map_, kToken);
}

bool ArrayRingReader::read(std::uint64_t position, std::span<std::byte> to) const {
  const std::size_t at = position % capacity_;
  if (at + to.size() > capacity_) return false;
  if (!to.empty()) std::memcpy(to.data(), map_ + ArrayRing::kHeader + at, to.size());
  std::atomic_thread_fence(std::memory_order_seq_cst);
  const std::uint64_t now = claimed(const_cast<std::byte*>(map_)).load();
  return position + to.size() <= now && now - position <= capacity_;
}

}  // namespace neritic::net
