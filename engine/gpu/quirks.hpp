// Known faults of drivers that the engine works around. Decided by the driver's name and version,
// shown by `doctor`, overridden by tests (DeviceOptions::quirks). Pure; any thread.
#pragma once

#include <volk.h>

#include <string>
#include <string_view>

namespace neritic::gpu {

struct Quirks {
  // Triangles that need clipping land in the wrong view of a multiview rendering: each view is
  // drawn in a rendering of its own.
  bool clips_into_wrong_view = false;
  // Timestamps are put into the next rendering, while dispatches run at once: each is followed by
  // an empty barrier.
  bool late_timestamps = false;

  bool operator==(const Quirks&) const = default;
};

// driver_info: what VkPhysicalDeviceDriverProperties says, for Mesa "Mesa 22.3.6 (LLVM 15.0.6)".
Quirks quirks_of(VkDriverId driver, std::string_view driver_info);

// "draws one view per rendering, a barrier after each timestamp"; empty if there are none.
std::string workarounds(const Quirks& quirks);

}  // namespace neritic::gpu
