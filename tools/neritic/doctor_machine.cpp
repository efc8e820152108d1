// `neritic doctor`: looking at the machine.
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/memory.hpp"
#include "engine/gpu/device_select.hpp"
#include "engine/gpu/frames.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/doctor.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// One round trip: the device fills a buffer that the host reads.
Status try_device(gpu::Device& device) {
  constexpr std::uint32_t kPattern = 0x4e455249;
  gpu::BufferDesc desc;
  desc.name = "doctor";
  desc.size = 64;
  desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  desc.memory = gpu::MemoryUse::kReadback;
  NERITIC_TRY(const gpu::Buffer buffer, gpu::Buffer::create(device, desc));
  NERITIC_TRY_STATUS(gpu::run_once(device, [&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, kPattern);
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
  }));
  for (const std::uint32_t value : buffer.mapped<const std::uint32_t>())
    if (value != kPattern)
      return failure(ErrorCode::kDeviceLost, "{} writes wrong values", device.info().name);
  return {};
}

Status examine_vulkan(const std::string& wanted, Machine& machine) {
  NERITIC_TRY(machine.devices, gpu::list_devices());
  NERITIC_TRY(machine.chosen, gpu::choose_device(machine.devices, wanted));
  const TimeNs start = now_ns();
  gpu::DeviceOptions options;
  options.device = std::to_string(machine.devices[*machine.chosen].index);
  NERITIC_TRY(const auto device, gpu::Device::create(options));
  NERITIC_TRY_STATUS(try_device(*device));
  machine.device_start_ms = to_ms(now_ns() - start);
  return {};
}

// Wayland's socket is a path or lies in $XDG_RUNTIME_DIR (wl_display_connect); X11's local display
// N is /tmp/.X11-unix/XN (X(7)). Whether it lets us in is not tried.
void examine_display(Machine& machine) {
  std::error_code ignored;
  if (const std::string wayland = variable("WAYLAND_DISPLAY"); !wayland.empty()) {
    machine.display = "Wayland " + wayland;
    machine.display_there = fs::exists(fs::path(variable("XDG_RUNTIME_DIR")) / wayland, ignored);
    if (machine.display_there) return;
  }
  const std::string x11 = variable("DISPLAY");
  if (x11.empty()) return;
  machine.display = "X11 " + x11;
  const bool local = x11.front() == ':';
  const std::string number = x11.substr(1, x11.find('.') - 1);
  machine.display_there = !local || fs::exists("/tmp/.X11-unix/X" + number, ignored);
}

// The nearest folder that exists decides whether the cache folder can be made.
bool can_write(fs::path folder) {
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(folder, ignored) && folder != folder.parent_path())
    folder = folder.parent_path();
  return !folder.empty() && fs::is_directory(folder, ignored) &&
         ::access(folder.c_str(), W_OK | X_OK) == 0;
}

}  // namespace

fs::path find_openxr_runtime() {
  if (const std::string named = variable("XR_RUNTIME_JSON"); !named.empty()) return named;
  std::vector<fs::path> folders;
  const std::string config = variable("XDG_CONFIG_HOME"), home = variable("HOME");
  if (!config.empty())
    folders.emplace_back(config);
  else if (!home.empty())
    folders.push_back(fs::path(home) / ".config");
  const std::string system = variable("XDG_CONFIG_DIRS");
  std::istringstream list(system.empty() ? "/etc/xdg" : system);
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  folders.emplace_back("/etc");  // SYSCONFDIR of the loader
  for (const fs::path& folder : folders) {
    const fs::path manifest = folder / "openxr" / "1" / "active_runtime.json";
    if (is_file(manifest)) return manifest;
  }
  return {};
}

// The format is the loader's ("Runtime Manifest File Format"): a library by its path, relative to
// the manifest's folder, or by a bare name, which the system's search path has.
std::string trouble_of_manifest(const fs::path& manifest) {
  const auto text = read_text(manifest);
  if (!text.ok()) return text.error().message;
  const auto json = parse_json(*text);
  if (!json.ok()) return "is no JSON";
  const auto library = nlohmann::json::json_pointer("/runtime/library_path");
  if (!json->is_object() || !json->contains("file_format_version") || !json->contains(library) ||
      !json->at(library).is_string())
    return "is no manifest of an OpenXR runtime: it needs file_format_version and "
           "runtime.library_path";
  const fs::path path = json->at(library).get<std::string>();
  if (!path.has_parent_path()) return "";
  const fs::path whole = path.is_absolute() ? path : manifest.parent_path() / path;
  return is_file(whole) ? "" : "its library " + whole.string() + " is not there";
}

Machine examine_machine(const std::string& wanted_device) {
  Machine machine;
  if (const Status status = examine_vulkan(wanted_device, machine); !status.ok())
    machine.trouble = status.error();
  machine.validation_layer = gpu::validation_layer_present();
  machine.matplotlib = matplotlib_here();
  examine_display(machine);
  machine.openxr_runtime = find_openxr_runtime();
  machine.openxr_manifest_exists = is_file(machine.openxr_runtime);
  if (machine.openxr_manifest_exists)
    machine.openxr_manifest_trouble = trouble_of_manifest(machine.openxr_runtime);
  if (auto headset = xr::examine_headset(); headset.ok())
    machine.headset = std::move(headset).value();
  else
    machine.headset_trouble = headset.error().message;
  machine.cache_folder = gpu::default_cache_folder();
  machine.cache_writable = can_write(machine.cache_folder);
  machine.cpu_threads = std::thread::hardware_concurrency();
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGE_SIZE);
  if (pages > 0 && page > 0)
    machine.memory_bytes = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
  machine.memory_available_bytes = available_memory_bytes();
  return machine;
}

}  // namespace neritic::tools
