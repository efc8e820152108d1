// Brings layers to an image of a display that has no compositor of its own: a copy of the
// projection layer, scaled to the image, then the panels as flat rectangles in perspective. Each is
// a pass; without panels there is one only. Rendering thread.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/xr/display.hpp"

namespace neritic::xr {

// Adds a pass that copies an image, scaled where the sizes differ, and gives what it wrote.
graph::ImageHandle copy_image(graph::FrameGraph& graph, const std::string& pass,
                              graph::ImageHandle from, graph::ImageHandle to);
// The same of depth images, which are not scaled: `to` is at least as large, and what it has beyond
// the right and lower edge of `from` stays undefined.
graph::ImageHandle copy_depth(graph::FrameGraph& graph, const std::string& pass,
                              graph::ImageHandle from, graph::ImageHandle to);

// The projection layer of a group; nullptr: none.
const ProjectionLayer* projection_of(std::span<const Layer> layers, std::size_t group);

// The pixel of a picture of the only view where a panel's left upper texel lies, if its texels lie
// on pixels: to a hundredth of one. size: of the panel's image.
struct PanelCorner {
  int left = 0, top = 0;
};
std::optional<PanelCorner> texel_on_pixel(const PanelLayer& panel, const ViewGroup& group,
                                          const Pose& world_from_head, std::uint32_t width,
                                          std::uint32_t height);

class Compositor {
 public:
  // format: of the images it will compose. The device must outlive it.
  static Result<std::unique_ptr<Compositor>> create(gpu::Device& device, VkFormat format);
  // Adds the passes of one group; target has an array layer a view and is written completely (black
  // without a projection layer). Gives the composed image. name: in front of the passes' names.
  Result<graph::ImageHandle> declare(graph::FrameGraph& graph, const std::string& name,
                                     graph::ImageHandle target, const ViewGroup& group,
                                     std::size_t group_index, const Pose& world_from_head,
                                     std::span<const Layer> layers);

 private:
  Compositor(gpu::Device& device, VkFormat format) : device_(device), format_(format) {}
  Result<const gpu::Pipeline*> pipeline_for(std::uint32_t views, bool texels);
  gpu::Device& device_;
  VkFormat format_;
  gpu::Sampler sampler_;
  // By number of views, and whether panels lie texel on pixel.
  std::map<std::pair<std::uint32_t, bool>, gpu::Pipeline> pipelines_;
};

}  // namespace neritic::xr
