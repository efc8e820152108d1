// Buffers and images to the device and back.
#include <cstring>
#include <numeric>

#include "engine/core/random.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

constexpr VkImageUsageFlags kTexture =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

class TransferTest : public test::GpuTest {
 protected:
  Result<Image> image(VkFormat format, std::uint32_t width, std::uint32_t height,
                      std::uint32_t layers = 1, std::uint32_t mips = 1) {
    ImageDesc desc;
    desc.name = "test image";
    desc.format = format;
    desc.width = width;
    desc.height = height;
    desc.layers = layers;
    desc.mips = mips;
    desc.usage = kTexture;
    return Image::create(device(), desc);
  }
  static std::vector<std::byte> noise(std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(random_bits({3}, i));
    return bytes;
  }
};

TEST_F(TransferTest, ABufferLargerThanTheStagingComesBack) {
  const auto bytes = noise((std::size_t{33} << 20) + 12);
  BufferDesc desc;
  desc.name = "large";
  desc.size = bytes.size() + 8;
  desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  NERITIC_ASSERT_OK(const Buffer target, Buffer::create(device(), desc));
  desc.name = "back";
  desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  desc.memory = MemoryUse::kReadback;
  NERITIC_ASSERT_OK(const Buffer back, Buffer::create(device(), desc));
  NERITIC_ASSERT_STATUS(upload_buffer(device(), target, bytes, 8));
  NERITIC_ASSERT_STATUS(run_once(device(), [&](VkCommandBuffer commands) {
    const VkBufferCopy region{8, 8, bytes.size()};
    vkCmdCopyBuffer(commands, target.handle(), back.handle(), 1, &region);
  }));
  EXPECT_EQ(std::memcmp(back.mapped<std::byte>().data() + 8, bytes.data(), bytes.size()), 0);
}

TEST_F(TransferTest, MappedBuffersAreFilledDirectly) {
  BufferDesc desc;
  desc.name = "mapped";
  desc.size = 16;
  desc.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  desc.memory = MemoryUse::kUpload;
  NERITIC_ASSERT_OK(const Buffer target, Buffer::create(device(), desc));
  const auto bytes = noise(8);
  NERITIC_ASSERT_STATUS(upload_buffer(device(), target, bytes, 4));
  EXPECT_EQ(std::memcmp(target.mapped<std::byte>().data() + 4, bytes.data(), 8), 0);
}

TEST_F(TransferTest, ImagesOfEveryTexelSizeComeBack) {
  for (const VkFormat format :
       {VK_FORMAT_R8_UNORM, VK_FORMAT_R16_UINT, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_SFLOAT,
        VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
    NERITIC_ASSERT_OK(const Image target, image(format, 37, 11, 3));
    const std::size_t layer_bytes = 37 * 11 * texel_bytes(format);
    const auto bytes = noise(3 * layer_bytes);
    NERITIC_ASSERT_STATUS(upload_image(device(), target, bytes));
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
      NERITIC_ASSERT_OK(
          const auto back,
          read_image(device(), target, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, layer));
      ASSERT_EQ(back.size(), layer_bytes);
      EXPECT_EQ(std::memcmp(back.data(), bytes.data() + layer * layer_bytes, layer_bytes), 0)
          << "format " << format << " layer " << layer;
    }
  }
}

// Each mip texel is the mean of the 2 x 2 above it, to the rounding of eight bits a step.
TEST_F(TransferTest, MipsAreMeansOfTheLevelAbove) {
  constexpr std::uint32_t kSize = 32;
  NERITIC_ASSERT_OK(const Image target, image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize, 2, 6));
  const auto bytes = noise(kSize * kSize * 4 * 2);
  NERITIC_ASSERT_STATUS(upload_image(device(), target, bytes));
  for (std::uint32_t layer = 0; layer < 2; ++layer) {
    std::vector<double> above(kSize * kSize * 4);
    for (std::size_t i = 0; i < above.size(); ++i)
      above[i] = std::to_integer<int>(bytes[layer * above.size() + i]);
    for (std::uint32_t mip = 1; mip < 6; ++mip) {
      const std::uint32_t side = kSize >> mip;
      NERITIC_ASSERT_OK(
          const auto back,
          read_image(device(), target, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, layer, mip));
      ASSERT_EQ(back.size(), side * side * 4);
      std::vector<double> now(back.size());
      for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x)
          for (std::uint32_t c = 0; c < 4; ++c) {
            double mean = 0.0;
            for (std::uint32_t k = 0; k < 4; ++k)
              mean += 0.25 * above[((2 * y + k / 2) * 2 * side + 2 * x + k % 2) * 4 + c];
            const std::size_t at = (y * side + x) * 4 + c;
            now[at] = std::to_integer<int>(back[at]);
            ASSERT_NEAR(now[at], mean, 1.0) << "mip " << mip << " at " << x << ", " << y;
          }
      above = now;
    }
  }
}

TEST_F(TransferTest, OddSizedMipsEndInOneTexel) {
  NERITIC_ASSERT_OK(const Image target, image(VK_FORMAT_R8G8B8A8_SRGB, 13, 3, 1, 4));
  const std::vector<std::byte> grey(13 * 3 * 4, std::byte{100});
  NERITIC_ASSERT_STATUS(upload_image(device(), target, grey));
  for (const auto& [mip, texels] : {std::pair{1u, 6u}, {2u, 3u}, {3u, 1u}}) {
    NERITIC_ASSERT_OK(
        const auto back,
        read_image(device(), target, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0, mip));
    ASSERT_EQ(back.size(), texels * 4);
    for (const std::byte value : back) EXPECT_NEAR(std::to_integer<int>(value), 100, 1);
  }
}

TEST_F(TransferTest, ADepthImageComesBack) {
  ImageDesc desc;
  desc.name = "depth";
  desc.format = VK_FORMAT_D32_SFLOAT;
  desc.width = 5;
  desc.height = 4;
  desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | kTexture;
  NERITIC_ASSERT_OK(const Image target, Image::create(device(), desc));
  std::vector<float> depth(20);
  std::iota(depth.begin(), depth.end(), 0.0f);
  for (float& value : depth) value /= 32.0f;
  NERITIC_ASSERT_STATUS(upload_image(device(), target, std::as_bytes(std::span(depth))));
  NERITIC_ASSERT_OK(const auto back,
                    read_image(device(), target, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
  EXPECT_EQ(std::memcmp(back.data(), depth.data(), back.size()), 0);
}

TEST_F(TransferTest, ImagesTheDeviceCannotHaveAreErrors) {
  const std::uint32_t most = device().limits().maxImageDimension2D;
  for (const auto& [width, height] :
       {std::pair{most + 1, 1u}, {1u, most + 1}, {0u, 4u}, {4u, 0u}}) {
    const auto made = image(VK_FORMAT_R8_UNORM, width, height);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
    EXPECT_NE(made.error().message.find("test image"), std::string::npos);
  }
  EXPECT_FALSE(image(VK_FORMAT_R8_UNORM, 4, 4, 1, 9).ok()) << "more mips than a 4 x 4 image has";
  EXPECT_FALSE(image(VK_FORMAT_UNDEFINED, 4, 4).ok());
  EXPECT_TRUE(image(VK_FORMAT_R8_UNORM, most, 1).ok());
}

// 64 layers of the largest size in the widest format: 256 GiB on a device that takes 16k images.
TEST_F(TransferTest, AnImageBeyondTheDevicesMemoryIsOutOfMemory) {
  const std::uint32_t most = device().limits().maxImageDimension2D;
  const std::uint64_t bytes = std::uint64_t{most} * most * 64 * 16;
  if (bytes <= device().info().memory_bytes) GTEST_SKIP() << "this device could hold it";
  const auto made = image(VK_FORMAT_R32G32B32A32_SFLOAT, most, most, 64);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kOutOfMemory) << made.error().message;
}

TEST_F(TransferTest, MemoryCanBeShared) {
  ImageDesc desc;
  desc.name = "aliased";
  desc.format = VK_FORMAT_R32_UINT;
  desc.width = desc.height = 16;
  desc.usage = kTexture;
  const VkMemoryRequirements needs = image_requirements(device(), desc);
  EXPECT_GE(needs.size, 16u * 16 * 4);
  NERITIC_ASSERT_OK(const Allocation memory,
                    device().allocator().allocate(needs, MemoryUse::kDevice, false));
  NERITIC_ASSERT_OK(const Image a,
                    Image::create_at(device(), desc, memory.memory(), memory.offset()));
  NERITIC_ASSERT_OK(const Image b,
                    Image::create_at(device(), desc, memory.memory(), memory.offset()));
  EXPECT_NE(a.handle(), b.handle());
  EXPECT_NE(b.view(), VK_NULL_HANDLE);
}

}  // namespace
}  // namespace neritic::gpu
