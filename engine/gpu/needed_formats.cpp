#include "engine/gpu/needed_formats.hpp"

namespace neritic::gpu {
namespace {

struct FeatureName {
  VkFormatFeatureFlags feature;
  const char* name;
};
constexpr std::array kFeatureNames{
    FeatureName{VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth attachment"},
    FeatureName{VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, "color attachment"},
    FeatureName{VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blended color attachment"},
    FeatureName{VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "sampled image"},
    FeatureName{VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT, "filtered image"},
    FeatureName{VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "storage image"},
    FeatureName{VK_FORMAT_FEATURE_BLIT_SRC_BIT, "source of blits"},
    FeatureName{VK_FORMAT_FEATURE_BLIT_DST_BIT, "target of blits"},
    FeatureName{VK_FORMAT_FEATURE_TRANSFER_SRC_BIT, "source of copies"},
    FeatureName{VK_FORMAT_FEATURE_TRANSFER_DST_BIT, "target of copies"},
};

}  // namespace

std::string missing_formats(const std::function<VkFormatFeatureFlags(VkFormat)>& features_of) {
  std::string missing;
  for (const NeededFormat& needed : kNeededFormats) {
    const VkFormatFeatureFlags lacks = needed.features & ~features_of(needed.format);
    if (lacks == 0) continue;
    missing += (missing.empty() ? "format " : ", format ") + std::string(needed.name) + " as ";
    std::string uses;
    for (const FeatureName& row : kFeatureNames)
      if (lacks & row.feature) uses += (uses.empty() ? "" : " and ") + std::string(row.name);
    missing += uses;
  }
  return missing;
}

}  // namespace neritic::gpu
