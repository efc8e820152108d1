// The machine's available memory. Any thread.
#pragma once

#include <cstdint>

namespace neritic {

// MemAvailable of /proc/meminfo (proc(5)), in bytes; 0 where there is none.
std::uint64_t available_memory_bytes();

}  // namespace neritic
