#include "engine/core/memory.hpp"

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

}  // namespace neritic
