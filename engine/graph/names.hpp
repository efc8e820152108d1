// Inside engine/graph: words for Vulkan's flags in dumps. Pure; any thread.
#pragma once

#include <volk.h>

#include <string>

namespace neritic::graph {

// "compute+fragment"; "none" for 0; bits without a word in hex.
std::string stage_names(VkPipelineStageFlags2 stages);
std::string access_names(VkAccessFlags2 access);
std::string layout_name(VkImageLayout layout);
// Vulkan's own name without VK_FORMAT_; the number for formats the engine has no use for.
std::string format_name(VkFormat format);

}  // namespace neritic::graph
