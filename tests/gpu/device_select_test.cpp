// Device selection on invented lists; needs no GPU.
#include "engine/gpu/device_select.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace neritic::gpu {
namespace {

using ::testing::HasSubstr;

DeviceInfo device(std::uint32_t index, const std::string& name, const std::string& kind,
                  const std::string& missing = "") {
  DeviceInfo info;
  info.index = index;
  info.name = name;
  info.kind = kind;
  info.missing = missing;
  info.usable = missing.empty();
  return info;
}

const std::vector<DeviceInfo> kAll{
    device(0, "llvmpipe (LLVM 15)", "CPU"), device(1, "Intel UHD 630", "integrated GPU"),
    device(2, "NVIDIA RTX 4090", "discrete GPU"), device(3, "Virtio Venus", "virtual GPU")};

TEST(ChooseDevice, PrefersDiscreteThenIntegratedThenVirtualThenCpu) {
  std::vector<DeviceInfo> devices = kAll;
  for (const std::uint32_t expected : {2u, 1u, 3u, 0u}) {
    const auto chosen = choose_device(devices, "");
    ASSERT_TRUE(chosen.ok());
    EXPECT_EQ(*chosen, expected);
    devices[expected].usable = false;
    devices[expected].missing = "something";
  }
  EXPECT_FALSE(choose_device(devices, "").ok());
}

TEST(ChooseDevice, TakesTheFirstOfEqualKinds) {
  const std::vector<DeviceInfo> devices{device(0, "A", "CPU"), device(1, "B", "discrete GPU"),
                                        device(2, "C", "discrete GPU")};
  EXPECT_EQ(*choose_device(devices, ""), 1u);
}

TEST(ChooseDevice, FindsAPartOfTheNameInAnyCase) {
  EXPECT_EQ(*choose_device(kAll, "LLVM"), 0u);
  EXPECT_EQ(*choose_device(kAll, "uhd"), 1u);
}

TEST(ChooseDevice, TakesAnIndexBeforeAName) {
  EXPECT_EQ(*choose_device(kAll, "3"), 3u);
  EXPECT_EQ(*choose_device(kAll, "4090"), 2u);   // no such index, but such a name
  EXPECT_FALSE(choose_device(kAll, "15").ok());  // of a version, in llvmpipe's name
}

TEST(ChooseDevice, OfSeveralNamedTakesTheBestUsable) {
  const std::vector<DeviceInfo> devices{device(0, "GPU one", "CPU"),
                                        device(1, "GPU two", "discrete GPU", "multiview"),
                                        device(2, "GPU three", "integrated GPU")};
  EXPECT_EQ(*choose_device(devices, "gpu"), 2u);
}

TEST(ChooseDevice, AnUnknownNameListsWhatThereIs) {
  const auto chosen = choose_device(kAll, "voodoo");
  ASSERT_FALSE(chosen.ok());
  EXPECT_EQ(chosen.error().code, ErrorCode::kBadInput);
  for (const DeviceInfo& info : kAll) EXPECT_THAT(chosen.error().message, HasSubstr(info.name));
  EXPECT_THAT(chosen.error().message,
              HasSubstr("device: found 'voodoo'; accepted: part of a name"));
}

TEST(ChooseDevice, ANamedDeviceThatLacksSomethingSaysWhat) {
  const std::vector<DeviceInfo> devices{device(0, "old card", "discrete GPU", "synchronization2"),
                                        device(1, "llvmpipe", "CPU")};
  for (const char* wanted : {"0", "old"}) {
    const auto chosen = choose_device(devices, wanted);
    ASSERT_FALSE(chosen.ok());
    EXPECT_EQ(chosen.error().code, ErrorCode::kUnsupported);
    EXPECT_THAT(chosen.error().message, HasSubstr("synchronization2"));
  }
  EXPECT_EQ(*choose_device(devices, ""), 1u);
}

TEST(ChooseDevice, AnEmptyListNamesThePackage) {
  const auto chosen = choose_device({}, "");
  ASSERT_FALSE(chosen.ok());
  EXPECT_EQ(chosen.error().code, ErrorCode::kNoDevice);
  EXPECT_THAT(chosen.error().message, HasSubstr("mesa-vulkan-drivers"));
}

}  // namespace
}  // namespace neritic::gpu
