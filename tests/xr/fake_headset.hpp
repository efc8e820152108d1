// A headset without hardware, for tests: it tracks a head in a stage, has two or four views of its
// own optics, asks to make the Vulkan objects itself, and keeps each layer in images of its own, as
// an OpenXR runtime's swapchains do, instead of composing them.
#pragma once

#include <algorithm>
#include <functional>
#include <map>

#include "engine/gpu/device.hpp"
#include "engine/xr/compositor.hpp"

namespace neritic::xr {

class FakeHeadset final : public Display {
 public:
  // The layers and pose that one frame ended with.
  struct Ended {
    std::vector<std::size_t> projections;  // groups
    std::vector<bool> with_depth;          // by projection
    std::vector<PanelLayer> panels;        // their images are of a graph that is gone
    Pose world_from_head;
  };
  struct Options {
    std::vector<ViewGroup> groups;
    std::function<Pose(std::uint64_t frame)> stage_from_head;
    std::function<bool(std::uint64_t frame)> worn;  // else nobody would see the frame
    TimeNs period_ns = 11'111'111;
    std::uint64_t fails_at = UINT64_MAX;                        // the frame whose layers it refuses
    std::function<TimeNs(std::uint64_t frame)> told_period_ns;  // else period_ns
  };

  static Result<std::unique_ptr<FakeHeadset>> create(gpu::Device& device, Options options) {
    std::unique_ptr<FakeHeadset> made(new FakeHeadset(device, std::move(options)));
    for (const ViewGroup& group : made->options_.groups) {
      const auto views = static_cast<std::uint32_t>(group.views.size());
      NERITIC_TRY(gpu::Image color, made->image("headset color", VK_FORMAT_R8G8B8A8_UNORM,
                                                group.width, group.height, views));
      NERITIC_TRY(gpu::Image depth, made->image("headset depth", VK_FORMAT_D32_SFLOAT, group.width,
                                                group.height, views));
      made->colors_.push_back(std::move(color));
      made->depths_.push_back(std::move(depth));
    }
    return made;
  }
  // Makes the device as a headset's runtime demands; counts its creation calls in `calls`.
  static void require(gpu::DeviceOptions& options, int& calls) {
    options.maker.instance = [&calls](const VkInstanceCreateInfo& info, VkInstance* instance) {
      ++calls;
      return vkCreateInstance(&info, nullptr, instance);
    };
    options.maker.physical = [&calls](VkInstance instance, VkPhysicalDevice* device) {
      ++calls;
      std::uint32_t one = 1;
      const VkResult result = vkEnumeratePhysicalDevices(instance, &one, device);
      return result == VK_INCOMPLETE ? VK_SUCCESS : result;
    };
    options.maker.device = [&calls](VkPhysicalDevice physical, const VkDeviceCreateInfo& info,
                                    VkDevice* device) {
      ++calls;
      return vkCreateDevice(physical, &info, nullptr, device);
    };
  }

  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override {
    DisplayFrame frame;
    frame.verdict =
        !options_.worn || options_.worn(frame_) ? FrameVerdict::kDraw : FrameVerdict::kHidden;
    frame.display_at_ns = static_cast<TimeNs>(frame_) * options_.period_ns;
    frame.period_ns =
        options_.told_period_ns ? options_.told_period_ns(frame_) : options_.period_ns;
    frame.world_from_head = world_from_stage * options_.stage_from_head(frame_);
    frame.groups = options_.groups;
    ++frame_;
    return frame;
  }
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override {
    if (begun_frames() == options_.fails_at + 1) return failure(ErrorCode::kIo, "unplugged");
    Ended ended;
    ended.world_from_head = world_from_head;
    ShownPicture shown{
        {}, VK_FORMAT_R8G8B8A8_UNORM, options_.groups[0].width, options_.groups[0].height, true};
    for (const Layer& layer : layers) {
      if (const auto* panel = std::get_if<PanelLayer>(&layer)) {
        ended.panels.push_back(*panel);
        continue;
      }
      const auto& projection = std::get<ProjectionLayer>(layer);
      const std::size_t group = projection.group;
      ended.projections.push_back(group);
      ended.with_depth.push_back(bool(projection.depth));
      const graph::ImageHandle color =
          copy_image(graph, fmt::format("headset color {}", group), projection.color,
                     graph.import_image(colors_[group], {}));
      graph.output(color, graph::Access::kTransferRead);
      if (group == 0) shown.image = color;
      if (projection.depth)
        graph.output(copy_depth(graph, fmt::format("headset depth {}", group), projection.depth,
                                graph.import_image(depths_[group], {})),
                     graph::Access::kTransferRead);
    }
    pending_ = std::move(ended);
    return shown;
  }
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame(bool) override {
    ended_.push_back(std::exchange(pending_, {}));
    return {};
  }
  ActionValues take_actions(const InputClaims&) override { return {}; }

  const gpu::Image& color(std::size_t group) const { return colors_[group]; }
  const gpu::Image& depth(std::size_t group) const { return depths_[group]; }
  std::uint64_t begun_frames() const { return frame_; }
  const std::vector<Ended>& ended() const { return ended_; }  // by frame

 private:
  FakeHeadset(gpu::Device& device, Options options)
      : device_(device), options_(std::move(options)) {}
  Result<gpu::Image> image(const char* name, VkFormat format, std::uint32_t width,
                           std::uint32_t height, std::uint32_t layers) const {
    return gpu::Image::create(
        device_, {.name = name,
                  .format = format,
                  .width = width,
                  .height = height,
                  .layers = layers,
                  .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                           VK_IMAGE_USAGE_SAMPLED_BIT,
                  .array_view = true});
  }
  gpu::Device& device_;
  Options options_;
  std::vector<gpu::Image> colors_, depths_;  // by group
  Ended pending_;
  std::vector<Ended> ended_;
  std::uint64_t frame_ = 0;
};

// Two eyes, 64 mm apart: each sees more to its outer side.
inline ViewGroup eye_pair(std::uint32_t width, std::uint32_t height, double scale = 1.0) {
  return {
      width,
      height,
      {{{{-0.032, 0, 0}, Quat(1, 0, 0, 0)}, {-1.2 * scale, 0.8 * scale, -1.1 * scale, 0.9 * scale}},
       {{{0.032, 0, 0}, Quat(1, 0, 0, 0)},
        {-0.8 * scale, 1.2 * scale, -1.1 * scale, 0.9 * scale}}}};
}

}  // namespace neritic::xr
