// The Vulkan 1.3 instance, device and queue that everything runs on. Created once by a program and
// passed by reference; owned by the thread that renders. Errors carry one sentence a user can act
// on.
#pragma once

#include <volk.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/quirks.hpp"

namespace neritic::gpu {

class Allocator;
class PipelineShelf;

struct ValidationLog;
struct ValidationTarget;

// The maker of the Vulkan objects if Vulkan's own functions must not be called (an OpenXR runtime
// makes them itself). Empty functions: Vulkan's own.
struct DeviceMaker {
  std::function<VkResult(const VkInstanceCreateInfo&, VkInstance*)> instance;
  // The device that the runtime's display hangs on; it must not contradict DeviceOptions::device.
  std::function<VkResult(VkInstance, VkPhysicalDevice*)> physical;
  std::function<VkResult(VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice*)> device;
};

struct DeviceOptions {
  std::string device;  // part of a name (any case) or an index; empty: discrete, integrated, CPU
  bool validation = false;  // the Khronos layer with synchronization validation
  // Extensions that a display asks for (a window: surfaces and swapchains). kUnsupported if one is
  // missing.
  std::vector<const char*> instance_extensions, device_extensions;
  DeviceMaker maker;
  // Where the pipeline cache is kept; empty: not kept. See default_cache_folder().
  std::filesystem::path cache_folder;
  // How long one submission may take before the device counts as lost; absent: a minute, and no
  // limit on CPUs, which are only slow.
  std::optional<std::uint64_t> wait_limit_ns;
  std::optional<Quirks> quirks;       // instead of those that the driver is known to have
  std::optional<bool> shared_memory;  // instead of what the device has
  bool clip_distance = true;          // false: shaderClipDistance stays off
  // Borrowed, may be nullptr: gets every validation message too, those about objects that still
  // live when the Device goes away included. Without it those are printed as notes.
  ValidationLog* validation_sink = nullptr;
};

struct DeviceInfo {
  std::string name, driver, kind;  // kind: "discrete GPU", "integrated GPU", "CPU", ...
  std::uint32_t index = 0;
  std::uint32_t api_version = 0;
  bool usable = false;
  std::string missing;               // what it lacks where it is not usable
  std::uint32_t max_views = 1;       // of one multiview pass
  std::uint32_t max_image_size = 0;  // texels along an axis of a 2D image
  bool can_present = false;          // it has a swapchain, for a window
  bool timestamps = false;           // its queue can time passes
  bool shared_memory = false;        // all device memory is also the host's (integrated GPU, CPU)
  std::uint64_t memory_bytes = 0;    // device-local heaps together
  Quirks quirks;                     // what the engine goes round
};

// The messages of Vulkan validation. A test fails on any message.
struct ValidationLog {
  std::vector<std::string> messages;
};

// $XDG_CACHE_HOME/neritic or ~/.cache/neritic; empty where neither is known.
std::filesystem::path default_cache_folder();

// Is VK_LAYER_KHRONOS_validation (Debian package vulkan-validationlayers) installed?
bool validation_layer_present();

// Every device the loader shows, usable or not. kNoDevice where there is no Vulkan loader or
// device, with the Debian package to install.
Result<std::vector<DeviceInfo>> list_devices();

class Device {
 public:
  static Result<std::unique_ptr<Device>> create(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkDevice handle() const { return device_; }
  VkQueue queue() const { return queue_; }  // graphics, compute, transfer (and present)
  std::uint32_t queue_family() const { return queue_family_; }
  const DeviceInfo& info() const { return info_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  // The optional features that are on: those the device has of the list in physical_device.cpp.
  const VkPhysicalDeviceFeatures& features() const { return features_; }
  // Bits of a timestamp that count; 0: the queue has no timestamps.
  std::uint32_t timestamp_valid_bits() const { return timestamp_valid_bits_; }
  double timestamp_period_ns() const { return limits_.timestampPeriod; }
  VkDeviceSize max_buffer_bytes() const { return max_buffer_bytes_; }
  std::uint32_t max_views() const { return max_views_; }          // multiview
  std::uint64_t wait_limit_ns() const { return wait_limit_ns_; }  // UINT64_MAX: none
  bool validation() const { return messenger_ != VK_NULL_HANDLE; }
  Allocator& allocator() const { return *allocator_; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
  PipelineShelf& pipelines() const { return *pipelines_; }
  const ValidationLog& validation_log() const { return *validation_log_; }
  void clear_validation_log() { validation_log_->messages.clear(); }

  // Names an object for the debugger and for validation messages (no cost without them).
  template <class Handle>
  void name_object(VkObjectType type, Handle handle, const std::string& name) const {
    name_object_bits(type, reinterpret_cast<std::uint64_t>(handle), name);
  }
  // A named region for debuggers (no cost without them).
  void begin_label(VkCommandBuffer commands, const std::string& name) const;
  void end_label(VkCommandBuffer commands) const;
  // Waits until the GPU has done all that was submitted.
  void wait_idle() const;
  // Writes the pipeline cache to disk (also done on destruction). Best effort: a cache is no
  // result.
  void save_pipeline_cache() const;

 private:
  Device();
  void name_object_bits(VkObjectType type, std::uint64_t handle, const std::string& name) const;
  Status create_device(const DeviceOptions& options);
  void load_pipeline_cache(const std::filesystem::path& folder);
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  std::uint32_t max_views_ = 1;
  VkDeviceSize max_buffer_bytes_ = 0;
  DeviceInfo info_;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceFeatures features_{};
  std::uint32_t timestamp_valid_bits_ = 0;
  std::uint64_t wait_limit_ns_ = 0;
  PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
  std::filesystem::path cache_file_;
  std::uint64_t cache_hash_ = 0;  // of what the file holds: unchanged data is not written again
  std::unique_ptr<Allocator> allocator_;
  std::unique_ptr<PipelineShelf> pipelines_;
  std::unique_ptr<ValidationLog> validation_log_;
  std::unique_ptr<ValidationTarget> validation_target_;
};

// "vkCreateImage: VK_ERROR_OUT_OF_DEVICE_MEMORY" with a fitting ErrorCode.
Error vulkan_error(VkResult result, const std::string& what);

}  // namespace neritic::gpu
