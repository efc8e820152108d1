#include "engine/gpu/device_select.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::gpu {
namespace {

// Best first; a kind that is not here comes last.
constexpr std::array<std::string_view, 4> kPreference{"discrete GPU", "integrated GPU",
                                                      "virtual GPU", "CPU"};

std::size_t rank(const DeviceInfo& device) {
  return static_cast<std::size_t>(std::find(kPreference.begin(), kPreference.end(), device.kind) -
                                  kPreference.begin());
}

std::optional<std::uint32_t> parse_index(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The best-ranked device that fits and, with usable_only, is usable.
template <class Fits>
std::optional<std::uint32_t> best(std::span<const DeviceInfo> devices, bool usable_only,
                                  const Fits& fits) {
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < devices.size(); ++i) {
    if (!fits(devices[i]) || (usable_only && !devices[i].usable)) continue;
    if (!found || rank(devices[i]) < rank(devices[*found])) found = i;
  }
  return found;
}

Error lacks(const DeviceInfo& device) {
  return failure(ErrorCode::kUnsupported, "device {} ({}) cannot run Neritic: it lacks {}",
                 device.index, device.name, device.missing);
}

}  // namespace

const char* device_kind_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

std::string device_names(std::span<const DeviceInfo> devices) {
  std::string out;
  for (const DeviceInfo& device : devices)
    out += fmt::format("{}{}: {} ({})", out.empty() ? "" : "; ", device.index, device.name,
                       device.kind);
  return out;
}

Error no_device() {
  // Where one is set the loader looks at the drivers that it names and at no other.
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
    if (const char* files = std::getenv(name); files && *files)
      return failure(ErrorCode::kNoDevice,
                     "no Vulkan device: {} is '{}', and no other driver is looked for; unset it "
                     "(the Debian package mesa-vulkan-drivers brings a driver)",
                     name, printable(files, 200));
  return failure(ErrorCode::kNoDevice,
                 "no Vulkan device: install the Debian package mesa-vulkan-drivers; where it is "
                 "installed, its driver does not load (ulimit -v too small?)");
}

Result<std::uint32_t> choose_device(std::span<const DeviceInfo> devices,
                                    const std::string& wanted) {
  if (devices.empty()) return no_device();
  if (wanted.empty()) {
    const auto found = best(devices, true, [](const DeviceInfo&) { return true; });
    if (found) return *found;
    std::string why;
    for (const DeviceInfo& d : devices) why += fmt::format("; {} lacks {}", d.name, d.missing);
    return failure(
        ErrorCode::kNoDevice,
        "no Vulkan device fits{}; the Debian package mesa-vulkan-drivers brings one that "
        "runs on the CPU",
        why);
  }
  if (const auto index = parse_index(wanted)) {
    const auto at = std::find_if(devices.begin(), devices.end(),
                                 [&](const DeviceInfo& d) { return d.index == *index; });
    if (at != devices.end()) {
      if (!at->usable) return lacks(*at);
      return static_cast<std::uint32_t>(at - devices.begin());
    }
  }
  // Names are full of small numbers (of versions, of bits); a model's has four digits (4090).
  if (parse_index(wanted) && wanted.size() < 4)
    return refusal("device", fmt::format("'{}'", wanted),
                   "part of a name, or a number, of " + device_names(devices));
  const auto named = [needle = lower_case(wanted)](const DeviceInfo& d) {
    return lower_case(d.name).find(needle) != std::string::npos;
  };
  if (const auto found = best(devices, true, named)) return *found;
  if (const auto found = best(devices, false, named)) return lacks(devices[*found]);
  return refusal("device", fmt::format("'{}'", wanted),
                 "part of a name, or a number, of " + device_names(devices));
}

}  // namespace neritic::gpu
