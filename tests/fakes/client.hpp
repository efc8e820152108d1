// A small correct OpenXR client, step by step, for the tests of the fake runtime: each step asserts
// that it succeeds. Vulkan by engine/gpu, with validation. Its OpenXR functions are the loader's.
#pragma once

#include <gtest/gtest.h>
#include <time.h>
#include <volk.h>

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"

namespace neritic::fakes {

// A swapchain and its images.
struct ClientImages {
  XrSwapchain swapchain = XR_NULL_HANDLE;
  std::uint32_t width = 0, height = 0, layers = 1;
  std::vector<VkImage> images;
};

class Client {
 public:
  Client() = default;
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // Each brings the client one step further; start() does them all, up to a session that is
  // focused.
  void start(std::vector<const char*> extensions = {});
  void make_instance(std::vector<const char*> extensions = {});
  void get_system();
  void make_device();
  void make_session(const void* next = nullptr);
  void make_space(XrReferenceSpaceType type = XR_REFERENCE_SPACE_TYPE_LOCAL);
  void make_swapchain(std::int64_t format = VK_FORMAT_R8G8B8A8_SRGB, std::uint32_t layers = 2);
  void begin_session();
  ClientImages make_images(std::int64_t format, std::uint32_t width, std::uint32_t height,
                           std::uint32_t layers = 1);
  // Takes all events; begins and ends the session as they ask.
  void poll();
  // Waits for a frame and begins it.
  XrFrameState begin_frame();
  void end_frame(const std::vector<const void*>& layers = {});
  // Acquires an image, fills every layer with these texels (or the one), releases it.
  void paint(ClientImages& images, const std::vector<glm::u8vec4>& texels);
  // The views at the frame's time, and a projection layer that shows `color` in them.
  const XrCompositionLayerProjection& projection();
  // One whole frame with the projection layer.
  void frame(glm::u8vec4 texel = {0, 0, 0, 255});
  void destroy();

  template <class Function>
  Function function(const char* name) {
    PFN_xrVoidFunction found = nullptr;
    EXPECT_EQ(xrGetInstanceProcAddr(instance, name, &found), XR_SUCCESS) << name;
    return reinterpret_cast<Function>(found);
  }

  XrInstance instance = XR_NULL_HANDLE;
  XrSystemId system = XR_NULL_SYSTEM_ID;
  std::unique_ptr<gpu::Device> device;
  XrSession session = XR_NULL_HANDLE;
  XrSpace space = XR_NULL_HANDLE;
  XrViewConfigurationType configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  ClientImages color;
  XrFrameState state{};
  XrSessionState session_state = XR_SESSION_STATE_UNKNOWN;
  std::vector<XrSessionState> states;  // all that were told
  bool running = false;
  std::vector<std::string> validation;  // messages of Vulkan validation

 private:
  std::vector<XrView> views_;
  std::vector<XrCompositionLayerProjectionView> projection_views_;
  XrCompositionLayerProjection projection_{};
};

}  // namespace neritic::fakes
