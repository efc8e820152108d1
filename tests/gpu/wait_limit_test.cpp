// How long is waited for the device: a slow one is not a lost one.
#include <gmock/gmock.h>

#include "engine/gpu/frames.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

using ::testing::HasSubstr;
using WaitLimit = test::GpuTest;

constexpr VkDeviceSize kLarge_bytes = VkDeviceSize{256} << 20;  // some ten milliseconds to fill

Result<std::unique_ptr<Device>> impatient(const Device& device) {
  DeviceOptions options;
  options.device = std::to_string(device.info().index);
  options.wait_limit_ns = 1;
  return Device::create(options);
}

TEST_F(WaitLimit, ProcessorsHaveNoneAndCardsAMinute) {
  if (device().info().kind == "CPU")
    EXPECT_EQ(device().wait_limit_ns(), UINT64_MAX);
  else
    EXPECT_EQ(device().wait_limit_ns(), 60'000'000'000u);
}

TEST_F(WaitLimit, WorkThatIsDoneAfterTheLimitIsDone) {
  NERITIC_ASSERT_OK(const auto slow, impatient(device()));
  NERITIC_ASSERT_OK(const Buffer buffer,
                    Buffer::create(*slow, {"large", kLarge_bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                           MemoryUse::kReadback}));
  NERITIC_ASSERT_STATUS(run_once(*slow, [&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 7);
  }));
  EXPECT_EQ(buffer.mapped<std::uint32_t>().back(), 7u);
}

TEST_F(WaitLimit, AFrameBeyondItIsALostDevice) {
  NERITIC_ASSERT_OK(const auto slow, impatient(device()));
  NERITIC_ASSERT_OK(const Buffer buffer, Buffer::create(*slow, {"large", kLarge_bytes,
                                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  NERITIC_ASSERT_OK(const auto frames, Frames::create(*slow));
  Status status;
  // On a busy machine a frame may be done before it is waited for.
  for (int i = 0; i < 20 && status.ok(); ++i) {
    NERITIC_ASSERT_OK(Commands* const commands, frames->begin());
    vkCmdFillBuffer(commands->handle(), buffer.handle(), 0, VK_WHOLE_SIZE, 7);
    NERITIC_ASSERT_OK(const std::uint64_t done, frames->submit());
    status = frames->wait(done);
  }
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kDeviceLost);
  EXPECT_THAT(status.error().message, HasSubstr("did not finish a frame in 1e-09 s"));
  slow->wait_idle();
}

}  // namespace
}  // namespace neritic::gpu
