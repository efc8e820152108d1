#include "engine/xr/desktop/shared_display.hpp"

#include <cstring>
#include <thread>

#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/xr/offscreen.hpp"

namespace neritic::xr {
namespace {

constexpr VkFormat kSharedFormat = VK_FORMAT_B8G8R8A8_UNORM;  // in bytes the server's BGRX

}  // namespace

Result<std::unique_ptr<SharedDisplay>> SharedDisplay::create(gpu::Device& device, Window& window,
                                                             double vertical_fov_rad) {
  const auto number = window.x_window();
  if (!number) return failure(ErrorCode::kUnsupported, "the window is no X window");
  std::unique_ptr<SharedDisplay> display(new SharedDisplay(device, window, vertical_fov_rad));
  NERITIC_TRY(display->pictures_, SharedPictures::connect(*number));
  NERITIC_TRY(display->compositor_, Compositor::create(device, kSharedFormat));
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
  NERITIC_TRY_VK("vkCreateSemaphore (timeline)",
                 vkCreateSemaphore(device.handle(), &info, nullptr, &display->drawn_));
  device.name_object(VK_OBJECT_TYPE_SEMAPHORE, display->drawn_, "window picture drawn");
  return display;
}

SharedDisplay::~SharedDisplay() {
  device_.wait_idle();
  if (drawn_ != VK_NULL_HANDLE) vkDestroySemaphore(device_.handle(), drawn_, nullptr);
}

// Waits for the GPU: sizes change seldom.
Status SharedDisplay::fit(std::uint32_t width, std::uint32_t height) {
  if (image_ && image_.desc().width == width && image_.desc().height == height) return {};
  device_.wait_idle();
  NERITIC_TRY_STATUS(pictures_->resize(width, height));
  NERITIC_TRY(image_, gpu::Image::create(device_, {.name = "display",
                                                   .format = kSharedFormat,
                                                   .width = width,
                                                   .height = height,
                                                   .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                            VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                            VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
  NERITIC_TRY(texels_, gpu::Buffer::create(
                           device_, {"display texels", VkDeviceSize{4} * width * height,
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::kReadback}));
  return {};
}

// No frame sooner than a refresh of the screen after the last: the server does not pace them.
Result<DisplayFrame> SharedDisplay::begin_frame(const Pose&) {
  DisplayFrame frame;
  const WindowState state = window_.poll();
  frame.display_at_ns = now_ns();
  if (state == WindowState::kClosed) frame.verdict = FrameVerdict::kQuit;
  if (state != WindowState::kVisible) return frame;
  frame.verdict = FrameVerdict::kDraw;
  frame.period_ns = std::llround(1e9 / window_.refresh_hz());
  if (const TimeNs early_ns = begun_ns_ + *frame.period_ns - now_ns(); early_ns > 0)
    std::this_thread::sleep_for(std::chrono::nanoseconds(early_ns));
  begun_ns_ = now_ns();
  frame.display_at_ns = begun_ns_ + *frame.period_ns;
  NERITIC_TRY_STATUS(fit(window_.width(), window_.height()));
  group_ = one_view(window_.width(), window_.height(), vertical_fov_rad_);
  frame.groups = {group_};
  return frame;
}

Result<ShownPicture> SharedDisplay::declare(graph::FrameGraph& graph, const Pose& world_from_head,
                                            std::span<const Layer> layers) {
  const gpu::ImageDesc& desc = image_.desc();
  NERITIC_TRY(const graph::ImageHandle composed,
              compositor_->declare(graph, "display", graph.import_image(image_, {}), group_, 0,
                                   world_from_head, layers));
  struct Data {
    graph::BufferHandle texels;
  };
  const graph::BufferHandle texels = graph.import_buffer("display texels", texels_);
  const Data& pass = graph.add_pass<Data>(
      "display texels",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(composed, graph::Access::kTransferRead);
        data.texels = builder.write(texels, graph::Access::kTransferWrite);
      },
      [composed](const Data& data, graph::PassContext& context) {
        const gpu::Image& image = context.image(composed);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {image.desc().width, image.desc().height, 1};
        vkCmdCopyImageToBuffer(context.cmd(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(data.texels).handle(), 1, &region);
      });
  graph.output(pass.texels, graph::Access::kHostRead);
  return ShownPicture{composed, desc.format, desc.width, desc.height, true};
}

gpu::Frames::SubmitSync SharedDisplay::sync() const {
  return {.signal = drawn_, .signal_value = drawing_};
}

Status SharedDisplay::await_device() const {
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &drawn_;
  info.pValues = &drawing_;
  NERITIC_TRY_VK("vkWaitSemaphores",
                 vkWaitSemaphores(device_.handle(), &info, device_.wait_limit_ns()));
  return {};
}

Status SharedDisplay::end_frame(bool submitted) {
  if (!submitted) return {};
  NERITIC_TRY_STATUS(await_device());
  ++drawing_;
  NERITIC_TRY(const std::span<std::byte> picture, pictures_->next());
  const auto drawn = texels_.mapped<std::byte>();
  std::memcpy(picture.data(), drawn.data(), picture.size());
  return pictures_->show();
}

}  // namespace neritic::xr
