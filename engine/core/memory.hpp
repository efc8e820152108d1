// The machine's available memory, and what this process keeps of it. Any thread.
#pragma once

#include <cstdint>

namespace neritic {

// MemAvailable of /proc/meminfo (proc(5)), in bytes; 0 where there is none.
std::uint64_t available_memory_bytes();

// For main() of a program, once: what is freed stays with the process, since the next frame or step
// wants as much again. A page that the kernel gives anew costs 0.3 us, on some virtual machines 12
// (3.7 MB of a picture: 11 ms). Sets glibc's malloc (mallopt(3)); elsewhere it does nothing.
void keep_freed_memory();

}  // namespace neritic
