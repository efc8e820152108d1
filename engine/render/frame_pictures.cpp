#include "engine/render/frame_pictures.hpp"

#include "engine/core/check.hpp"
#include "engine/render/halved.hpp"

namespace neritic::render {
namespace {

// A picture and all its mips: on a wrist far away several texels fall into a pixel.
std::vector<ImageU8> mips_of(const ImageU8& picture, std::uint32_t count) {
  std::vector<ImageU8> mips{picture};
  while (mips.size() < count) mips.push_back(halved(mips.back(), true));
  return mips;
}

void record_upload(const std::vector<ImageU8>& mips, const gpu::Image& image,
                   gpu::Commands& commands) {
  for (std::uint32_t mip = 0; mip < mips.size(); ++mip) {
    const gpu::UploadSlice texels = commands.upload(std::span<const std::uint8_t>(mips[mip].data));
    VkBufferImageCopy region{};
    region.bufferOffset = texels.offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
    region.imageExtent = {mips[mip].width, mips[mip].height, 1};
    vkCmdCopyBufferToImage(commands.handle(), texels.buffer, image.handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  }
}

}  // namespace

graph::ImageHandle FramePictures::image(std::uint32_t picture) {
  graph::ImageHandle& handle = images_[picture];
  if (handle) return handle;
  GpuPicture& shown = scene_.pictures()[picture];
  // As its creation and the last pass that drew it left it.
  handle = graph_.import_image(*shown.image, {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  if (!source_) return handle;
  const scene::ObjectPictures::Picture now = source_->picture(shown.place);
  if (now.number == shown.number) return handle;
  const gpu::ImageDesc& desc = shown.image->desc();
  NERITIC_CHECK(now.pixels && now.pixels->channels == 4 && now.pixels->width == desc.width &&
                    now.pixels->height == desc.height,
                "{}: a picture of another size", desc.name);
  struct Data {
    graph::ImageHandle image;
  };
  handle = graph_
               .add_pass<Data>(
                   desc.name,
                   [&](graph::PassBuilder& builder, Data& data) {
                     data.image = builder.write(handle, graph::Access::kTransferWrite);
                   },
                   [mips = mips_of(*now.pixels, desc.mips), number = now.number, &shown](
                       const Data& data, graph::PassContext& context) {
                     record_upload(mips, context.image(data.image), context.commands);
                     shown.number = number;
                   })
               .image;
  return handle;
}

}  // namespace neritic::render
