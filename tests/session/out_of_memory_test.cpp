// A frame that the device has no memory for is refused by what a person knows of it: the camera, its
// size, and what would do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/gpu_fixture.hpp"
#include "tools/session/session.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;
using OutOfMemory = test::GpuTest;

// The driver's answer while it lives.
class WithoutMemory {
 public:
  WithoutMemory() {
    real_ = vkAllocateMemory;
    vkAllocateMemory = refuse;
  }
  ~WithoutMemory() { vkAllocateMemory = real_; }

 private:
  static VKAPI_ATTR VkResult VKAPI_CALL refuse(VkDevice, const VkMemoryAllocateInfo*,
                                               const VkAllocationCallbacks*, VkDeviceMemory*) {
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  PFN_vkAllocateMemory real_ = nullptr;
};

TEST_F(OutOfMemory, NamesTheLargestCameraAndWhatWouldDo) {
  scene::Scene scene;
  scene.path = "test";
  for (const std::uint32_t width : {100u, 2500u, 300u}) {
    scene::Camera camera;
    camera.name = "camera_" + std::to_string(width);
    camera.width = width;
    camera.height = 1000;
    scene.cameras.push_back(camera);
  }
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  FrameRequest request;
  request.cameras = {0, 1, 2};
  {
    const WithoutMemory fake;
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

}  // namespace
}  // namespace neritic::tools
