// Inside engine/graph: words for Vulkan's flags in dumps. Pure; any thread.
#pragma once

#include <volk.h>

#include <string>

#include "engine/gpu/image_range.hpp"

namespace neritic::graph {

// "compute+fragment"; "none" for 0; bits without a word in hex.
std::string stage_names(VkPipelineStageFlags2 stages);
std::string access_names(VkAccessFlags2 access);
std::string layout_name(VkImageLayout layout);
// "mip 2", "mips 0 to 3, layer 1": of a range with concrete counts.
std::string range_name(const gpu::ImageRange& range);
// Vulkan's own name without VK_FORMAT_; the number for formats that the engine does not use.
std::string format_name(VkFormat format);

}  // namespace neritic::graph
