// The processor's time that Vulkan's functions take on the thread that calls them: a recording's
// commands, what they bind, submissions and what is kept for frames. It stands between the program
// and the functions that volk has loaded. One rendering thread.
#pragma once

#include <volk.h>

#include <ctime>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

class DriverTime {
 public:
  // The calling thread's processor time.
  static TimeNs thread_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return TimeNs{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
  }
  // Of the calls so far that were counted, without the clock's own.
  static double spent_ms() { return to_ms(spent_ns_ - calls_ * clock_ns_); }
  // While on: reading the clock takes as long as most of these functions do, and slows the frame.
  static void count(bool on) {
    if (on && clock_ns_ == 0) {
      constexpr TimeNs kReads = 1000;
      const TimeNs from = thread_ns();
      for (TimeNs i = 1; i < kReads; ++i) thread_ns();
      clock_ns_ = (thread_ns() - from) / kReads;
    }
    counts_ = on;
  }

  // Once the instance is created.
  static void begin() {
#define NERITIC_COUNT(name) put_before<&name>(name);
    NERITIC_COUNT(vkAllocateCommandBuffers)
    NERITIC_COUNT(vkAllocateDescriptorSets)
    NERITIC_COUNT(vkBeginCommandBuffer)
    NERITIC_COUNT(vkCmdBeginRendering)
    NERITIC_COUNT(vkCmdBindDescriptorSets)
    NERITIC_COUNT(vkCmdBindIndexBuffer)
    NERITIC_COUNT(vkCmdBindPipeline)
    NERITIC_COUNT(vkCmdBindVertexBuffers)
    NERITIC_COUNT(vkCmdBlitImage)
    NERITIC_COUNT(vkCmdClearColorImage)
    NERITIC_COUNT(vkCmdClearDepthStencilImage)
    NERITIC_COUNT(vkCmdCopyBuffer)
    NERITIC_COUNT(vkCmdCopyBufferToImage)
    NERITIC_COUNT(vkCmdCopyImage)
    NERITIC_COUNT(vkCmdCopyImageToBuffer)
    NERITIC_COUNT(vkCmdDispatch)
    NERITIC_COUNT(vkCmdDispatchIndirect)
    NERITIC_COUNT(vkCmdDraw)
    NERITIC_COUNT(vkCmdDrawIndexed)
    NERITIC_COUNT(vkCmdEndRendering)
    NERITIC_COUNT(vkCmdFillBuffer)
    NERITIC_COUNT(vkCmdPipelineBarrier2)
    NERITIC_COUNT(vkCmdPushConstants)
    NERITIC_COUNT(vkCmdSetCullMode)
    NERITIC_COUNT(vkCmdSetFrontFace)
    NERITIC_COUNT(vkCmdSetScissor)
    NERITIC_COUNT(vkCmdSetViewport)
    NERITIC_COUNT(vkCmdWriteTimestamp2)
    NERITIC_COUNT(vkEndCommandBuffer)
    NERITIC_COUNT(vkGetQueryPoolResults)
    NERITIC_COUNT(vkGetSemaphoreCounterValue)
    NERITIC_COUNT(vkQueueSubmit2)
    NERITIC_COUNT(vkResetCommandPool)
    NERITIC_COUNT(vkResetDescriptorPool)
    NERITIC_COUNT(vkResetQueryPool)
    NERITIC_COUNT(vkUpdateDescriptorSets)
#undef NERITIC_COUNT
  }

 private:
  struct Span {
    const TimeNs begun_ns = counts_ ? thread_ns() : 0;
    ~Span() {
      if (!counts_) return;
      spent_ns_ += thread_ns() - begun_ns;
      ++calls_;
    }
  };
  template <auto* kSlot, class Given, class... Arguments>
  static void put_before(Given (*loaded)(Arguments...)) {
    static Given (*inner)(Arguments...) = nullptr;
    Given (*const counted)(Arguments...) = [](Arguments... arguments) -> Given {
      const Span span;
      return inner(arguments...);
    };
    if (loaded == counted) return;
    inner = loaded;
    *kSlot = counted;
  }
  static inline bool counts_ = false;
  static inline TimeNs spent_ns_ = 0, calls_ = 0, clock_ns_ = 0;
};

}  // namespace neritic::testbed
