#include "testbed/sensors/readback.hpp"

namespace neritic::testbed {

Result<Readback> ReadbackPool::declare(graph::FrameGraph& graph, gpu::Device& device,
                                       const std::string& name, graph::ImageHandle image,
                                       VkFormat format, std::uint32_t width, std::uint32_t height,
                                       std::uint32_t layers) {
  const VkDeviceSize size = VkDeviceSize{gpu::texel_bytes(format)} * width * height * layers;
  const auto make = [&]() -> Result<gpu::Buffer> {
    device.wait_idle();  // a frame in flight may still write the buffer that this one replaces
    return gpu::Buffer::create(device, {name + " readback", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                        gpu::MemoryUse::kReadback});
  };
  NERITIC_TRY(Readback buffer,
              buffers_[name].take(
                  name, [&](const auto& old) { return old.size() == size; }, make));
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
  return buffer;
}

}  // namespace neritic::testbed
