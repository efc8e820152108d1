// Inside engine/gpu only: the pipelines that a device has made, by their descriptions. Worlds and
// sessions that follow one another, and sensors that are alike, need the same pipelines; a driver
// takes 10 to 300 ms to make one. One is made at a time; then at most kUnusedKept that nobody uses
// remain, those that were asked for last. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/pipeline.hpp"

namespace neritic::gpu {

class PipelineShelf {
 public:
  static constexpr std::size_t kUnusedKept = 128;
  using Made = std::shared_ptr<const MadePipeline>;

  // The pipeline of the key, made by `make` if there is none. An error leaves the shelf as it was.
  Result<Made> get(const std::string& key, const std::function<Result<Made>()>& make);
  // How many it has made so far, one that was dropped and made again twice; how long that took.
  struct Work {
    std::uint64_t made = 0;
    TimeNs took_ns = 0;
  };
  Work work() const;

 private:
  void drop_unused();
  struct Entry {
    Made made;
    std::uint64_t asked = 0;  // the request that asked for it last
  };
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  std::uint64_t requests_ = 0;
  Work work_;
};

// Everything of a description by which two pipelines can differ. Code counts by its hash.
std::string pipeline_key(const ComputePipelineDesc& desc);
std::string pipeline_key(const GraphicsPipelineDesc& desc);

}  // namespace neritic::gpu
