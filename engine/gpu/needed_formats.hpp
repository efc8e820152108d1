// The image formats that Neritic's passes use, and how. A device without one of them is not chosen,
// and `doctor` says which it lacks. This folder knows no pass; the user of a format asserts that it
// is here (render/renderer.hpp), and a test compares the list with all formats that scenes use.
// Pure; any thread.
#pragma once

#include <volk.h>

#include <array>
#include <functional>
#include <string>

namespace neritic::gpu {

struct NeededFormat {
  VkFormat format;
  VkFormatFeatureFlags features;  // of optimal tiling
  const char* name;
};

inline constexpr VkFormatFeatureFlags kColorTarget = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
inline constexpr VkFormatFeatureFlags kTexture = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
inline constexpr VkFormatFeatureFlags kStorageImage = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
// Mips are made by blits, and textures are filtered.
inline constexpr VkFormatFeatureFlags kMippedTexture =
    kTexture | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_BLIT_SRC_BIT |
    VK_FORMAT_FEATURE_BLIT_DST_BIT;
// Every image may be read back or filled.
inline constexpr VkFormatFeatureFlags kCopied =
    VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;

inline constexpr std::array kNeededFormats{
    NeededFormat{VK_FORMAT_D32_SFLOAT,
                 VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | kTexture | kCopied, "D32_SFLOAT"},
    NeededFormat{VK_FORMAT_R16G16_SNORM, kColorTarget | kTexture | kCopied, "R16G16_SNORM"},
    NeededFormat{VK_FORMAT_R16G16_UINT, kColorTarget | kTexture | kCopied, "R16G16_UINT"},
    NeededFormat{VK_FORMAT_R8G8B8A8_UNORM, kColorTarget | kMippedTexture | kStorageImage | kCopied,
                 "R8G8B8A8_UNORM"},
    NeededFormat{VK_FORMAT_R8G8B8A8_SRGB, kMippedTexture | kCopied, "R8G8B8A8_SRGB"},
    NeededFormat{VK_FORMAT_R16G16B16A16_SFLOAT,
                 kColorTarget | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT | kTexture |
                     VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | kStorageImage | kCopied,
                 "R16G16B16A16_SFLOAT"},
    NeededFormat{VK_FORMAT_R32G32_SFLOAT, kColorTarget | kTexture | kStorageImage | kCopied,
                 "R32G32_SFLOAT"},
    NeededFormat{VK_FORMAT_R32_SFLOAT, kTexture | kStorageImage | kCopied, "R32_SFLOAT"},
    NeededFormat{VK_FORMAT_R32G32B32A32_SFLOAT, kTexture | kStorageImage | kCopied,
                 "R32G32B32A32_SFLOAT"},
};

// Whether a device that is chosen has all those features of the format.
constexpr bool is_needed(VkFormat format, VkFormatFeatureFlags features) {
  for (const NeededFormat& needed : kNeededFormats)
    if (needed.format == format) return (features & ~needed.features) == 0;
  return false;
}

// "format R16G16_SNORM as color attachment and sampled image, ..."; empty where a device that
// answers so has all. features_of: of a format's optimal tiling.
std::string missing_formats(const std::function<VkFormatFeatureFlags(VkFormat)>& features_of);

}  // namespace neritic::gpu
