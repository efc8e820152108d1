#include "engine/xr/desktop/shared_display.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/xr/offscreen.hpp"

namespace neritic::xr {
namespace {

constexpr VkFormat kSharedFormat = VK_FORMAT_R8G8B8A8_UNORM;  // of all layers

}  // namespace

Result<std::unique_ptr<SharedDisplay>> SharedDisplay::create(gpu::Device& device, Window& window,
                                                             const DesktopOptions& options) {
  const auto number = window.x_window();
  if (!number) return failure(ErrorCode::kUnsupported, "the window is no X window");
  std::unique_ptr<SharedDisplay> display(new SharedDisplay(device, window, options));
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
  return {};
}

// No frame sooner than a refresh of the screen after the last: the server does not pace them.
Result<DisplayFrame> SharedDisplay::begin_frame(const Pose&) {
  DisplayFrame frame;
  const WindowState state = window_.poll(waits_);
  frame.display_at_ns = now_ns();
  if (state == WindowState::kClosed) frame.verdict = FrameVerdict::kQuit;
  if (state != WindowState::kVisible) return frame;
  const TimeNs period_ns = std::llround(1e9 / window_.refresh_hz());
  if (const TimeNs early_ns = begun_ns_ + period_ns - now_ns(); early_ns > 0) {
    if (!waits_) return frame;
    std::this_thread::sleep_for(std::chrono::nanoseconds(early_ns));
  }
  frame.verdict = FrameVerdict::kDraw;
  frame.period_ns = period_ns;
  begun_ns_ = now_ns();
  frame.display_at_ns = begun_ns_ + *frame.period_ns;
  NERITIC_TRY_STATUS(fit(window_.width(), window_.height()));
  group_ = one_view(window_.width(), window_.height(), options_.vertical_fov_rad);
  frame.groups = {group_};
  return frame;
}

// Adds the pass that brings the drawn rectangles of an image to the host.
Status SharedDisplay::bring(graph::FrameGraph& graph, graph::ImageHandle image, std::size_t index) {
  Part& part = parts_[index];
  const std::string name = fmt::format("display texels {}", index);
  const VkDeviceSize bytes = VkDeviceSize{4} * part.width * part.height;
  if (part.texels.size() != bytes) {
    device_.wait_idle();  // a frame that was dropped may have written the old one
    NERITIC_TRY(part.texels,
                gpu::Buffer::create(device_, {name, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryUse::kReadback}));
  }
  std::vector<VkBufferImageCopy> regions;
  for (const draw2d::PixelRect& rect : part.drawn) {
    VkBufferImageCopy region{};
    region.bufferOffset = VkDeviceSize{4} * (VkDeviceSize{rect.top} * part.width + rect.left);
    region.bufferRowLength = part.width;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset = {static_cast<std::int32_t>(rect.left), static_cast<std::int32_t>(rect.top),
                          0};
    region.imageExtent = {rect.width, rect.height, 1};
    regions.push_back(region);
  }
  if (regions.empty()) return {};
  struct Data {
    graph::BufferHandle texels;
  };
  const graph::BufferHandle texels = graph.import_buffer(name, part.texels);
  const Data& pass = graph.add_pass<Data>(
      name,
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(image, graph::Access::kTransferRead);
        data.texels = builder.write(texels, graph::Access::kTransferWrite);
      },
      [image, regions = std::move(regions)](const Data& data, graph::PassContext& context) {
        vkCmdCopyImageToBuffer(context.cmd(), context.image(image).handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(data.texels).handle(),
                               static_cast<std::uint32_t>(regions.size()), regions.data());
      });
  graph.output(pass.texels, graph::Access::kHostRead);
  return {};
}

// False, and nothing added, where the host cannot compose the layers.
Result<bool> SharedDisplay::declare_parts(graph::FrameGraph& graph, const Pose& world_from_head,
                                          std::span<const Layer> layers) {
  std::vector<graph::ImageHandle> images;
  std::vector<Part> found;
  for (const Layer& layer : layers) {
    const auto* projection = std::get_if<ProjectionLayer>(&layer);
    const auto* panel = std::get_if<PanelLayer>(&layer);
    // The view's picture is below all panels.
    if (projection ? projection->group != 0 || !found.empty() : found.empty()) return false;
    const graph::ImageHandle image = projection ? projection->color : panel->image;
    if (!image) return false;
    const graph::ResourceDecl& decl = graph.declaration().resources[image.resource];
    if (decl.format != kSharedFormat || decl.layers != 1) return false;
    Part part{.width = decl.width, .height = decl.height};
    const std::vector<PanelPart> drawn = panel ? panel->parts : std::vector{PanelPart{}};
    for (const PanelPart& share : drawn) {
      const auto pixel = [](double at, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::lround(std::clamp(at, 0.0, 1.0) * size));
      };
      const std::uint32_t left = pixel(share.left, decl.width), top = pixel(share.top, decl.height);
      const std::uint32_t right = pixel(share.right, decl.width),
                          bottom = pixel(share.bottom, decl.height);
      if (right > left && bottom > top)
        part.drawn.push_back({left, top, right - left, bottom - top});
    }
    if (panel) {
      const auto corner = texel_on_pixel(*panel, group_, world_from_head, decl.width, decl.height);
      if (!corner) return false;
      part.corner = *corner;
    }
    images.push_back(image);
    found.push_back(std::move(part));
  }
  if (found.empty()) return false;
  if (parts_.size() < found.size()) parts_.resize(found.size());
  for (; used_ < found.size(); ++used_) {
    found[used_].texels = std::move(parts_[used_].texels);
    parts_[used_] = std::move(found[used_]);
    NERITIC_TRY_STATUS(bring(graph, images[used_], used_));
  }
  return true;
}

Result<ShownPicture> SharedDisplay::declare(graph::FrameGraph& graph, const Pose& world_from_head,
                                            std::span<const Layer> layers) {
  const gpu::ImageDesc& desc = image_.desc();
  used_ = 0;
  NERITIC_TRY(const bool by_host, declare_parts(graph, world_from_head, layers));
  // Nothing of it runs where nobody reads it.
  NERITIC_TRY(const graph::ImageHandle composed,
              compositor_->declare(graph, "display", graph.import_image(image_, {}), group_, 0,
                                   world_from_head, layers));
  if (!by_host) {
    if (parts_.empty()) parts_.resize(1);
    Part& whole = parts_[0];
    whole.width = desc.width;
    whole.height = desc.height;
    whole.drawn = {{0, 0, desc.width, desc.height}};
    NERITIC_TRY_STATUS(bring(graph, composed, 0));
    used_ = 1;
  }
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

void SharedDisplay::compose(std::span<std::byte> picture) const {
  const gpu::ImageDesc& desc = image_.desc();
  const std::span out(reinterpret_cast<std::uint8_t*>(picture.data()), picture.size());
  const Part& view = parts_[0];
  draw2d::upscale_to_bgra(view.texels.mapped<const std::uint8_t>(), view.width, view.height, out,
                          desc.width, desc.height);
  for (std::size_t i = 1; i < used_; ++i)
    for (const draw2d::PixelRect& rect : parts_[i].drawn)
      draw2d::lay_over(parts_[i].texels.mapped<const std::uint8_t>(), parts_[i].width, rect,
                       parts_[i].corner.left, parts_[i].corner.top, out, desc.width, desc.height);
}

Status SharedDisplay::end_frame(bool submitted) {
  if (!submitted) return {};
  NERITIC_TRY_STATUS(await_device());
  ++drawing_;
  NERITIC_TRY(const std::span<std::byte> picture, pictures_->next());
  compose(picture);
  return pictures_->show();
}

}  // namespace neritic::xr
