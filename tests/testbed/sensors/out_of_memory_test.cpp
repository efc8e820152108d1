// A frame that the device has no memory for is refused by what a person knows of it: the camera,
// its size, and what would do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/memory.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using ::testing::HasSubstr;
using OutOfMemory = test::GpuTest;

// The driver's answer to more than this number of bytes at once, while it lives.
class LittleMemory {
 public:
  explicit LittleMemory(VkDeviceSize most_bytes) {
    real_ = vkAllocateMemory;
    most_bytes_ = most_bytes;
    vkAllocateMemory = refuse;
  }
  ~LittleMemory() { vkAllocateMemory = real_; }

 private:
  static VKAPI_ATTR VkResult VKAPI_CALL refuse(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* callbacks,
                                               VkDeviceMemory* memory) {
    if (info->allocationSize > most_bytes_) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return real_(device, info, callbacks, memory);
  }
  static inline PFN_vkAllocateMemory real_ = nullptr;
  static inline VkDeviceSize most_bytes_ = 0;
};

// Nothing but cameras of these widths and heights.
scene::Scene cameras_of(std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> sizes) {
  scene::Scene scene;
  scene.path = "test";
  for (const auto& [width, height] : sizes) {
    scene::Camera& camera = scene.cameras.emplace_back();
    camera.name = "camera_" + std::to_string(width);
    camera.width = width;
    camera.height = height;
  }
  return scene;
}

TEST_F(OutOfMemory, NamesTheLargestCameraAndWhatWouldDo) {
  NERITIC_ASSERT_OK(
      const auto session,
      Session::create(device(), cameras_of({{100, 1000}, {2500, 1000}, {300, 1000}})));
  FrameRequest request;
  request.cameras = {0, 1, 2};
  {
    const LittleMemory none(0);
    const auto result = session->render(request);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::kOutOfMemory);
    EXPECT_THAT(result.error().message,
                HasSubstr("camera camera_2500 of 2500x1000 (and 2 more sensors in the frame)"));
    EXPECT_THAT(result.error().message, HasSubstr("a smaller size or fewer sensors at once"));
  }
  // With memory again, the same session renders.
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  EXPECT_EQ(result.cameras[1].eyes[0].width, 2500u);
}

// Read-backs fit, the G-buffer does not; then frames that do fit are drawn as if nothing had been.
TEST_F(OutOfMemory, AFrameTooLargeIsInNobodysWay) {
  NERITIC_ASSERT_OK(const auto session,
                    Session::create(device(), cameras_of({{100, 100}, {200, 200}, {4000, 4000}})));
  FrameRequest request;
  request.capture = Capture{.motion = false}.without_geometry();
  const LittleMemory little(VkDeviceSize{200} << 20);
  request.cameras = {2};
  const auto result = session->render(request);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kOutOfMemory);
  EXPECT_THAT(result.error().message, HasSubstr("camera camera_4000 of 4000x4000"));
  for (const std::size_t camera : {0u, 1u, 0u}) {
    request.cameras = {camera};
    const auto small = session->render(request);
    ASSERT_TRUE(small.ok()) << small.error().message;
  }
}

// Before anything is allocated: a CPU's driver promises what the machine does not have.
TEST_F(OutOfMemory, MoreThanTheMachineHasIsRefusedBeforeItIsUsed) {
  scene::Scene scene;
  scene.path = "test";
  const auto pixels = static_cast<double>(available_memory_bytes()) / 60.0;
  const auto side = static_cast<std::uint32_t>(std::sqrt(pixels));
  scene.cameras.emplace_back().name = "giant";
  scene.cameras[0].width = scene.cameras[0].height = side;
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  const auto result = session->render(request);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kOutOfMemory);
  EXPECT_THAT(result.error().message, HasSubstr("camera giant of"));
  EXPECT_THAT(result.error().message, HasSubstr("the machine has"));
}

}  // namespace
}  // namespace neritic::testbed
