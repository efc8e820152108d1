// The findings of `neritic doctor` on a machine, and the conclusions from them. Plain data, so that
// the conclusions are tested on invented machines. Main thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/xr/openxr/headset.hpp"

namespace neritic::tools {

struct Machine {
  std::vector<gpu::DeviceInfo> devices;
  std::optional<std::uint32_t> chosen;  // position in devices
  // Why no device can be had, or why the chosen one did not answer.
  std::optional<Error> trouble;
  double device_start_ms = 0.0;  // creating the device and one round trip through its memory
  bool validation_layer = false;
  std::string matplotlib;  // version and the Python that has it; empty: curves are not drawn

  // "X11 :0" or "Wayland wayland-0" as the environment names it; empty: none named.
  std::string display;
  bool display_there = false;            // its socket is there (true for an X11 display elsewhere)
  std::filesystem::path openxr_runtime;  // the active runtime's manifest; empty: none configured
  bool openxr_manifest_exists = false;
  std::string openxr_manifest_trouble;     // why it names no runtime; empty: it names one
  std::optional<xr::HeadsetInfo> headset;  // what the runtime says
  std::string headset_trouble;             // or why it says nothing
  std::filesystem::path cache_folder;
  bool cache_writable = false;

  unsigned cpu_threads = 0;
  std::uint64_t memory_bytes = 0, memory_available_bytes = 0;
};

// Looks; wanted_device as --device. Never fails: what cannot be had is what it reports.
Machine examine_machine(const std::string& wanted_device);

// Where the OpenXR loader looks for the active runtime (OpenXR 1.0 loader design, "Runtime
// Discovery"): $XR_RUNTIME_JSON, then openxr/1/active_runtime.json under the user's and the
// system's configuration folders. Empty where there is none; a path that XR_RUNTIME_JSON names is
// returned whether it exists or not.
std::filesystem::path find_openxr_runtime();
// Why such a file is no manifest of a runtime whose library is there, in some words; empty: it is.
std::string trouble_of_manifest(const std::filesystem::path& manifest);

struct Verdict {
  std::string command;
  bool works = false;
  std::string why;
};
std::vector<Verdict> verdicts(const Machine& machine);

std::string doctor_text(const Machine& machine);
std::string doctor_json(const Machine& machine);

}  // namespace neritic::tools
