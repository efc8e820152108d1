// The allocator on a device: what is reserved, used and given back.
#include "engine/gpu/memory.hpp"

#include <vector>

#include "engine/core/random.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

constexpr VkDeviceSize kMiB = VkDeviceSize{1} << 20;

class MemoryTest : public test::GpuTest {
 protected:
  Result<Buffer> buffer(VkDeviceSize size, MemoryUse use = MemoryUse::kDevice) {
    BufferDesc desc;
    desc.name = "test buffer";
    desc.size = size;
    desc.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    desc.memory = use;
    return Buffer::create(device(), desc);
  }
  MemoryStatistics statistics() { return device().allocator().statistics(); }
};

TEST_F(MemoryTest, StatisticsGoBackToZero) {
  device().allocator().trim();
  ASSERT_EQ(statistics().reserved_bytes, 0u);
  {
    std::vector<Buffer> buffers;
    for (VkDeviceSize i = 0; i < 200; ++i) {
      const auto use = static_cast<MemoryUse>(i % 3);
      NERITIC_ASSERT_OK(Buffer made, buffer(1 + random_bits({1}, i) % (kMiB / 2), use));
      buffers.push_back(std::move(made));
      if (i % 5 == 4)
        buffers.erase(buffers.begin() + static_cast<std::ptrdiff_t>(i % buffers.size()));
    }
    EXPECT_EQ(statistics().allocations, buffers.size());
    EXPECT_GT(statistics().used_bytes, 0u);
    EXPECT_GE(statistics().reserved_bytes, statistics().used_bytes);
  }
  EXPECT_EQ(statistics().allocations, 0u);
  EXPECT_EQ(statistics().used_bytes, 0u);
  device().allocator().trim();
  EXPECT_EQ(statistics().reserved_bytes, 0u);
  EXPECT_EQ(statistics().blocks, 0u);
}

TEST_F(MemoryTest, ManySmallBuffersShareOneBlock) {
  device().allocator().trim();
  std::vector<Buffer> buffers;
  for (int i = 0; i < 100; ++i) {
    NERITIC_ASSERT_OK(Buffer made, buffer(1000));
    buffers.push_back(std::move(made));
  }
  EXPECT_EQ(statistics().blocks, 1u);
}

TEST_F(MemoryTest, ALargeBufferGetsABlockOfItsOwnThatGoesAtOnce) {
  device().allocator().trim();
  {
    NERITIC_ASSERT_OK(const Buffer large, buffer(65 * kMiB));
    EXPECT_EQ(statistics().blocks, 1u);
    EXPECT_LT(statistics().reserved_bytes, 66 * kMiB);
    NERITIC_ASSERT_OK(const Buffer small, buffer(100));
    EXPECT_EQ(statistics().blocks, 2u) << "small ones stay out of it";
  }
  EXPECT_EQ(statistics().blocks, 1u) << "one empty block stays for the next request";
}

TEST_F(MemoryTest, ImpossibleSizesAreOutOfMemoryAndLeaveNothing) {
  const MemoryStatistics before = statistics();
  const auto made = buffer(VkDeviceSize{1} << 46);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kOutOfMemory) << made.error().message;
  EXPECT_NE(made.error().message.find("70368744177664"), std::string::npos) << made.error().message;
  EXPECT_EQ(statistics().reserved_bytes, before.reserved_bytes);
}

TEST_F(MemoryTest, OnlyHostMemoryIsMapped) {
  NERITIC_ASSERT_OK(const Buffer on_device, buffer(64));
  EXPECT_TRUE(on_device.mapped<int>().empty());
  for (const MemoryUse use : {MemoryUse::kUpload, MemoryUse::kReadback}) {
    NERITIC_ASSERT_OK(const Buffer mapped, buffer(64, use));
    ASSERT_EQ(mapped.mapped<std::uint32_t>().size(), 16u);
    mapped.mapped<std::uint32_t>()[15] = 42;
    EXPECT_EQ(mapped.mapped<std::uint32_t>()[15], 42u);
  }
}

TEST_F(MemoryTest, BuffersOfOneBlockDoNotShareBytes) {
  std::vector<Buffer> buffers;
  for (std::uint32_t i = 0; i < 50; ++i) {
    NERITIC_ASSERT_OK(Buffer made, buffer(4 * (1 + i * 7), MemoryUse::kUpload));
    for (std::uint32_t& value : made.mapped<std::uint32_t>()) value = i;
    buffers.push_back(std::move(made));
  }
  for (std::uint32_t i = 0; i < 50; ++i)
    for (const std::uint32_t value : buffers[i].mapped<std::uint32_t>()) ASSERT_EQ(value, i);
}

TEST_F(MemoryTest, AnEmptyBufferCanStillBeBound) {
  NERITIC_ASSERT_OK(const Buffer empty, buffer(0));
  EXPECT_EQ(empty.size(), 16u);
}

TEST_F(MemoryTest, TexelsAreAsManyAsTheDeviceTakes) {
  BufferDesc desc{.name = "counts", .size = 400, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
  NERITIC_ASSERT_OK(const Buffer without, Buffer::create(device(), desc));
  EXPECT_EQ(without.texels(), VkBufferView{VK_NULL_HANDLE});
  desc.usage = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  NERITIC_ASSERT_OK(const Buffer with, Buffer::create(device(), desc));
  EXPECT_NE(with.texels(), VkBufferView{VK_NULL_HANDLE});
  desc.size = 4 * (VkDeviceSize{device().limits().maxTexelBufferElements} + 1);
  const Result<Buffer> too_large = Buffer::create(device(), desc);
  ASSERT_FALSE(too_large.ok());
  EXPECT_NE(too_large.error().message.find("texels"), std::string::npos)
      << too_large.error().message;
}

TEST_F(MemoryTest, MovingLeavesOneOwner) {
  device().allocator().trim();
  NERITIC_ASSERT_OK(Buffer first, buffer(64));
  const VkBuffer handle = first.handle();
  Buffer second = std::move(first);
  EXPECT_FALSE(first);  // NOLINT: what is left is empty by contract
  EXPECT_EQ(second.handle(), handle);
  second = Buffer();
  EXPECT_EQ(statistics().allocations, 0u);
}

}  // namespace
}  // namespace neritic::gpu
