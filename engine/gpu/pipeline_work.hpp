// Counts the pipelines that a device's driver has made, and their time: they tell a program whether
// it waited for a compiler. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace neritic::gpu {

class Device;

struct PipelineWork {
  std::uint64_t made = 0;       // so far; a description that has a pipeline makes no other
  double seconds = 0.0;         // that their making took
  std::size_t cache_bytes = 0;  // of the driver's cache: grows with what it had to compile; 0: none
};
PipelineWork pipeline_work(const Device& device);

}  // namespace neritic::gpu
