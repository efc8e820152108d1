// `neritic doctor`: what this machine has, and what will work on it.
#include "tools/neritic/doctor.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
namespace {

constexpr const char* kNoDevice = "no Vulkan device to run on";
constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

std::string version(std::uint32_t api) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api),
                     VK_API_VERSION_PATCH(api));
}

bool can_render(const Machine& machine) {
  return machine.chosen && !machine.trouble;
}

Verdict window_verdict(const Machine& machine) {
  Verdict verdict{"dive (window)", false, ""};
  if (!can_render(machine))
    verdict.why = kNoDevice;
  else if (machine.display.empty())
    verdict.why = "no display: neither DISPLAY nor WAYLAND_DISPLAY is set";
  else if (!machine.display_there)
    verdict.why = "display " + machine.display + " is named but not there";
  else if (!machine.devices[*machine.chosen].can_present)
    verdict.why = machine.devices[*machine.chosen].name + " cannot show pictures in a window";
  else
    verdict = {verdict.command, true, "on " + machine.display};
  return verdict;
}

Verdict headset_verdict(const Machine& machine) {
  Verdict verdict{"dive (headset)", false, ""};
  if (!can_render(machine))
    verdict.why = kNoDevice;
  else if (machine.openxr_runtime.empty() && !machine.headset)
    verdict.why = "no OpenXR runtime is configured (docs/headsets.md)";
  else if (!machine.openxr_manifest_exists && !machine.headset)
    verdict.why = machine.openxr_runtime.string() + " (XR_RUNTIME_JSON) is not there";
  else if (!machine.headset && !machine.openxr_manifest_trouble.empty())
    verdict.why = machine.openxr_runtime.string() + ": " + machine.openxr_manifest_trouble;
  else if (!machine.headset)
    verdict.why = machine.headset_trouble;
  else if (machine.headset->system.empty())
    verdict.why = machine.headset->runtime + " has no headset now";
  else
    verdict = {verdict.command, true,
               "on " + machine.headset->system + " by " + machine.headset->runtime};
  return verdict;
}

std::string headset_text(const xr::HeadsetInfo& headset) {
  std::string text =
      fmt::format("  {}, {}\n", headset.runtime,
                  headset.system.empty() ? "no headset now" : "headset " + headset.system);
  for (const xr::HeadsetInfo::Extension& extension : headset.extensions)
    text += fmt::format("  {:<44}{:<8}{}\n", extension.name,
                        extension.offered ? "offered" : "absent", extension.adds);
  std::string others;
  for (const std::string& name : headset.others) others += (others.empty() ? "" : ", ") + name;
  if (!others.empty()) text += "  not used: " + others + "\n";
  return text;
}

nlohmann::json headset_json(const xr::HeadsetInfo& headset) {
  nlohmann::json json{{"name", headset.runtime}, {"headset", headset.system}};
  for (const xr::HeadsetInfo::Extension& extension : headset.extensions)
    json["extensions"][extension.name] = {{"offered", extension.offered}, {"adds", extension.adds}};
  json["others"] = headset.others;
  return json;
}

std::string device_text(const Machine& machine, std::size_t position) {
  const gpu::DeviceInfo& device = machine.devices[position];
  const bool chosen = machine.chosen == static_cast<std::uint32_t>(position);
  std::string text =
      fmt::format("  {}: {}{}\n", device.index, device.name, chosen ? "   <- would be used" : "");
  text += fmt::format("     {}, {}, Vulkan {}\n", device.kind,
                      device.driver.empty() ? "driver not named" : device.driver,
                      version(device.api_version));
  text +=
      fmt::format("     {}\n", device.usable ? "usable" : "not usable: lacks " + device.missing);
  text += fmt::format(
      "     {} views per pass, images up to {} x {}, {} pass times, {:.1f} GiB {}{}\n",
      device.max_views, device.max_image_size, device.max_image_size,
      device.timestamps ? "measures" : "no", static_cast<double>(device.memory_bytes) / kGiB,
      device.shared_memory ? "shared with the CPU" : "of its own",
      device.can_present ? "" : ", no windows");
  if (const std::string around = gpu::workarounds(device.quirks); !around.empty())
    text += fmt::format("     works around faults of its driver: {}\n", around);
  return text;
}

nlohmann::json device_json(const gpu::DeviceInfo& device) {
  return {{"index", device.index},
          {"name", device.name},
          {"kind", device.kind},
          {"driver", device.driver},
          {"api_version", version(device.api_version)},
          {"usable", device.usable},
          {"missing", device.missing},
          {"max_views", device.max_views},
          {"max_image_size", device.max_image_size},
          {"timestamps", device.timestamps},
          {"can_present", device.can_present},
          {"shared_memory", device.shared_memory},
          {"quirks",
           {{"clips_into_wrong_view", device.quirks.clips_into_wrong_view},
            {"late_timestamps", device.quirks.late_timestamps}}},
          {"memory_bytes", device.memory_bytes}};
}

}  // namespace

std::vector<Verdict> verdicts(const Machine& machine) {
  const bool render = can_render(machine);
  const std::string device =
      render ? "on " + machine.devices[*machine.chosen].name : std::string(kNoDevice);
  std::vector<Verdict> out;
  out.push_back({"render", render, device});
  out.push_back({"sonar --method gpu", render, device});
  out.push_back({"sonar --method reference", true, "on the CPU, no Vulkan needed"});
  out.push_back(window_verdict(machine));
  out.push_back(headset_verdict(machine));
  out.push_back({"curves of plan, physio, dive", !machine.matplotlib.empty(),
                 machine.matplotlib.empty() ? std::string("no matplotlib: ") + kHowToGetMatplotlib
                                            : "matplotlib " + machine.matplotlib});
  out.push_back({"tests with validation", render && machine.validation_layer,
                 !render ? kNoDevice
                 : machine.validation_layer
                     ? "the layer is installed"
                     : "install the Debian package vulkan-validationlayers"});
  return out;
}

std::string doctor_text(const Machine& machine) {
  std::string text = "Vulkan devices\n";
  for (std::size_t i = 0; i < machine.devices.size(); ++i) text += device_text(machine, i);
  if (machine.devices.empty()) text += "  none\n";
  if (machine.trouble) text += fmt::format("  {}\n", machine.trouble->message);
  if (can_render(machine))
    text += fmt::format("  tested: it starts and answers in {:.0f} ms\n", machine.device_start_ms);
  text += fmt::format(
      "Validation layer    {}\n",
      machine.validation_layer ? "installed" : "absent (Debian package vulkan-validationlayers)");
  text += fmt::format("matplotlib          {}\n",
                      machine.matplotlib.empty() ? std::string("absent: ") + kHowToGetMatplotlib
                                                 : machine.matplotlib);
  text +=
      fmt::format("Display             {}{}\n", machine.display.empty() ? "none" : machine.display,
                  machine.display.empty() || machine.display_there ? "" : " (not there)");
  text += fmt::format(
      "OpenXR runtime      {}{}\n",
      machine.openxr_runtime.empty() ? "none configured" : machine.openxr_runtime.string(),
      machine.headset || machine.openxr_runtime.empty() ? ""
      : !machine.openxr_manifest_exists                 ? " (no such file)"
      : machine.openxr_manifest_trouble.empty()         ? " (does not answer)"
                                                : " (" + machine.openxr_manifest_trouble + ")");
  if (machine.headset) text += headset_text(*machine.headset);
  text += fmt::format(
      "Pipeline cache      {}{}\n",
      machine.cache_folder.empty() ? "nowhere (HOME is not set)" : machine.cache_folder.string(),
      machine.cache_folder.empty() || machine.cache_writable ? "" : " (not writable)");
  text += fmt::format("Processor           {} threads\n", machine.cpu_threads);
  text += fmt::format("Memory              {:.1f} GiB, {:.1f} GiB available\n",
                      static_cast<double>(machine.memory_bytes) / kGiB,
                      static_cast<double>(machine.memory_available_bytes) / kGiB);
  text += "What will work\n";
  for (const Verdict& verdict : verdicts(machine))
    text += fmt::format("  {:<30}{:<5}{}\n", verdict.command, verdict.works ? "yes" : "no",
                        verdict.why);
  return text;
}

std::string doctor_json(const Machine& machine) {
  nlohmann::json json;
  json["devices"] = nlohmann::json::array();
  for (const gpu::DeviceInfo& device : machine.devices)
    json["devices"].push_back(device_json(device));
  json["chosen"] = nullptr;
  if (machine.chosen) json["chosen"] = machine.devices[*machine.chosen].index;
  json["trouble"] = nullptr;
  if (machine.trouble) json["trouble"] = machine.trouble->message;
  json["device_start_ms"] = machine.device_start_ms;
  json["validation_layer"] = machine.validation_layer;
  json["matplotlib"] = nullptr;
  if (!machine.matplotlib.empty()) json["matplotlib"] = machine.matplotlib;
  json["display"] = {{"name", machine.display}, {"there", machine.display_there}};
  json["openxr"] = {{"runtime", machine.openxr_runtime.string()},
                    {"exists", machine.openxr_manifest_exists},
                    {"trouble", nullptr}};
  if (!machine.headset && !machine.openxr_runtime.empty())
    json["openxr"]["trouble"] = machine.openxr_manifest_trouble.empty()
                                    ? machine.headset_trouble
                                    : machine.openxr_manifest_trouble;
  if (machine.headset) json["openxr"]["answer"] = headset_json(*machine.headset);
  json["cache"] = {{"folder", machine.cache_folder.string()}, {"writable", machine.cache_writable}};
  json["cpu_threads"] = machine.cpu_threads;
  json["memory_bytes"] = machine.memory_bytes;
  json["memory_available_bytes"] = machine.memory_available_bytes;
  for (const Verdict& verdict : verdicts(machine))
    json["works"][verdict.command] = {{"works", verdict.works}, {"why", verdict.why}};
  // Names from the environment may be any bytes; what is not UTF-8 is replaced.
  return json_text(json) + "\n";
}

Status run_doctor(const DoctorFlags& flags) {
  const Machine machine = examine_machine(flags.device);
  fmt::print("{}", flags.json ? doctor_json(machine) : doctor_text(machine));
  std::fflush(stdout);
  if (!machine.trouble) return {};
  // A device that is not there is this command's finding (status 1), not a usage error.
  Error error = *machine.trouble;
  if (error.code == ErrorCode::kBadInput) error.code = ErrorCode::kNoDevice;
  return error;
}

}  // namespace neritic::tools
