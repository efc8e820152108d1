#include "engine/gpu/frame_timer.hpp"

#include <array>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"

namespace neritic::gpu {

// Quirks::late_timestamps: lavapipe (Mesa 22.3.6, 25.0.7) puts a timestamp into the bins of the
// next scene that it rasterizes, and runs dispatches at once: after the first rendering, a compute
// pass would begin after its own end and take no time. Any barrier makes it rasterize what is
// binned; an empty one orders nothing, so that synchronization validation judges the same frame.
// With it, a region's time on lavapipe is its wall time from the end of all work before it, for
// dispatches, draws and copies alike (measured: the regions add up to the frame).
FrameTimer::FrameTimer(const Device& device)
    : device_(&device), late_(device.info().quirks.late_timestamps) {}

FrameTimer::FrameTimer(FrameTimer&& other) noexcept
    : device_(other.device_),
      late_(other.late_),
      pool_(std::exchange(other.pool_, VK_NULL_HANDLE)) {}

FrameTimer::~FrameTimer() {
  if (pool_ != VK_NULL_HANDLE) vkDestroyQueryPool(device_->handle(), pool_, nullptr);
}

Status FrameTimer::create() {
  if (device_->timestamp_valid_bits() == 0) return {};
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kMaxRegions;
  NERITIC_TRY_VK("vkCreateQueryPool (timestamps)",
                 vkCreateQueryPool(device_->handle(), &info, nullptr, &pool_));
  device_->name_object(VK_OBJECT_TYPE_QUERY_POOL, pool_, "frame timestamps");
  return {};
}

void FrameTimer::start(bool on) {
  on_ = on && pool_ != VK_NULL_HANDLE;
  pending_ = false;
  names_.clear();
  open_.clear();
  record_start_ns_ = now_ns();
  if (on_) vkResetQueryPool(device_->handle(), pool_, 0, 2 * kMaxRegions);
}

void FrameTimer::begin_region(VkCommandBuffer commands, const std::string& name) {
  if (!on_) return;
  const auto region = static_cast<std::uint32_t>(names_.size());
  if (region >= kMaxRegions) {
    open_.push_back(kMaxRegions);
    return;
  }
  names_.push_back(name);
  open_.push_back(region);
  write(commands, 2 * region);
}

void FrameTimer::end_region(VkCommandBuffer commands) {
  if (!on_) return;
  NERITIC_CHECK(!open_.empty(), "a region ends that did not begin");
  const std::uint32_t region = open_.back();
  open_.pop_back();
  if (region == kMaxRegions) return;
  write(commands, 2 * region + 1);
}

void FrameTimer::write(VkCommandBuffer commands, std::uint32_t query) {
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
  if (!late_) return;
  const VkDependencyInfo nothing{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  vkCmdPipelineBarrier2(commands, &nothing);
}

void FrameTimer::stop() {
  NERITIC_CHECK(open_.empty(), "{} regions did not end", open_.size());
  record_ns_ = now_ns() - record_start_ns_;
  pending_ = on_;
}

std::uint64_t elapsed_ticks(std::uint64_t begin, std::uint64_t end, std::uint64_t mask) {
  const std::uint64_t elapsed = (end - begin) & mask;
  return elapsed > mask / 2 ? 0 : elapsed;
}

bool FrameTimer::collect(std::vector<PassTime>& times) {
  if (!std::exchange(pending_, false)) return false;
  std::array<std::uint64_t, 2 * kMaxRegions> ticks{};
  const auto count = static_cast<std::uint32_t>(2 * names_.size());
  if (count > 0 &&
      vkGetQueryPoolResults(device_->handle(), pool_, 0, count, sizeof ticks, ticks.data(),
                            sizeof ticks[0], VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
    return false;
  const std::uint32_t bits = device_->timestamp_valid_bits();
  const std::uint64_t mask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
  times.clear();
  times.push_back({"record", to_ms(record_ns_)});
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::uint64_t elapsed = elapsed_ticks(ticks[2 * i], ticks[2 * i + 1], mask);
    times.push_back(
        {names_[i], static_cast<double>(elapsed) * device_->timestamp_period_ns() * 1e-6});
  }
  return true;
}

}  // namespace neritic::gpu
