// See names.hpp: tables of the flags that accesses can produce.
#include "engine/graph/names.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

namespace neritic::graph {
namespace {

struct Word {
  std::uint64_t bit;
  const char* name;
};

constexpr Word kStages[] = {
    {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "index"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "attribute"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early-depth"},
    {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late-depth"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "host"},
    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
};
constexpr Word kAccesses[] = {
    {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, "indirect-read"},
    {VK_ACCESS_2_INDEX_READ_BIT, "index-read"},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "attribute-read"},
    {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled-read"},
    {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "storage-read"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "storage-write"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color-read"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color-write"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth-read"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth-write"},
    {VK_ACCESS_2_TRANSFER_READ_BIT, "transfer-read"},
    {VK_ACCESS_2_TRANSFER_WRITE_BIT, "transfer-write"},
    {VK_ACCESS_2_HOST_READ_BIT, "host-read"},
    {VK_ACCESS_2_HOST_WRITE_BIT, "host-write"},
    {VK_ACCESS_2_MEMORY_READ_BIT, "read"},
    {VK_ACCESS_2_MEMORY_WRITE_BIT, "write"},
};
constexpr Word kLayouts[] = {
    {VK_IMAGE_LAYOUT_UNDEFINED, "undefined"},
    {VK_IMAGE_LAYOUT_GENERAL, "general"},
    {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, "color"},
    {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, "depth"},
    {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, "depth-read"},
    {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, "shader-read"},
    {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "transfer-src"},
    {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "transfer-dst"},
    {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, "present"},
};
#define NERITIC_FORMAT(name) \
  { VK_FORMAT_##name, #name }
constexpr Word kFormats[] = {
    NERITIC_FORMAT(R8_UNORM),
    NERITIC_FORMAT(R8G8_UNORM),
    NERITIC_FORMAT(R8G8B8A8_UNORM),
    NERITIC_FORMAT(R8G8B8A8_SRGB),
    NERITIC_FORMAT(B8G8R8A8_UNORM),
    NERITIC_FORMAT(B8G8R8A8_SRGB),
    NERITIC_FORMAT(A2B10G10R10_UNORM_PACK32),
    NERITIC_FORMAT(B10G11R11_UFLOAT_PACK32),
    NERITIC_FORMAT(R16_UINT),
    NERITIC_FORMAT(R16_SFLOAT),
    NERITIC_FORMAT(R16G16_UINT),
    NERITIC_FORMAT(R16G16_UNORM),
    NERITIC_FORMAT(R16G16_SNORM),
    NERITIC_FORMAT(R16G16_SFLOAT),
    NERITIC_FORMAT(R16G16B16A16_UNORM),
    NERITIC_FORMAT(R16G16B16A16_SFLOAT),
    NERITIC_FORMAT(R32_UINT),
    NERITIC_FORMAT(R32_SINT),
    NERITIC_FORMAT(R32_SFLOAT),
    NERITIC_FORMAT(R32G32_UINT),
    NERITIC_FORMAT(R32G32_SFLOAT),
    NERITIC_FORMAT(R32G32B32A32_UINT),
    NERITIC_FORMAT(R32G32B32A32_SFLOAT),
    NERITIC_FORMAT(D16_UNORM),
    NERITIC_FORMAT(D32_SFLOAT),
    NERITIC_FORMAT(D24_UNORM_S8_UINT),
    NERITIC_FORMAT(D32_SFLOAT_S8_UINT),
};
#undef NERITIC_FORMAT

std::string join_bits(std::uint64_t bits, std::span<const Word> words) {
  if (bits == 0) return "none";
  std::string text;
  for (const Word& word : words) {
    if ((bits & word.bit) == 0) continue;
    if (!text.empty()) text += '+';
    text += word.name;
    bits &= ~word.bit;
  }
  if (bits != 0) text += fmt::format("{}0x{:x}", text.empty() ? "" : "+", bits);
  return text;
}

std::string find_value(std::uint64_t value, std::span<const Word> words) {
  for (const Word& word : words)
    if (word.bit == value) return word.name;
  return std::to_string(value);
}

}  // namespace

std::string stage_names(VkPipelineStageFlags2 stages) {
  return join_bits(stages, kStages);
}
std::string access_names(VkAccessFlags2 access) {
  return join_bits(access, kAccesses);
}
std::string layout_name(VkImageLayout layout) {
  return find_value(static_cast<std::uint64_t>(layout), kLayouts);
}
std::string range_name(const gpu::ImageRange& range) {
  const auto part = [](const char* what, std::uint32_t first, std::uint32_t count) {
    return count == 1 ? fmt::format("{} {}", what, first)
                      : fmt::format("{}s {} to {}", what, first, first + count - 1);
  };
  return part("mip", range.mip, range.mips) + ", " + part("layer", range.layer, range.layers);
}
std::string format_name(VkFormat format) {
  return find_value(static_cast<std::uint64_t>(format), kFormats);
}

}  // namespace neritic::graph
