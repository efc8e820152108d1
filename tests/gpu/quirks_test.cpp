// The driver faults that have a workaround, by driver and version.
#include "engine/gpu/quirks.hpp"

#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

using QuirksTest = test::GpuTest;

TEST(QuirksOf, AreLlvmpipesByItsMesa) {
  constexpr auto kLlvmpipe = VK_DRIVER_ID_MESA_LLVMPIPE;
  EXPECT_EQ(quirks_of(kLlvmpipe, "Mesa 22.3.6 (LLVM 15.0.6)"), (Quirks{true, true}));
  EXPECT_EQ(quirks_of(kLlvmpipe, "Mesa 24.2.8-1 (LLVM 15.0.6)"), (Quirks{true, true}));
  EXPECT_EQ(quirks_of(kLlvmpipe, "Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)"), (Quirks{false, true}));
  EXPECT_EQ(quirks_of(kLlvmpipe, "Mesa 26.1.0-devel"), (Quirks{false, true}));
  EXPECT_EQ(quirks_of(kLlvmpipe, "a driver that hides its version"), (Quirks{true, true}));
  EXPECT_EQ(quirks_of(VK_DRIVER_ID_MESA_RADV, "Mesa 22.3.6"), Quirks{});
  EXPECT_EQ(quirks_of(VK_DRIVER_ID_NVIDIA_PROPRIETARY, "535.183.01"), Quirks{});
}

TEST(QuirksOf, AreSaidInWords) {
  EXPECT_EQ(workarounds({}), "");
  EXPECT_EQ(workarounds({true, true}), "one view per rendering, a barrier after each timestamp");
  EXPECT_EQ(workarounds({false, true}), "a barrier after each timestamp");
}

TEST_F(QuirksTest, CanBeOverridden) {
  for (const Quirks wanted : {Quirks{}, Quirks{true, true}}) {
    DeviceOptions options;
    options.device = std::to_string(device().info().index);
    options.quirks = wanted;
    NERITIC_ASSERT_OK(const auto made, Device::create(options));
    EXPECT_EQ(made->info().quirks, wanted);
  }
}

}  // namespace
}  // namespace neritic::gpu
