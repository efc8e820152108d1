#include "engine/net/array_ring.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <random>

namespace neritic::net {
namespace {

constexpr char kMagic[] = "NRTCRNG1";
constexpr std::size_t kToken = 8, kCapacityAt = 16, kClaimed = 24;
// Held places that one array passes over at most.
constexpr int kMostPassed = 64;

std::atomic_ref<std::uint64_t> claimed(std::byte* map) {
  return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(map + kClaimed));
}

std::uint64_t number_at(const std::byte* map, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, map + at, sizeof value);
  return value;
}

// A whole number of pages, one at least.
std::size_t whole_pages(std::size_t size) {
  return (std::max<std::size_t>(size, 1) + ArrayRing::kPage - 1) / ArrayRing::kPage *
         ArrayRing::kPage;
}

struct flock range(short type, std::size_t at, std::size_t size) {
  return {.l_type = type,
          .l_whence = SEEK_SET,
          .l_start = static_cast<off_t>(ArrayRing::kHeader + at),
          .l_len = static_cast<off_t>(size),
          .l_pid = 0};
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

std::optional<std::uint64_t> ArrayRing::lock_free_bytes(std::size_t size) {
  std::uint64_t at = next_;
  for (int passed = 0; passed < kMostPassed; ++passed) {
    if (at % capacity_ + size > capacity_) at += capacity_ - at % capacity_;
    if (at - next_ > capacity_ - size) return std::nullopt;
    struct flock wanted = range(F_WRLCK, at % capacity_, size);
    if (fcntl(memory_.get(), F_OFD_SETLK, &wanted) == 0) return at;
    if (fcntl(memory_.get(), F_OFD_GETLK, &wanted) != 0) return std::nullopt;
    if (wanted.l_type == F_UNLCK) continue;  // given back meanwhile
    const auto end = static_cast<std::uint64_t>(wanted.l_start + wanted.l_len) - kHeader;
    if (wanted.l_len == 0 || end > capacity_) return std::nullopt;  // all the rest
    at += whole_pages(end) - at % capacity_;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> ArrayRing::put(Bytes bytes) {
  if (bytes.size() > capacity_ / 4) return std::nullopt;
  const std::size_t size = whole_pages(bytes.size());
  const std::optional<std::uint64_t> at = lock_free_bytes(size);
  if (!at) return std::nullopt;
  next_ = *at + size;
  // Claimed before the first byte changes: a reader that sees a new byte sees the claim.
  claimed(map_).store(next_, std::memory_order_seq_cst);
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (!bytes.empty()) std::memcpy(map_ + kHeader + *at % capacity_, bytes.data(), bytes.size());
  struct flock done = range(F_UNLCK, *at % capacity_, size);
  (void)fcntl(memory_.get(), F_OFD_SETLK, &done);
  return at;
}

Result<std::unique_ptr<ArrayRingReader>> ArrayRingReader::open(const std::string& path) {
  const auto refused = [&](const char* why) {
    return failure(ErrorCode::kUnsupported, "{}: {}", path, why);
  };
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.open()) return refused(std::strerror(errno));
  struct stat facts {};
  if (fstat(file.get(), &facts) != 0 || !S_ISREG(facts.st_mode) ||
      static_cast<std::size_t>(facts.st_size) <= ArrayRing::kHeader)
    return refused("no memory of arrays");
  const auto size = static_cast<std::size_t>(facts.st_size);
  void* const map =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE, file.get(), 0);
  if (map == MAP_FAILED) return refused(std::strerror(errno));
  std::unique_ptr<ArrayRingReader> reader(new ArrayRingReader);
  reader->file_ = std::move(file);
  reader->map_ = static_cast<std::byte*>(map);
  reader->capacity_ = size - ArrayRing::kHeader;
  if (std::memcmp(reader->map_, kMagic, 8) != 0 ||
      number_at(reader->map_, kCapacityAt) != reader->capacity_)
    return refused("no memory of arrays");
  return reader;
}

ArrayRingReader::~ArrayRingReader() {
  if (map_) munmap(map_, ArrayRing::kHeader + capacity_);
}

std::uint64_t ArrayRingReader::token() const {
  return number_at(map_, kToken);
}

void ArrayRingReader::prepare() const {
  for (std::size_t at = 0; at < ArrayRing::kHeader + capacity_; at += ArrayRing::kPage)
    (void)*static_cast<const volatile std::byte*>(map_ + at);
}

bool ArrayRingReader::whole(std::uint64_t position, std::size_t size) const {
  std::atomic_thread_fence(std::memory_order_seq_cst);
  const std::uint64_t now = claimed(map_).load();
  return position + size <= now && now - position <= capacity_;
}

bool ArrayRingReader::read(std::uint64_t position, std::span<std::byte> to) const {
  const std::size_t at = position % capacity_;
  if (to.size() > capacity_ || at + to.size() > capacity_) return false;
  if (!to.empty()) std::memcpy(to.data(), map_ + ArrayRing::kHeader + at, to.size());
  return whole(position, to.size());
}

std::optional<ArrayRingReader::Loan> ArrayRingReader::lend(std::uint64_t position,
                                                           std::size_t size) {
  const std::size_t at = position % capacity_;
  if (at % ArrayRing::kPage != 0 || size == 0 || size > capacity_ / 4 - lent_ ||
      at + size > capacity_)
    return std::nullopt;
  struct flock wanted = range(F_RDLCK, at, size);
  if (fcntl(file_.get(), F_OFD_SETLK, &wanted) != 0) return std::nullopt;
  lent_ += size;
  const Loan loan{{map_ + ArrayRing::kHeader + at, size}, forks_};
  if (whole(position, size)) return loan;
  give_back(loan);
  return std::nullopt;
}

void ArrayRingReader::give_back(const Loan& loan) {
  if (loan.forks != forks_) return;
  lent_ -= loan.bytes.size();
  (void)madvise(loan.bytes.data(), loan.bytes.size(), MADV_DONTNEED);
  const auto at = static_cast<std::size_t>(loan.bytes.data() - map_) - ArrayRing::kHeader;
  struct flock done = range(F_UNLCK, at, loan.bytes.size());
  (void)fcntl(file_.get(), F_OFD_SETLK, &done);
}

}  // namespace neritic::net
