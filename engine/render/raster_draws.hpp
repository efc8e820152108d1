// Draws with their pipelines looked up, ready to record, and what the raster passes share. Private
// to the renderer.
#pragma once

#include <span>
#include <vector>

#include "engine/render/renderer.hpp"

namespace neritic::render {

struct PreparedDraw {
  Draw draw;
  std::span<const IndexRange> ranges;  // the draw list's
  const gpu::Pipeline* pipeline = nullptr;
  bool larger = false;      // uses the stream of where instances are drawn
  bool surface = false;     // uses stream 1, the material and push constants
  bool both_sides = false;  // no face culling
  const GpuMaterial* material = nullptr;
};

struct Renderer::PreparedDraws {
  std::vector<PreparedDraw> draws;
};

// The draws of one rendering, which shows the views of its mask.
struct Renderer::MaskedDraws {
  std::uint32_t view_mask = 0;
  PreparedDraws prepared;
};

VkRenderingAttachmentInfo attachment(const gpu::Image& image, VkImageLayout layout,
                                     VkAttachmentLoadOp load);

// The view masks that a set of layers is drawn with, one rendering each: all at once, except where
// the device clips into the wrong view.
std::vector<std::uint32_t> view_masks_of(std::uint32_t layers, const gpu::Device& device);

// Begins a rendering of the whole picture, viewport and scissor set.
void begin_rendering(VkCommandBuffer cmd, const GBuffer& gbuffer, std::uint32_t view_mask,
                     std::span<const VkRenderingAttachmentInfo> colors,
                     const VkRenderingAttachmentInfo& depth);

// Workgroups along a side of this number of pixels.
constexpr std::uint32_t groups(std::uint32_t size) {
  return (size + shared::kShadeGroup - 1) / shared::kShadeGroup;
}

gpu::BoundResource bound_slice(std::uint32_t binding, const gpu::UploadSlice& slice);

}  // namespace neritic::render
