// The pipeline cache's file: kept, found again, and harmless when damaged or foreign.
#include "engine/gpu/pipeline_cache.hpp"

#include <cstring>

#include "engine/core/files.hpp"
#include "shaders.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::gpu {
namespace {

namespace fs = std::filesystem;

VkPhysicalDeviceProperties invented_device() {
  VkPhysicalDeviceProperties properties{};
  properties.vendorID = 7;
  properties.deviceID = 8;
  properties.pipelineCacheUUID[3] = 9;
  return properties;
}

std::vector<std::byte> driver_data(const VkPhysicalDeviceProperties& properties) {
  VkPipelineCacheHeaderVersionOne header{};
  header.headerSize = sizeof header;
  header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
  header.vendorID = properties.vendorID;
  header.deviceID = properties.deviceID;
  std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE);
  std::vector<std::byte> data(sizeof header + 100, std::byte{0x5a});
  std::memcpy(data.data(), &header, sizeof header);
  return data;
}

TEST(PipelineCacheFile, ComesBackAsItWas) {
  const auto properties = invented_device();
  const auto data = driver_data(properties);
  EXPECT_EQ(unpack_cache(pack_cache(data), properties), data);
}

TEST(PipelineCacheFile, AnyDamageMakesItAbsent) {
  const auto properties = invented_device();
  const auto whole = pack_cache(driver_data(properties));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto flipped = whole;
    flipped[i] ^= std::byte{1};
    EXPECT_TRUE(unpack_cache(flipped, properties).empty()) << "byte " << i;
    const auto cut = std::span(whole).first(i);
    EXPECT_TRUE(unpack_cache(cut, properties).empty()) << "cut to " << i;
  }
}

TEST(PipelineCacheFile, AnotherDevicesDataIsAbsent) {
  const auto whole = pack_cache(driver_data(invented_device()));
  auto other = invented_device();
  other.deviceID = 80;
  EXPECT_TRUE(unpack_cache(whole, other).empty());
  other = invented_device();
  other.pipelineCacheUUID[0] = 1;
  EXPECT_TRUE(unpack_cache(whole, other).empty());
}

class PipelineCacheTest : public test::GpuTest {
 protected:
  // A device that keeps its cache in the folder makes a pipeline and goes away.
  void make_a_pipeline(const fs::path& folder) {
    ValidationLog sink;
    DeviceOptions options;
    options.device = std::to_string(device().info().index);
    options.cache_folder = folder;
    NERITIC_ASSERT_OK(auto other, Device::create(options));
    ComputePipelineDesc desc;
    desc.name = "fill";
    desc.code = shaders::kTestBurnComp;
    desc.layout.bindings = {{0}};
    desc.layout.push_constant_bytes = 4;
    NERITIC_ASSERT_OK(Pipeline pipeline, Pipeline::create(*other, desc));
    pipeline = Pipeline();
    other.reset();
  }
  static std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    return files;
  }
};

TEST_F(PipelineCacheTest, IsWrittenUnderTheDevicesIdentity) {
  const test::ScratchFolder scratch;
  make_a_pipeline(scratch / "deep");
  const auto files = files_in(scratch / "deep");
  ASSERT_EQ(files.size(), 1u);  // and no temporary file beside it
  EXPECT_EQ(files[0], pipeline_cache_file(scratch / "deep", device().physical()));
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device().physical(), &properties);
  NERITIC_ASSERT_OK(const auto bytes, read_file(files[0]));
  EXPECT_FALSE(unpack_cache(bytes, properties).empty());
}

TEST_F(PipelineCacheTest, UnchangedDataIsNotWrittenAgain) {
  const test::ScratchFolder scratch;
  make_a_pipeline(scratch.path());
  const auto file = files_in(scratch.path()).at(0);
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(5);
  fs::last_write_time(file, old);
  const auto before = fs::last_write_time(file);
  make_a_pipeline(scratch.path());
  EXPECT_EQ(fs::last_write_time(file), before);
}

TEST_F(PipelineCacheTest, ADamagedFileIsIgnoredAndReplaced) {
  const test::ScratchFolder scratch;
  make_a_pipeline(scratch.path());
  const auto file = files_in(scratch.path()).at(0);
  NERITIC_ASSERT_OK(const auto good, read_file(file));
  for (const char* garbage :
       {"", "garbage", "NERPIPE1 and then nothing that fits the checksum....."}) {
    NERITIC_ASSERT_STATUS(write_text(file, garbage));
    make_a_pipeline(scratch.path());
    NERITIC_ASSERT_OK(const auto now, read_file(file));
    EXPECT_EQ(now, good);
  }
}

TEST_F(PipelineCacheTest, AFolderThatCannotBeMadeIsNoError) {
  const test::ScratchFolder scratch;
  NERITIC_ASSERT_STATUS(write_text(scratch / "file", "in the way"));
  make_a_pipeline(scratch / "file");
}

}  // namespace
}  // namespace neritic::gpu
