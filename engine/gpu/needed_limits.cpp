#include "engine/gpu/needed_limits.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

namespace neritic::gpu {
namespace {

struct NeededLimit {
  std::uint32_t VkPhysicalDeviceLimits::*member;
  std::uint32_t least;
  const char* name;
};

// Vulkan promises 4 of each.
constexpr std::array kNeededLimits{
    // A camera's G-buffer: normal, label, albedo, material, emission, motion.
    NeededLimit{&VkPhysicalDeviceLimits::maxColorAttachments, 6, "maxColorAttachments"},
    NeededLimit{&VkPhysicalDeviceLimits::maxFragmentOutputAttachments, 6,
                "maxFragmentOutputAttachments"},
    NeededLimit{&VkPhysicalDeviceLimits::maxFragmentCombinedOutputResources, 6,
                "maxFragmentCombinedOutputResources"},
    // The deform pass, and sonar echoes: sums, keys, scratch, columns, reflectivity and two more.
    NeededLimit{&VkPhysicalDeviceLimits::maxPerStageDescriptorStorageBuffers, 7,
                "maxPerStageDescriptorStorageBuffers"},
};

}  // namespace

std::string missing_limits(const VkPhysicalDeviceLimits& have) {
  std::string missing;
  for (const NeededLimit& needed : kNeededLimits)
    if (have.*needed.member < needed.least)
      missing += fmt::format("{}{} of {} (it has {})", missing.empty() ? "" : ", ", needed.name,
                             needed.least, have.*needed.member);
  return missing;
}

}  // namespace neritic::gpu
