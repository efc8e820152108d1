#include "engine/gpu/quirks.hpp"

#include <charconv>

namespace neritic::gpu {
namespace {

// The major version of "Mesa 22.3.6 (LLVM 15.0.6)"; 0 where there is none.
int mesa_major(std::string_view info) {
  constexpr std::string_view kMesa = "Mesa ";
  int major = 0;
  if (info.starts_with(kMesa))
    std::from_chars(info.data() + kMesa.size(), info.data() + info.size(), major);
  return major;
}

}  // namespace

Quirks quirks_of(VkDriverId driver, std::string_view driver_info) {
  if (driver != VK_DRIVER_ID_MESA_LLVMPIPE) return {};
  Quirks quirks;
  // Seen in Mesa 22.3.6, gone in 25.0.7; what lies between was not tried.
  quirks.clips_into_wrong_view = mesa_major(driver_info) < 25;
  // Seen in both.
  quirks.late_timestamps = true;
  return quirks;
}

std::string workarounds(const Quirks& quirks) {
  std::string out;
  if (quirks.clips_into_wrong_view) out += "one view per rendering";
  if (quirks.late_timestamps)
    out += (out.empty() ? "" : ", ") + std::string("a barrier after each timestamp");
  return out;
}

}  // namespace neritic::gpu
