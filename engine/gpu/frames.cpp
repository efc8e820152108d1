#include "engine/gpu/frames.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <optional>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/frame_timer.hpp"
#include "engine/gpu/upload_arena.hpp"

namespace neritic::gpu {
namespace {

constexpr VkDeviceSize kSmallestUpload = 16;  // bytes: empty data can still be bound

// The objects that one frame in flight owns.
struct Slot {
  Slot(const Device& gpu, std::uint32_t index)
      : device(gpu.handle()),
        descriptors(gpu, fmt::format("frame slot {}", index)),
        uploads(gpu, fmt::format("uploads of frame slot {}", index)),
        timer(gpu) {}
  Slot(Slot&& other) noexcept
      : device(other.device),
        pool(std::exchange(other.pool, VK_NULL_HANDLE)),
        commands(other.commands),
        descriptors(std::move(other.descriptors)),
        uploads(std::move(other.uploads)),
        timer(std::move(other.timer)),
        value(other.value),
        times(std::move(other.times)),
        times_value(other.times_value) {}
  Slot& operator=(Slot&&) = delete;
  ~Slot() {
    if (pool != VK_NULL_HANDLE) vkDestroyCommandPool(device, pool, nullptr);
  }

  VkDevice device;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  DescriptorArena descriptors;
  UploadArena uploads;
  FrameTimer timer;
  std::uint64_t value = 0;      // the timeline value of its last submission
  std::vector<PassTime> times;  // of frame times_value
  std::uint64_t times_value = 0;
};

Status create_slot(const Device& device, std::uint32_t index, Slot& slot) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = device.queue_family();
  NERITIC_TRY_VK("vkCreateCommandPool",
                 vkCreateCommandPool(device.handle(), &pool, nullptr, &slot.pool));
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = slot.pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  NERITIC_TRY_VK("vkAllocateCommandBuffers",
                 vkAllocateCommandBuffers(device.handle(), &info, &slot.commands));
  device.name_object(VK_OBJECT_TYPE_COMMAND_POOL, slot.pool, fmt::format("frame slot {}", index));
  device.name_object(VK_OBJECT_TYPE_COMMAND_BUFFER, slot.commands,
                     fmt::format("frame slot {}", index));
  return slot.timer.create();
}

class FramesImpl final : public Frames {
 public:
  explicit FramesImpl(Device& device) : device_(device) {}
  ~FramesImpl() override;
  Status create(std::uint32_t in_flight);

  Result<Commands*> begin() override;
  Result<std::uint64_t> submit(const SubmitSync& sync) override;
  std::uint64_t recording() const override { return recording_number_; }
  bool was_submitted(std::uint64_t recording) const override {
    if (recording == recording_number_) return !open_;
    return !std::binary_search(dropped_.begin(), dropped_.end(), recording);
  }
  Status wait(std::uint64_t value) override;
  void retire(std::function<void()> destroy) override;
  Result<std::uint64_t> completed() const override;
  const std::vector<PassTime>& pass_times() const override;
  std::vector<PassTime> pass_times_of(std::uint64_t value) const override;
  void enable_timing(bool on) override { timing_ = on; }
  Device& device() override { return device_; }

 protected:
  VkDescriptorSet frame_set(const Pipeline& pipeline) override;
  UploadSlice frame_upload(const void* data, VkDeviceSize size) override;
  void timestamp(const std::string* name) override;

 private:
  struct Retired {
    std::uint64_t value;
    std::function<void()> destroy;
  };
  Slot& slot() {
    NERITIC_CHECK(recording_, "commands are recorded between begin and submit only");
    return slots_[next_value_ % slots_.size()];
  }
  // Runs what was retired up to value, takes the newest times.
  void finished(std::uint64_t value);
  void fail(const Error& error) {
    if (!frame_error_) frame_error_ = error;
  }

  Device& device_;
  VkSemaphore timeline_ = VK_NULL_HANDLE;
  std::vector<Slot> slots_;
  Buffer spare_;  // what a failed upload is said to lie in; its frame is never submitted
  std::uint64_t next_value_ = 1;  // of the frame being recorded, or the next one
  bool recording_ = false, timing_ = true;
  std::uint64_t recording_number_ = 0;  // counts begin()
  bool open_ = false;                   // begun, and not submitted with success
  std::vector<std::uint64_t> dropped_;  // recordings, rising; only failures add to it
  std::optional<Error> frame_error_;    // of the frame being recorded; submit returns it
  std::deque<Retired> retired_;         // in the order of their values
  Commands commands_;
};

Status FramesImpl::create(std::uint32_t in_flight) {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
  NERITIC_TRY_VK("vkCreateSemaphore (timeline)",
                 vkCreateSemaphore(device_.handle(), &info, nullptr, &timeline_));
  device_.name_object(VK_OBJECT_TYPE_SEMAPHORE, timeline_, "frames timeline");
  BufferDesc spare;
  spare.name = "stand-in for failed uploads";
  spare.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  NERITIC_TRY(spare_, Buffer::create(device_, spare));
  slots_.reserve(in_flight);
  for (std::uint32_t i = 0; i < in_flight; ++i) {
    slots_.emplace_back(device_, i);
    NERITIC_TRY_STATUS(create_slot(device_, i, slots_.back()));
  }
  return {};
}

FramesImpl::~FramesImpl() {
  device_.wait_idle();
  while (!retired_.empty()) {
    const auto destroy = std::move(retired_.front().destroy);
    retired_.pop_front();
    destroy();
  }
  if (timeline_ != VK_NULL_HANDLE) vkDestroySemaphore(device_.handle(), timeline_, nullptr);
}

Result<Commands*> FramesImpl::begin() {
  // A frame that was begun and never submitted (its recording failed) is dropped and begun anew.
  if (open_) dropped_.push_back(recording_number_);
  open_ = false;
  recording_ = false;
  frame_error_.reset();
  Slot& next = slots_[next_value_ % slots_.size()];
  NERITIC_TRY_STATUS(wait(next.value));
  NERITIC_TRY_VK("vkResetCommandPool", vkResetCommandPool(device_.handle(), next.pool, 0));
  next.descriptors.reset();
  NERITIC_TRY_STATUS(next.uploads.reset());
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  NERITIC_TRY_VK("vkBeginCommandBuffer", vkBeginCommandBuffer(next.commands, &info));
  next.timer.start(timing_);
  recording_ = open_ = true;
  ++recording_number_;
  attach(commands_, this, next.commands);
  return &commands_;
}

Result<std::uint64_t> FramesImpl::submit(const SubmitSync& sync) {
  Slot& current = slot();
  recording_ = false;
  if (frame_error_) return *frame_error_;
  current.timer.stop();
  NERITIC_TRY_VK("vkEndCommandBuffer", vkEndCommandBuffer(current.commands));
  VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  commands.commandBuffer = current.commands;
  VkSemaphoreSubmitInfo wait_info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  wait_info.semaphore = sync.wait;
  wait_info.stageMask = sync.wait_stage;
  std::array<VkSemaphoreSubmitInfo, 2> signals{};
  for (VkSemaphoreSubmitInfo& signal : signals) {
    signal.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  }
  signals[0].semaphore = timeline_;
  signals[0].value = next_value_;
  signals[1].semaphore = sync.signal;
  signals[1].value = sync.signal_value;
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.waitSemaphoreInfoCount = sync.wait != VK_NULL_HANDLE ? 1 : 0;
  info.pWaitSemaphoreInfos = &wait_info;
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = sync.signal != VK_NULL_HANDLE ? 2 : 1;
  info.pSignalSemaphoreInfos = signals.data();
  NERITIC_TRY_VK("vkQueueSubmit2", vkQueueSubmit2(device_.queue(), 1, &info, VK_NULL_HANDLE));
  current.value = next_value_;
  open_ = false;
  return next_value_++;
}

Status FramesImpl::wait(std::uint64_t value) {
  NERITIC_CHECK(value < next_value_, "frame {} was not submitted yet", value);
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline_;
  info.pValues = &value;
  const VkResult result = vkWaitSemaphores(device_.handle(), &info, device_.wait_limit_ns());
  if (result == VK_TIMEOUT)
    return failure(ErrorCode::kDeviceLost, "the device did not finish a frame in {} s",
                   static_cast<double>(device_.wait_limit_ns()) * 1e-9);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkWaitSemaphores");
  finished(value);
  return {};
}

void FramesImpl::finished(std::uint64_t value) {
  while (!retired_.empty() && retired_.front().value <= value) {
    const auto destroy = std::move(retired_.front().destroy);
    retired_.pop_front();
    destroy();
  }
  for (Slot& done : slots_)
    if (done.value <= value && done.value > done.times_value && done.timer.collect(done.times))
      done.times_value = done.value;
}

Result<std::uint64_t> FramesImpl::completed() const {
  std::uint64_t value = 0;
  NERITIC_TRY_VK("vkGetSemaphoreCounterValue",
                 vkGetSemaphoreCounterValue(device_.handle(), timeline_, &value));
  return value;
}

const std::vector<PassTime>& FramesImpl::pass_times() const {
  return std::ranges::max_element(slots_, {}, &Slot::times_value)->times;
}

std::vector<PassTime> FramesImpl::pass_times_of(std::uint64_t value) const {
  for (const Slot& slot : slots_)
    if (slot.times_value == value) return slot.times;
  return {};
}

void FramesImpl::retire(std::function<void()> destroy) {
  retired_.push_back({recording_ ? next_value_ : next_value_ - 1, std::move(destroy)});
}

VkDescriptorSet FramesImpl::frame_set(const Pipeline& pipeline) {
  const auto set = slot().descriptors.allocate(pipeline.set0(), pipeline.name());
  if (set.ok()) return set.value();
  fail(set.error());
  return VK_NULL_HANDLE;
}

UploadSlice FramesImpl::frame_upload(const void* data, VkDeviceSize size) {
  const VkDeviceSize room = std::max(size, kSmallestUpload);
  const auto place = slot().uploads.allocate(room);
  if (!place.ok()) {
    fail(place.error());
    return {spare_.handle(), 0, spare_.size()};
  }
  if (size > 0) std::memcpy(place->mapped, data, size);
  if (size < room) std::memset(place->mapped + size, 0, room - size);
  return {place->buffer, place->offset, room};
}

void FramesImpl::timestamp(const std::string* name) {
  Slot& current = slot();
  if (name)
    current.timer.begin_region(current.commands, *name);
  else
    current.timer.end_region(current.commands);
}

}  // namespace

Result<std::unique_ptr<Frames>> Frames::create(Device& device, std::uint32_t in_flight) {
  NERITIC_CHECK(in_flight >= 1 && in_flight <= 4, "{} frames in flight", in_flight);
  auto frames = std::make_unique<FramesImpl>(device);
  NERITIC_TRY_STATUS(frames->create(in_flight));
  return std::unique_ptr<Frames>(std::move(frames));
}

}  // namespace neritic::gpu
