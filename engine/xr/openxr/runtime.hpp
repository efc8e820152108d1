// Inside engine/xr/openxr only: the connection to a runtime, which is an instance with the
// extensions that it offers of those this program knows, its system (the headset), and the creation
// of Vulkan objects. Rendering thread.
#pragma once

#include <memory>

#include "engine/core/clock.hpp"
#include "engine/gpu/device.hpp"
#include "engine/xr/openxr/api.hpp"
#include "engine/xr/openxr/headset.hpp"

namespace neritic::xr::openxr {

// The meaning of a failed call for those who hold handles.
enum class Loss {
  kNone,
  kSession,   // the session and its children are dead; the instance lives
  kInstance,  // everything is dead: the runtime went away
};

struct Extensions {
  bool timespec = false, depth = false, refresh_rate = false, quad_views = false, foveated = false,
       hands = false, gaze = false, cylinder = false, mask = false, overlay = false, debug = false;
};

class Runtime {
 public:
  // Errors as Headset::connect; without a headset if system is false.
  static Result<std::unique_ptr<Runtime>> create(const HeadsetOptions& options, bool system,
                                                 std::vector<std::string>* messages);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  // The headset, with what it can do. kNoDevice: none now.
  Status find_system();

  const Functions& xr() const { return xr_; }
  XrInstance instance() const { return instance_; }
  XrSystemId system() const { return system_; }
  const Extensions& has() const { return has_; }
  const HeadsetInfo& info() const { return info_; }
  const XrSystemProperties& properties() const { return properties_; }
  bool foveation_here() const { return foveation_here_; }
  bool hands_here() const { return hands_here_; }
  bool gaze_here() const { return gaze_here_; }

  // The result of a call, as a Status; a loss is kept.
  Status check(XrResult result, const char* call);
  Loss loss() const { return loss_; }
  void lose(Loss loss) { loss_ = std::max(loss_, loss); }
  void forget_session_loss() { loss_ = loss_ == Loss::kSession ? Loss::kNone : loss_; }

  // On the host clock. Without XR_KHR_convert_timespec_time by the offset that note_frame found.
  TimeNs to_host(XrTime time) const;
  // xrWaitFrame has just returned: the frame before the displayed one begins about now.
  void note_frame(XrTime display_at, XrDuration period);

  VkResult make_instance(const VkInstanceCreateInfo& info, VkInstance* instance);
  VkResult find_physical(VkInstance instance, VkPhysicalDevice* device);
  VkResult make_device(VkPhysicalDevice physical, const VkDeviceCreateInfo& info, VkDevice* device);
  // The runtime of a new connection must drive its headset by the device that is already there.
  Status check_device(const gpu::Device& device);

 private:
  Runtime() = default;
  Status create_instance(const Loader& loader, const HeadsetOptions& options);
  Status ask_vulkan();
  void listen(std::vector<std::string>* messages);
  Functions xr_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrDebugUtilsMessengerEXT messenger_ = XR_NULL_HANDLE;
  Extensions has_;
  HeadsetInfo info_;
  XrSystemProperties properties_{XR_TYPE_SYSTEM_PROPERTIES};
  bool foveation_here_ = false, hands_here_ = false, gaze_here_ = false;
  Loss loss_ = Loss::kNone;
  TimeNs host_minus_xr_ns_ = 0;
  bool clocks_met_ = false;
};

}  // namespace neritic::xr::openxr
