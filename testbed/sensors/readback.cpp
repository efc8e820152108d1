#include "testbed/sensors/readback.hpp"

namespace neritic::testbed {

Result<const gpu::Buffer*> ReadbackPool::declare(graph::FrameGraph& graph, gpu::Device& device,
                                                 const std::string& name, graph::ImageHandle image,
                                                 VkFormat format, std::uint32_t width,
                                                 std::uint32_t height, std::uint32_t layers) {
  const VkDeviceSize size = VkDeviceSize{gpu::texel_bytes(format)} * width * height * layers;
  std::unique_ptr<gpu::Buffer>& buffer = buffers_[name];
  if (!buffer || buffer->size() != size) {
    NERITIC_TRY(auto fresh, gpu::Buffer::create(
                                device, {name + " readback", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                         gpu::MemoryUse::kReadback}));
    buffer = std::make_unique<gpu::Buffer>(std::move(fresh));
  }
  struct Data {
    graph::BufferHandle target;
  };
  const graph::BufferHandle imported = graph.import_buffer(name + " readback", *buffer);
  const bool depth = gpu::is_depth_format(format);
  const Data& pass = graph.add_pass<Data>(
      name + " readback",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(image, graph::Access::kTransferRead);
        data.target = builder.write(imported, graph::Access::kTransferWrite);
      },
      [image, depth, width, height, layers](const Data& data, graph::PassContext& context) {
        VkBufferImageCopy region{};
        region.imageSubresource = {
            static_cast<VkImageAspectFlags>(depth ? VK_IMAGE_ASPECT_DEPTH_BIT
                                                  : VK_IMAGE_ASPECT_COLOR_BIT),
            0, 0, layers};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(context.cmd(), context.image(image).handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(data.target).handle(), 1, &region);
      });
  graph.output(pass.target, graph::Access::kHostRead);
  return buffer.get();
}

}  // namespace neritic::testbed
