// The pixels that an offscreen display shows for one frame of layers, read back to the host.
#pragma once

#include <array>
#include <vector>

#include "engine/xr/offscreen.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::xr {

using Texel = std::array<int, 4>;

// RGBA8, layer by layer.
struct Shown {
  std::uint32_t width = 0, height = 0;
  std::vector<std::byte> texels;
  Texel at(std::uint32_t x, std::uint32_t y, std::uint32_t layer = 0) const {
    Texel out{};
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = static_cast<int>(texels[((std::size_t{layer} * height + y) * width + x) * 4 + c]);
    return out;
  }
};

// All layers of an image in TRANSFER_SRC_OPTIMAL, one after the other.
inline std::vector<std::byte> read_layers(gpu::Device& device, const gpu::Image& image) {
  std::vector<std::byte> all;
  for (std::uint32_t i = 0; i < image.desc().layers; ++i) {
    const auto layer =
        gpu::read_image(device, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, i).value();
    all.insert(all.end(), layer.begin(), layer.end());
  }
  return all;
}

// Runs a graph and reads the display's picture of a group.
inline Shown run_and_read(gpu::Device& device, graph::FrameGraph& graph,
                          const gpu::Image& picture) {
  Shown shown{picture.desc().width, picture.desc().height, {}};
  const auto frames = gpu::Frames::create(device, 1).value();
  graph::Executor executor(*frames);
  gpu::Commands* commands = frames->begin().value();
  const auto plan = executor.run(graph, *commands);
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  EXPECT_TRUE(frames->wait(frames->submit().value()).ok());
  shown.texels = read_layers(device, picture);
  return shown;
}

// An image of one colour in each of its layers, as a pass of its own would have drawn it.
inline graph::ImageHandle flat_image(graph::FrameGraph& graph, const std::string& name,
                                     std::uint32_t width, std::uint32_t height,
                                     std::vector<std::array<float, 4>> colors) {
  struct Data {
    graph::ImageHandle image;
  };
  const auto layers = static_cast<std::uint32_t>(colors.size());
  return graph
      .add_pass<Data>(
          name,
          [&](graph::PassBuilder& builder, Data& data) {
            data.image = builder.write(
                builder.create_image(name, {VK_FORMAT_R8G8B8A8_UNORM, width, height, layers}),
                graph::Access::kTransferWrite);
          },
          [colors](const Data& data, graph::PassContext& context) {
            for (std::uint32_t i = 0; i < colors.size(); ++i) {
              const VkClearColorValue color{
                  {colors[i][0], colors[i][1], colors[i][2], colors[i][3]}};
              const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, i, 1};
              vkCmdClearColorImage(context.cmd(), context.image(data.image).handle(),
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &range);
            }
          })
      .image;
}

}  // namespace neritic::xr
