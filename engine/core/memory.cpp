#include "engine/core/memory.hpp"

#include <malloc.h>

#include <array>
#include <cstdio>

namespace neritic {

std::uint64_t available_memory_bytes() {
  std::FILE* file = std::fopen("/proc/meminfo", "r");
  if (!file) return 0;
  std::array<char, 256> line{};
  unsigned long long kib = 0;
  while (std::fgets(line.data(), line.size(), file))
    if (std::sscanf(line.data(), "MemAvailable: %llu kB", &kib) == 1) break;
  std::fclose(file);
  return std::uint64_t{kib} * 1024;
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);  // the most that it takes
  mallopt(M_TRIM_THRESHOLD, 512 * kMiB);
  mallopt(M_TOP_PAD, 4 * kMiB);
#endif
}

}  // namespace neritic
