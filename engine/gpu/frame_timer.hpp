// Inside engine/gpu only: the timestamps of one frame in flight and what they say. Rendering
// thread.
//
// Both ends of a region are written when all work before them is complete (ALL_COMMANDS), so that
// regions follow one another without overlap. Regions begin and end outside vkCmdBeginRendering.
// frame_timer.cpp says what lavapipe's values mean.
#pragma once

#include <volk.h>

#include <string>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/frames.hpp"

namespace neritic::gpu {

// Between two timestamps of that many valid bits (mask), which may wrap. An end before its begin,
// as threads of a software device write now and then, is no time.
std::uint64_t elapsed_ticks(std::uint64_t begin, std::uint64_t end, std::uint64_t mask);

class FrameTimer {
 public:
  // Regions beyond this many in a frame are not timed.
  static constexpr std::uint32_t kMaxRegions = 256;

  explicit FrameTimer(const Device& device);
  FrameTimer(FrameTimer&& other) noexcept;
  FrameTimer& operator=(FrameTimer&&) = delete;
  ~FrameTimer();
  Status create();

  // Starts a frame's recording; with on == false nothing is timed.
  void start(bool on);
  void begin_region(VkCommandBuffer commands, const std::string& name);
  void end_region(VkCommandBuffer commands);
  void stop();  // recording is over
  // After the GPU is done: the times, in the order in which the regions began. Once a frame.
  bool collect(std::vector<PassTime>& times);

 private:
  void write(VkCommandBuffer commands, std::uint32_t query);
  const Device* device_;
  bool late_;  // Quirks::late_timestamps
  VkQueryPool pool_ = VK_NULL_HANDLE;
  bool on_ = false, pending_ = false;
  TimeNs record_start_ns_ = 0, record_ns_ = 0;
  std::vector<std::string> names_;
  std::vector<std::uint32_t>
      open_;  // regions that have begun and not ended; kMaxRegions: not timed
};

}  // namespace neritic::gpu
