#include "testbed/view/dive_fan.hpp"

#include <algorithm>

#include "shaders.hpp"
#include "shared/sonar_fan.h"

namespace neritic::testbed {
namespace {

constexpr std::uint32_t kLongestSide_px = 420;
constexpr std::uint32_t kCellsLookedAt = 65536;  // for the full scale; more add nothing to see
constexpr float kQuantile = 0.995f;              // as the panel picture's full scale
constexpr float kFollow = 0.25f;
constexpr float kGamma = 0.6f;  // as the panel picture's

constexpr std::uint32_t groups(std::uint32_t pixels) {
  return (pixels + shared::kSonarFanGroup - 1) / shared::kSonarFanGroup;
}

// grid: its limits are those shown, its bins those of the whole ping; part: the share of the
// range's bins that the limits show.
shared::SonarFanPush push_of(const FanShape& shape, const sonar::BeamGrid& grid, double part,
                             bool is_power, bool is_opaque, double gain) {
  const sonar::Limits& l = grid.limits;
  const double half = (l.azimuth_max_rad - l.azimuth_min_rad) / 2.0;
  return {.width = shape.width,
          .height = shape.height,
          .n_range = static_cast<float>(part * grid.bins.range),
          .n_azimuth = grid.bins.azimuth,
          .left_m = static_cast<float>(shape.left_m),
          .top_m = static_cast<float>(shape.top_m),
          .m_per_px = static_cast<float>(shape.m_per_px),
          .range_min_m = static_cast<float>(l.range_min_m),
          .bins_per_m = static_cast<float>(part / grid.range_step_m()),
          .azimuth_middle_rad = static_cast<float>((l.azimuth_min_rad + l.azimuth_max_rad) / 2.0),
          .azimuth_half_rad = static_cast<float>(half),
          .bins_per_rad = static_cast<float>(1.0 / grid.azimuth_step_rad()),
          .gamma = kGamma,
          .gain = static_cast<float>(gain),
          .is_power = is_power,
          .is_opaque = is_opaque};
}

}  // namespace

Vec2 FanShape::place(double range_m, double bearing_rad) const {
  const double x_px = (range_m * std::sin(bearing_rad) - left_m) / m_per_px;
  const double y_px = (top_m - range_m * std::cos(bearing_rad)) / m_per_px;
  return {x_px / width, y_px / height};
}

FanShape fan_shape(const sonar::Limits& l, std::uint32_t longest_side_px) {
  constexpr int kSteps = 256;  // along the arcs
  double left = 1e300, right = -1e300, near = 1e300, far = -1e300;
  for (int i = 0; i <= kSteps; ++i) {
    const double bearing = glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, double(i) / kSteps);
    for (const double range_m : {l.range_min_m, l.range_max_m}) {
      left = std::min(left, range_m * std::sin(bearing));
      right = std::max(right, range_m * std::sin(bearing));
      near = std::min(near, range_m * std::cos(bearing));
      far = std::max(far, range_m * std::cos(bearing));
    }
  }
  FanShape shape;
  shape.left_m = left;
  shape.top_m = far;
  shape.m_per_px = std::max(right - left, far - near) / longest_side_px;
  const auto pixels = [&](double metres) {
    return std::max(1u, static_cast<std::uint32_t>(std::ceil(metres / shape.m_per_px - 1e-6)));
  };
  shape.width = pixels(right - left);
  shape.height = pixels(far - near);
  return shape;
}

Result<std::unique_ptr<SonarFans>> SonarFans::create(gpu::Device& device, bool opaque) {
  std::unique_ptr<SonarFans> fans(new SonarFans(device, opaque));
  gpu::ComputePipelineDesc scale;
  scale.name = "sonar fan scale";
  scale.code = shaders::kSonarFanScaleComp;
  scale.layout.bindings = {{shared::kSonarFanSums}, {shared::kSonarFanScale}};
  scale.layout.push_constant_bytes = sizeof(shared::SonarFanScalePush);
  NERITIC_TRY(fans->scale_, gpu::Pipeline::create(device, scale));
  gpu::ComputePipelineDesc draw;
  draw.name = "sonar fan";
  draw.code = shaders::kSonarFanComp;
  draw.layout.bindings = {{shared::kSonarFanSums},
                          {shared::kSonarFanScale},
                          {shared::kSonarFanPicture, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
  draw.layout.push_constant_bytes = sizeof(shared::SonarFanPush);
  NERITIC_TRY(fans->draw_, gpu::Pipeline::create(device, draw));
  return fans;
}

void SonarFans::show(double gain, double range_part) {
  gain_ = gain;
  range_part_ = range_part;
}

// The shape and the picture for the part of the range that is shown.
Status SonarFans::shape_fan(Fan& fan) {
  if (fan.picture) device_.wait_idle();  // a frame in flight may show it; ranges change seldom
  fan.range_part = range_part_;
  sonar::Limits& shown = fan.grid.limits;
  shown = fan.limits;
  shown.range_max_m = glm::mix(shown.range_min_m, shown.range_max_m, range_part_);
  fan.shape = fan_shape(shown, kLongestSide_px);
  NERITIC_TRY(fan.picture, gpu::Image::create(device_, {.name = fan.name + " fan",
                                                        .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                        .width = fan.shape.width,
                                                        .height = fan.shape.height,
                                                        .usage = VK_IMAGE_USAGE_STORAGE_BIT |
                                                                 VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                                        .array_view = true}));
  return {};
}

Result<SonarFans::Fan*> SonarFans::fan_of(std::size_t sonar, const std::string& name,
                                          const sonar::BeamGrid& grid) {
  std::unique_ptr<Fan>& slot = fans_[sonar];
  if (slot) {
    if (slot->range_part != range_part_) NERITIC_TRY_STATUS(shape_fan(*slot));
    return slot.get();
  }
  auto fan = std::make_unique<Fan>();
  fan->name = name;
  fan->grid = grid;
  fan->limits = grid.limits;
  NERITIC_TRY_STATUS(shape_fan(*fan));
  NERITIC_TRY(
      fan->sums,
      gpu::Buffer::create(
          device_,
          {.name = name + " fan sums",
           .size = std::size_t{grid.bins.range} * grid.bins.azimuth * sizeof(std::uint32_t),
           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  NERITIC_TRY(fan->scale,
              gpu::Buffer::create(device_, {.name = name + " fan scale",
                                            .size = sizeof(float),
                                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  const float none = 0.0f;
  NERITIC_TRY_STATUS(gpu::upload_buffer(device_, fan->scale, std::as_bytes(std::span(&none, 1))));
  slot = std::move(fan);
  return slot.get();
}

graph::BufferHandle SonarFans::declare_scale(graph::FrameGraph& graph, const std::string& name,
                                             const SensorFrame::Sonar& ping, const Fan& fan) {
  const sonar::Bins& bins = ping.grid.bins;
  const std::uint32_t cells = bins.range * bins.azimuth;
  const graph::BufferHandle scale = graph.import_buffer(name + " fan scale", fan.scale);
  struct Data {
    graph::BufferHandle sums, scale;
  };
  return graph
      .add_pass<Data>(
          name + " fan scale",
          [&](graph::PassBuilder& builder, Data& data) {
            data.sums = ping.image;
            builder.read(ping.image, graph::Access::kStorageReadCompute);
            data.scale = builder.write(scale, graph::Access::kStorageWriteCompute);
          },
          [this, cells, is_power = ping.is_float](const Data& data, graph::PassContext& context) {
            const shared::SonarFanScalePush push{
                cells, (cells + kCellsLookedAt - 1) / kCellsLookedAt, kQuantile, kFollow, is_power};
            gpu::Commands& commands = context.commands;
            commands.bind_pipeline(scale_);
            commands.bind(
                scale_,
                {gpu::bound_buffer(shared::kSonarFanSums, context.buffer(data.sums).handle()),
                 gpu::bound_buffer(shared::kSonarFanScale, context.buffer(data.scale).handle())});
            commands.push(scale_, push);
            commands.dispatch(1);
          })
      .scale;
}

void SonarFans::begin_frame() {
  for (auto& [sonar, fan] : fans_) fan->drawn = {};
}

// The sums of the newest ping, in a buffer that stays.
graph::BufferHandle SonarFans::declare_sums(graph::FrameGraph& graph,
                                            const SensorFrame::Sonar& ping, Fan& fan) {
  const graph::BufferHandle kept = graph.import_buffer(fan.name + " fan sums", fan.sums);
  struct Data {
    graph::BufferHandle from, to;
  };
  return graph
      .add_pass<Data>(
          fan.name + " fan sums",
          [&](graph::PassBuilder& builder, Data& data) {
            data.from = ping.image;
            builder.read(ping.image, graph::Access::kTransferRead);
            data.to = builder.write(kept, graph::Access::kTransferWrite);
          },
          [bytes = fan.sums.size()](const Data& data, graph::PassContext& context) {
            const VkBufferCopy region{0, 0, bytes};
            vkCmdCopyBuffer(context.commands.handle(), context.buffer(data.from).handle(),
                            context.buffer(data.to).handle(), 1, &region);
          })
      .to;
}

Status SonarFans::declare(graph::FrameGraph& graph, const std::string& name,
                          const SensorFrame::Sonar& ping) {
  NERITIC_TRY(Fan* const fan, fan_of(ping.index, name, ping.grid));
  fan->is_power = ping.is_float;
  declare_picture(graph, *fan, declare_sums(graph, ping, *fan),
                  declare_scale(graph, name, ping, *fan));
  return {};
}

Status SonarFans::redraw(graph::FrameGraph& graph) {
  for (auto& [sonar, fan] : fans_) {
    if (fan->drawn || (fan->gain == gain_ && fan->range_part == range_part_)) continue;
    if (fan->range_part != range_part_) NERITIC_TRY_STATUS(shape_fan(*fan));
    declare_picture(graph, *fan, graph.import_buffer(fan->name + " fan sums", fan->sums),
                    graph.import_buffer(fan->name + " fan scale", fan->scale));
  }
  return {};
}

void SonarFans::declare_picture(graph::FrameGraph& graph, Fan& fan, graph::BufferHandle sums,
                                graph::BufferHandle scale) {
  fan.gain = gain_;
  // Every texel is written: what was there need not be kept.
  const graph::ImageHandle picture = graph.import_image(fan.picture, {});
  struct Data {
    graph::BufferHandle sums, scale;
    graph::ImageHandle picture;
  };
  fan.drawn =
      graph
          .add_pass<Data>(
              fan.name + " fan",
              [&](graph::PassBuilder& builder, Data& data) {
                data.sums = sums;
                data.scale = scale;
                builder.read(sums, graph::Access::kStorageReadCompute);
                builder.read(scale, graph::Access::kStorageReadCompute);
                data.picture = builder.write(picture, graph::Access::kStorageWriteCompute);
              },
              [this, push = push_of(fan.shape, fan.grid, fan.range_part, fan.is_power, opaque_,
                                    gain_)](const Data& data, graph::PassContext& context) {
                gpu::Commands& commands = context.commands;
                commands.bind_pipeline(draw_);
                commands.bind(
                    draw_,
                    {gpu::bound_buffer(shared::kSonarFanSums, context.buffer(data.sums).handle()),
                     gpu::bound_buffer(shared::kSonarFanScale, context.buffer(data.scale).handle()),
                     gpu::bound_storage_image(shared::kSonarFanPicture,
                                              context.image(data.picture).view())});
                commands.push(draw_, push);
                commands.dispatch(groups(push.width), groups(push.height));
              })
          .picture;
  graph.output(fan.drawn, graph::Access::kSampledFragment);
}

graph::ImageHandle SonarFans::picture(graph::FrameGraph& graph, std::size_t sonar) {
  const auto found = fans_.find(sonar);
  if (found == fans_.end()) return {};
  const Fan& fan = *found->second;
  if (fan.drawn) return fan.drawn;
  return graph.import_image(fan.picture, {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

const sonar::BeamGrid* SonarFans::grid(std::size_t sonar) const {
  const auto found = fans_.find(sonar);
  return found == fans_.end() ? nullptr : &found->second->grid;
}

const FanShape* SonarFans::shape(std::size_t sonar) const {
  const auto found = fans_.find(sonar);
  return found == fans_.end() ? nullptr : &found->second->shape;
}

}  // namespace neritic::testbed
