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

// The extensions that the program's Vulkan objects were made with. They outlive a connection.
struct EnabledVulkan {
  std::vector<std::string> instance, device;
};

struct Extensions {
  bool vulkan1 = false;  // XR_KHR_vulkan_enable: takes a device that it did not make
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

  // The headset, with what it can do. kNoDevice: none now. After the session was lost it is asked
  // anew, as long as the headset is unplugged.
  Status find_system();
  // Whether this program's Vulkan is new enough. To be asked after each find_system.
  Status ask_vulkan();

  const Functions& xr() const { return xr_; }
  XrInstance instance() const { return instance_; }
  XrSystemId system() const { return system_; }
  const Extensions& has() const { return has_; }
  const HeadsetInfo& info() const { return info_; }
  const XrSystemProperties& properties() const { return properties_; }
  bool foveation_here() const { return foveation_here_; }
  bool hands_here() const { return hands_here_; }
  bool gaze_here() const { return gaze_here_; }

  // The result of a call, as a Status; a loss is kept, and XR_ERROR_RUNTIME_FAILURE until
  // take_failure.
  Status check(XrResult result, const char* call);
  // Whether a call failed, since this was last asked, in a way that does not say that anything is
  // lost: the next one may succeed.
  bool failed() const { return failed_; }
  bool take_failure() { return std::exchange(failed_, false); }
  // Whether pictures go on without what just failed; a note says `without`. False where session or
  // instance were lost with it.
  bool goes_without(const Error& error, std::string_view without);
  Loss loss() const { return loss_; }
  void lose(Loss loss) { loss_ = std::max(loss_, loss); }
  void forget_session_loss() { loss_ = loss_ == Loss::kSession ? Loss::kNone : loss_; }

  // On the host clock. Without XR_KHR_convert_timespec_time by the offset that note_frame found.
  TimeNs to_host(XrTime time) const;
  // xrWaitFrame has just returned: the frame before the displayed one begins about now.
  void note_frame(XrTime display_at, XrDuration period);

  // Both with the extensions too that a later connection may want of them, where Vulkan has those;
  // `enabled` gets all.
  VkResult make_instance(const VkInstanceCreateInfo& info, VkInstance* instance,
                         EnabledVulkan& enabled);
  VkResult find_physical(VkInstance instance, VkPhysicalDevice* device);
  VkResult make_device(VkPhysicalDevice physical, const VkDeviceCreateInfo& info, VkDevice* device,
                       EnabledVulkan& enabled);
  // The headset must be driven by the device that is already there. A device that this connection
  // did not make needs XR_KHR_vulkan_enable, since XR_KHR_vulkan_enable2 takes its own only.
  Status check_device(const gpu::Device& device, const EnabledVulkan& enabled);

 private:
  Runtime() = default;
  Status create_instance(const Loader& loader, const HeadsetOptions& options);
  Result<std::vector<std::string>> wanted_by_version1(bool device);
  Status check_version1(const gpu::Device& device, const EnabledVulkan& enabled);
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
  bool failed_ = false;
  VkInstance made_ = VK_NULL_HANDLE;  // by this connection
  TimeNs host_minus_xr_ns_ = 0;
  bool clocks_met_ = false;
};

}  // namespace neritic::xr::openxr
