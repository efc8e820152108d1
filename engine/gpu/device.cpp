#include "engine/gpu/device.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/gpu/device_select.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/instance.hpp"
#include "engine/gpu/memory.hpp"
#include "engine/gpu/physical_device.hpp"
#include "engine/gpu/pipeline_cache.hpp"
#include "engine/gpu/pipeline_shelf.hpp"

namespace neritic::gpu {
namespace fs = std::filesystem;
namespace {

// Drivers of graphics cards give up on a submission after some seconds; this is beyond all of them.
constexpr std::uint64_t kWaitLimit_ns = 60ull * 1000 * 1000 * 1000;

std::uint64_t hash_of(std::span<const std::byte> data) {
  Hash64 hash;
  hash.add_span(data);
  return hash.value();
}

std::vector<DeviceInfo> describe_all(std::span<const VkPhysicalDevice> devices) {
  std::vector<DeviceInfo> infos;
  for (const VkPhysicalDevice device : devices)
    infos.push_back(describe(device, static_cast<std::uint32_t>(infos.size())));
  return infos;
}

// The device that the maker says; kUnsupported if it cannot be used, kBadInput if the user wants
// another.
Result<std::uint32_t> made_choice(const DeviceOptions& options, VkInstance instance,
                                  std::span<const VkPhysicalDevice> devices,
                                  const std::vector<DeviceInfo>& infos) {
  VkPhysicalDevice wanted = VK_NULL_HANDLE;
  NERITIC_TRY_VK("the display's choice of a device", options.maker.physical(instance, &wanted));
  const auto found = std::find(devices.begin(), devices.end(), wanted);
  if (found == devices.end())
    return failure(ErrorCode::kNoDevice, "the display asks for a device that Vulkan does not list");
  const auto index = static_cast<std::uint32_t>(found - devices.begin());
  if (!infos[index].usable)
    return failure(ErrorCode::kUnsupported, "the display's device {} lacks {}", infos[index].name,
                   infos[index].missing);
  if (options.device.empty()) return index;
  NERITIC_TRY(const std::uint32_t chosen, choose_device(infos, options.device));
  if (chosen != index)
    return refusal("device", fmt::format("'{}'", options.device),
                   infos[index].name + ", on which the display hangs");
  return index;
}

template <class Function>
Function instance_function(VkInstance instance, const char* name) {
  return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

fs::path default_cache_folder() {
  // An XDG path that is not absolute is to be ignored (XDG Base Directory Specification).
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && fs::path(xdg).is_absolute())
    return fs::path(xdg) / "neritic";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".cache" / "neritic";
  return {};
}

Result<std::vector<DeviceInfo>> list_devices() {
  ValidationTarget unused;
  NERITIC_TRY(const InstanceHandles handles, create_instance({}, &unused));
  const auto devices = physical_devices(handles.instance);
  std::vector<DeviceInfo> infos;
  if (devices.ok()) infos = describe_all(devices.value());
  destroy_instance(handles);
  if (!devices.ok()) return devices.error();
  return infos;
}

Device::Device()
    : validation_log_(std::make_unique<ValidationLog>()),
      validation_target_(std::make_unique<ValidationTarget>()) {}

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options) {
  std::unique_ptr<Device> device(new Device());
  *device->validation_target_ = {device->validation_log_.get(), options.validation_sink};
  NERITIC_TRY(const InstanceHandles handles,
              create_instance(options, device->validation_target_.get()));
  device->instance_ = handles.instance;
  device->messenger_ = handles.messenger;
  if (handles.debug_utils) {
    const VkInstance instance = handles.instance;
    device->set_name_ = instance_function<PFN_vkSetDebugUtilsObjectNameEXT>(
        instance, "vkSetDebugUtilsObjectNameEXT");
    device->begin_label_ = instance_function<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        instance, "vkCmdBeginDebugUtilsLabelEXT");
    device->end_label_ =
        instance_function<PFN_vkCmdEndDebugUtilsLabelEXT>(instance, "vkCmdEndDebugUtilsLabelEXT");
  }
  NERITIC_TRY(const auto devices, physical_devices(device->instance_));
  const auto infos = describe_all(devices);
  NERITIC_TRY(const std::uint32_t chosen,
              options.maker.physical ? made_choice(options, device->instance_, devices, infos)
                                     : choose_device(infos, options.device));
  device->physical_ = devices[chosen];
  device->info_ = infos[chosen];
  log_info("device {} of {}: {}, {} {}", chosen, devices.size(), device->info_.name,
           device->info_.kind, device->info_.driver);
  device->info_.shared_memory = options.shared_memory.value_or(device->info_.shared_memory);
  device->info_.quirks = options.quirks.value_or(device->info_.quirks);
  device->wait_limit_ns_ =
      options.wait_limit_ns.value_or(device->info_.kind == "CPU" ? UINT64_MAX : kWaitLimit_ns);
  NERITIC_TRY_STATUS(device->create_device(options));
  device->allocator_ = std::make_unique<Allocator>(*device);
  device->pipelines_ = std::make_unique<PipelineShelf>();
  device->load_pipeline_cache(options.cache_folder);
  return device;
}

Status Device::create_device(const DeviceOptions& options) {
  VkPhysicalDeviceMaintenance4Properties sizes{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes};
  vkGetPhysicalDeviceProperties2(physical_, &properties);
  limits_ = properties.properties.limits;
  max_buffer_bytes_ = sizes.maxBufferSize;
  max_views_ = info_.max_views;
  const QueueChoice queue = choose_queue(physical_);
  queue_family_ = queue.family;
  timestamp_valid_bits_ = queue.timestamp_valid_bits;

  FeatureChain features;
  select_features(physical_, features);
  if (!options.clip_distance) features.core.features.shaderClipDistance = VK_FALSE;
  features_ = features.core.features;

  std::vector<const char*> extensions = options.device_extensions;
  for (const char* name : extensions)
    if (!has_device_extension(physical_, name))
      return failure(ErrorCode::kUnsupported, "device {} cannot be used by the display (no {})",
                     info_.name, name);
  // Named by its text: its declarations are still provisional. Where it is offered it must be asked
  // for.
  constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";
  if (has_device_extension(physical_, kPortabilitySubset)) extensions.push_back(kPortabilitySubset);
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueFamilyIndex = queue_family_;
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue_info;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  NERITIC_TRY_VK("vkCreateDevice (" + info_.name + ")",
                 options.maker.device ? options.maker.device(physical_, info, &device_)
                                      : vkCreateDevice(physical_, &info, nullptr, &device_));
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  // The instance is not named: it is the loader's own object, and the loader (1.3.239) hands it to
  // the driver as if it were the driver's, which writes into it or crashes. So with surfaces.
  name_object(VK_OBJECT_TYPE_DEVICE, device_, info_.name);
  name_object(VK_OBJECT_TYPE_QUEUE, queue_, "main queue");
  return {};
}

void Device::load_pipeline_cache(const fs::path& folder) {
  std::vector<std::byte> data;
  if (!folder.empty()) {
    cache_file_ = pipeline_cache_file(folder, physical_);
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physical_, &properties);
    if (const auto file = read_file(cache_file_); file.ok())
      data = unpack_cache(file.value(), properties);
    cache_hash_ = data.empty() ? 0 : hash_of(data);
  }
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = data.size();
  info.pInitialData = data.data();
  VkResult result = vkCreatePipelineCache(device_, &info, nullptr, &pipeline_cache_);
  if (result != VK_SUCCESS && !data.empty()) {  // the driver refused it after all: start empty
    info.initialDataSize = 0;
    info.pInitialData = nullptr;
    result = vkCreatePipelineCache(device_, &info, nullptr, &pipeline_cache_);
  }
  if (result != VK_SUCCESS) pipeline_cache_ = VK_NULL_HANDLE;  // pipelines can do without
  log_info("pipeline cache: {:.1f} KiB from {}", static_cast<double>(data.size()) / 1024.0,
           cache_file_.empty() ? "nowhere" : cache_file_.string());
  name_object(VK_OBJECT_TYPE_PIPELINE_CACHE, pipeline_cache_, "pipeline cache");
}

void Device::save_pipeline_cache() const {
  if (pipeline_cache_ == VK_NULL_HANDLE || cache_file_.empty()) return;
  std::size_t size = 0;
  if (vkGetPipelineCacheData(device_, pipeline_cache_, &size, nullptr) != VK_SUCCESS) return;
  std::vector<std::byte> data(size);
  if (vkGetPipelineCacheData(device_, pipeline_cache_, &size, data.data()) != VK_SUCCESS) return;
  data.resize(size);
  if (hash_of(data) == cache_hash_) return;
  if (!make_folder(cache_file_.parent_path()).ok()) return;
  (void)write_file(cache_file_, pack_cache(data));
}

Device::~Device() {
  if (device_ != VK_NULL_HANDLE) {
    wait_idle();
    save_pipeline_cache();
    if (pipeline_cache_ != VK_NULL_HANDLE)
      vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
    pipelines_.reset();
    allocator_.reset();
    validation_target_->log = nullptr;  // what comes now is about leaks: to the sink, or printed
    vkDestroyDevice(device_, nullptr);
  }
  destroy_instance({instance_, messenger_, false});
}

void Device::name_object_bits(VkObjectType type, std::uint64_t handle,
                              const std::string& name) const {
  if (!set_name_ || handle == 0) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name.c_str();
  (void)set_name_(device_, &info);  // a name is no result
}

void Device::begin_label(VkCommandBuffer commands, const std::string& name) const {
  if (!begin_label_) return;
  VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
  label.pLabelName = name.c_str();
  begin_label_(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) const {
  if (end_label_) end_label_(commands);
}

void Device::wait_idle() const {
  (void)vkDeviceWaitIdle(device_);
}

}  // namespace neritic::gpu
