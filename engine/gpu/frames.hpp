// Frames in flight: command buffers, per-frame descriptors, upload space, timers and deferred
// destruction, paced by one timeline semaphore. Owned by the rendering thread.
#pragma once

#include <volk.h>

#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/gpu/resources.hpp"

namespace neritic::gpu {

class Device;
class Frames;

// Where per-frame data was put, for binding.
struct UploadSlice {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0, size = 0;
};

// One frame's recording. Valid between Frames::begin and Frames::submit.
class Commands {
 public:
  VkCommandBuffer handle() const { return handle_; }

  void bind_pipeline(const Pipeline& pipeline);
  // Binds set 0: a fresh descriptor set with these resources (every declared binding must be
  // given).
  void bind(const Pipeline& pipeline, std::span<const BoundResource> resources);
  void bind(const Pipeline& pipeline, std::initializer_list<BoundResource> resources) {
    bind(pipeline, std::span(resources.begin(), resources.size()));
  }
  template <class T>
  void push(const Pipeline& pipeline, const T& constants) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 128);
    push_bytes(pipeline, &constants, sizeof(T));
  }
  void push_bytes(const Pipeline& pipeline, const void* data, std::uint32_t size);
  void dispatch(std::uint32_t x, std::uint32_t y = 1, std::uint32_t z = 1);
  // Between two dispatches of one pass: the second reads and writes what the first wrote. (Between
  // passes the frame graph does that.)
  void wait_for_dispatch();

  // Copies bytes into this frame's upload buffer (aligned for storage and uniform use); it stays
  // valid until the GPU is done with the frame.
  UploadSlice upload(const void* data, VkDeviceSize size);
  template <class T>
  UploadSlice upload(std::span<const T> values) {
    return upload(values.data(), values.size_bytes());
  }

  // A named region for debuggers, with GPU timestamps around it when timing is on. Regions may
  // nest; they begin and end outside vkCmdBeginRendering. The first 256 of a frame are timed.
  void begin_region(const std::string& name);
  void end_region();

 private:
  friend class Frames;
  Frames* frames_ = nullptr;
  VkCommandBuffer handle_ = VK_NULL_HANDLE;
};

struct PassTime {
  std::string name;
  double ms = 0.0;
};

class Frames {
 public:
  // in_flight: how many frames the host may be ahead by (1 to 4).
  static Result<std::unique_ptr<Frames>> create(Device& device, std::uint32_t in_flight = 2);
  virtual ~Frames() = default;

  // Waits for the oldest frame in flight, runs what was retired with it, starts recording.
  virtual Result<Commands*> begin() = 0;
  struct SubmitSync {
    VkSemaphore wait = VK_NULL_HANDLE;  // binary, at wait_stage
    VkPipelineStageFlags2 wait_stage = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSemaphore signal = VK_NULL_HANDLE;
    std::uint64_t signal_value = 0;  // of a timeline semaphore; a binary one has none
  };
  // Ends recording and submits; returns the timeline value that says it is done.
  virtual Result<std::uint64_t> submit(const SubmitSync& sync) = 0;
  Result<std::uint64_t> submit() { return submit(SubmitSync{}); }
  // The number of the recording that begin() started last; no two have the same.
  virtual std::uint64_t recording() const = 0;
  // False where that recording was dropped: begin() came again before a submit that succeeded.
  virtual bool was_submitted(std::uint64_t recording) const = 0;
  // Waits until that frame is done (kDeviceLost after 60 s).
  virtual Status wait(std::uint64_t value) = 0;
  // The newest frame that is done; 0 before the first. Does not wait. Any thread.
  virtual Result<std::uint64_t> completed() const = 0;
  // Runs destroy when the frame being recorded (or the last submitted) is done on the GPU.
  virtual void retire(std::function<void()> destroy) = 0;
  // Times of the regions of the newest finished frame, in order; empty before the first, or where
  // the queue has no timestamps. Includes host_ms of recording as "record".
  virtual const std::vector<PassTime>& pass_times() const = 0;
  // The same of one frame, after it was waited for and until another frame in its slot is done;
  // else empty.
  virtual std::vector<PassTime> pass_times_of(std::uint64_t value) const = 0;
  virtual void enable_timing(bool on) = 0;
  virtual Device& device() = 0;

 protected:
  friend class Commands;
  virtual VkDescriptorSet frame_set(const Pipeline& pipeline) = 0;
  virtual UploadSlice frame_upload(const void* data, VkDeviceSize size) = 0;
  virtual void timestamp(const std::string* name) = 0;  // nullptr: end of region
  static void attach(Commands& commands, Frames* frames, VkCommandBuffer handle) {
    commands.frames_ = frames;
    commands.handle_ = handle;
  }
};

// A barrier after which everything waits for everything before, and sees what it wrote.
void record_full_barrier(VkCommandBuffer commands);

// Records with record, submits, waits: for uploads and one-off work outside a frame. Ordered by
// full barriers against all that was submitted before and will be submitted later.
Status run_once(Device& device, const std::function<void(VkCommandBuffer)>& record);

// Fills a device buffer / image (all mips given or generated by blits) through staging; the image
// ends in SHADER_READ_ONLY_OPTIMAL. Blocks until done.
Status upload_buffer(Device& device, const Buffer& target, std::span<const std::byte> bytes,
                     VkDeviceSize offset = 0);
Status upload_image(Device& device, const Image& target, std::span<const std::byte> texels_mip0);

// A whole layer of one mip of an image to the host, row by row without padding. The image must be
// in layout, and is left in it.
Result<std::vector<std::byte>> read_image(Device& device, const Image& image, VkImageLayout layout,
                                          std::uint32_t layer = 0, std::uint32_t mip = 0);

}  // namespace neritic::gpu
