// Inside engine/graph: the images that keep their content from frame to frame, two a name: the one
// that the last frame wrote and the one that this frame may write. They lie in memory of their own.
// Move-only; rendering thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/graph/past.hpp"

namespace neritic::graph {

class Histories {
 public:
  // Makes the images of declarations that are new or changed, and records their clearing to zero.
  // recording: Frames::recording; run: counts the executor's runs. Appends images that the GPU may
  // still use, but no history needs, to retired.
  Status prepare(const gpu::Device& device, const std::vector<HistoryDecl>& declared,
                 std::uint64_t recording, std::uint64_t run, VkCommandBuffer cmd, Past& past,
                 std::vector<gpu::Image>& retired);
  const gpu::Image& last(const std::string& name) const;
  const gpu::Image& next(const std::string& name) const;
  // After a run: what it wrote is what the next run reads.
  void advance(const std::vector<HistoryDecl>& declared, const Plan& plan);
  // The recording was never submitted: all is as it was before it. Settles the past, since the
  // caller records a full barrier.
  void rewind(std::uint64_t recording, Past& past, std::vector<gpu::Image>& retired);
  // Drops what no run has declared since first_run.
  void drop_unused(std::uint64_t first_run, Past& past, std::vector<gpu::Image>& retired);
  void drop_all(std::vector<gpu::Image>& retired);
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Pair {
    std::string name;
    gpu::Image images[2];
    std::uint32_t last = 0;  // which of them the last frame wrote
    std::uint64_t last_run = 0, bytes = 0;
    // For rewind: the recording that used it last, and how it was before.
    std::uint64_t recording = 0, made_in = 0;
    std::uint32_t last_before = 0;
    Past::State states_before[2];
  };
  Pair* find(const std::string& name) const;
  Result<std::unique_ptr<Pair>> make(const gpu::Device& device, const HistoryDecl& declared) const;
  void drop(std::size_t index, Past& past, std::vector<gpu::Image>& retired);
  std::vector<std::unique_ptr<Pair>> pairs_;  // stable addresses
  std::uint64_t bytes_ = 0;
};

// The number of the object in Past.
std::uint64_t object_of(const gpu::Image& image);
std::uint64_t object_of(const gpu::Buffer& buffer);

}  // namespace neritic::graph
