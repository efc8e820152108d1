#include "sonar/receiver.hpp"

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "shaders.hpp"

namespace neritic::sonar {
namespace {

using graph::Access;

constexpr VkFormat kFieldFormat = VK_FORMAT_R32G32_SFLOAT;

std::uint32_t groups(std::uint32_t n) {
  return (n + shared::kReceiverGroup - 1) / shared::kReceiverGroup;
}

Result<gpu::Pipeline> pipeline(gpu::Device& device, const char* name,
                               std::span<const std::uint32_t> code,
                               std::vector<gpu::BindingDesc> bindings,
                               std::vector<gpu::SpecConstant> constants) {
  gpu::ComputePipelineDesc desc;
  desc.name = name;
  desc.code = code;
  desc.layout.bindings = std::move(bindings);
  desc.layout.push_constant_bytes = sizeof(shared::SonarReceiverPush);
  desc.constants = std::move(constants);
  return gpu::Pipeline::create(device, desc);
}

Result<gpu::Image> taps_image(gpu::Device& device, const char* name, const Taps& taps) {
  NERITIC_TRY(gpu::Image image,
              gpu::Image::create(
                  device, {.name = name,
                           .format = VK_FORMAT_R32_SFLOAT,
                           .width = taps.size(),
                           .height = taps.kernels,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  NERITIC_TRY_STATUS(gpu::upload_image(device, image, std::as_bytes(std::span(taps.weights))));
  return image;
}

// Autocorrelation of the taps at a lag of one: near 1 if they change slowly, 0 for a single tap.
float correlation_a_step_on(const Taps& taps) {
  double own = 0.0, next = 0.0;
  for (std::size_t i = 0; i < taps.weights.size(); ++i) {
    own += double{taps.weights[i]} * taps.weights[i];
    if (i % taps.size() > 0) next += double{taps.weights[i - 1]} * taps.weights[i];
  }
  return own > 0.0 ? static_cast<float>(next / own) : 1.0f;
}

}  // namespace

Result<Receiver> Receiver::create(gpu::Device& device, ReceiverDesc desc) {
  Receiver made;
  made.desc_ = std::move(desc);
  const ReceiverDesc& d = made.desc_;
  NERITIC_CHECK(!d.across.weights.empty() || d.beams == d.columns,
                "beams without a kernel are columns");
  constexpr auto kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  constexpr auto kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  constexpr auto kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  const gpu::SpecConstant coherent{shared::kReceiverSpecCoherent, d.coherent};
  NERITIC_TRY(made.resolve_, pipeline(device, "sonar resolve", shaders::kSonarResolveComp,
                                      {{shared::kReceiverIn, kBuffer},
                                       {shared::kReceiverGains, kBuffer},
                                       {shared::kReceiverOut, kImage}},
                                      {coherent}));
  NERITIC_TRY(made.receive_, pipeline(device, "sonar receive", shaders::kSonarReceiveComp,
                                      {{shared::kReceiverIn, kImage},
                                       {shared::kReceiverGains, kBuffer},
                                       {shared::kReceiverOut, kBuffer}},
                                      {coherent, {shared::kReceiverSpecNoise, d.noise}}));
  const auto spread = [&](const char* name, std::uint32_t axis) {
    return pipeline(device, name, shaders::kSonarSpreadComp,
                    {{shared::kReceiverIn, kImage},
                     {shared::kReceiverTaps, kSampled},
                     {shared::kReceiverOut, kImage}},
                    {coherent,
                     {shared::kReceiverSpecAxis, axis},
                     {shared::kReceiverSpecShift, d.shift},
                     {shared::kReceiverSpecWrap, d.wrap}});
  };
  if (!d.range.weights.empty()) {
    NERITIC_TRY(made.range_taps_, taps_image(device, "sonar pulse", d.range));
    NERITIC_TRY(made.pulse_, spread("sonar pulse", 1));
  }
  if (!d.across.weights.empty()) {
    NERITIC_TRY(made.across_taps_, taps_image(device, "sonar beam pattern", d.across));
    NERITIC_TRY(made.beams_, spread("sonar beams", 0));
  }
  return made;
}

shared::SonarReceiverPush Receiver::push(const Ping& ping) const {
  return {.columns = desc_.columns,
          .rows = desc_.rows,
          .out_columns = desc_.columns,
          .stride = desc_.stride,
          .first = 0,
          .taps = 0,
          .scale = static_cast<float>(1.0 / desc_.sum_scale),
          .first_shift = ping.first_shift_columns,
          .shift = ping.shift_columns_per_row,
          .shift_right = ping.shift_columns_right,
          .shift_back = ping.shift_columns_back,
          .first_bearing_rad = static_cast<float>(desc_.first_bearing_rad),
          .bearing_step_rad = static_cast<float>(desc_.bearing_step_rad),
          .tap_correlation = 0.0f,
          .noise = std::sqrt(ping.noise_power),
          .seed = ping.seed,
          .ping = ping.ping};
}

graph::ImageHandle Receiver::declare_spread(graph::FrameGraph& graph, const std::string& name,
                                            graph::ImageHandle field, bool across,
                                            const Ping& ping) const {
  struct Pass {
    graph::ImageHandle in, out;
  };
  shared::SonarReceiverPush constants = push(ping);
  const Taps& taps = across ? desc_.across : desc_.range;
  constants.out_columns = across ? desc_.beams : desc_.columns;
  constants.first = taps.first;
  constants.taps = taps.size();
  constants.tap_correlation = correlation_a_step_on(taps);
  return graph
      .add_pass<Pass>(
          name,
          [&](graph::PassBuilder& builder, Pass& pass) {
            pass.in = field;
            builder.read(field, Access::kStorageReadCompute);
            pass.out = builder.write(
                builder.create_image(name, {kFieldFormat, constants.out_columns, desc_.rows}),
                Access::kStorageWriteCompute);
          },
          [this, across, constants](const Pass& pass, graph::PassContext& context) {
            const gpu::Pipeline& pipeline = across ? beams_ : pulse_;
            context.commands.bind_pipeline(pipeline);
            context.commands.bind(
                pipeline,
                {gpu::bound_storage_image(shared::kReceiverIn, context.image(pass.in).view()),
                 gpu::bound_texel_image(shared::kReceiverTaps,
                                        (across ? across_taps_ : range_taps_).view()),
                 gpu::bound_storage_image(shared::kReceiverOut, context.image(pass.out).view())});
            context.commands.push(pipeline, constants);
            context.commands.dispatch(groups(constants.out_columns), groups(constants.rows));
          })
      .out;
}

graph::ImageHandle Receiver::declare_resolve(graph::FrameGraph& graph, const std::string& prefix,
                                             graph::BufferHandle sums, const Ping& ping) const {
  struct Pass {
    graph::BufferHandle sums;
    graph::ImageHandle field;
  };
  return graph
      .add_pass<Pass>(
          prefix + "sonar resolve",
          [&](graph::PassBuilder& builder, Pass& pass) {
            pass.sums = sums;
            builder.read(sums, Access::kStorageReadCompute);
            pass.field =
                builder.write(builder.create_image(prefix + "sonar field",
                                                   {kFieldFormat, desc_.columns, desc_.rows}),
                              Access::kStorageWriteCompute);
          },
          [this, constants = push(ping), gains = ping.gains](const Pass& pass,
                                                             graph::PassContext& context) {
            const gpu::UploadSlice slice = context.commands.upload(gains);
            context.commands.bind_pipeline(resolve_);
            context.commands.bind(
                resolve_,
                {gpu::bound_buffer(shared::kReceiverIn, context.buffer(pass.sums).handle()),
                 gpu::bound_buffer(shared::kReceiverGains, slice.buffer, slice.offset, slice.size),
                 gpu::bound_storage_image(shared::kReceiverOut, context.image(pass.field).view())});
            context.commands.push(resolve_, constants);
            context.commands.dispatch(groups(desc_.columns), groups(desc_.rows));
          })
      .field;
}

graph::BufferHandle Receiver::declare_receive(graph::FrameGraph& graph, const std::string& prefix,
                                              graph::ImageHandle field, const Ping& ping,
                                              graph::BufferHandle target) const {
  struct Pass {
    graph::ImageHandle field;
    graph::BufferHandle power;
  };
  shared::SonarReceiverPush constants = push(ping);
  constants.out_columns = desc_.beams;
  return graph
      .add_pass<Pass>(
          prefix + "sonar receive",
          [&](graph::PassBuilder& builder, Pass& pass) {
            pass.field = field;
            builder.read(field, Access::kStorageReadCompute);
            pass.power = builder.write(
                target ? target : builder.create_buffer(prefix + "sonar power", power_bytes()),
                Access::kStorageWriteCompute);
          },
          [this, constants, gains = ping.gains](const Pass& pass, graph::PassContext& context) {
            const gpu::UploadSlice slice = context.commands.upload(gains);
            context.commands.bind_pipeline(receive_);
            context.commands.bind(
                receive_,
                {gpu::bound_storage_image(shared::kReceiverIn, context.image(pass.field).view()),
                 gpu::bound_buffer(shared::kReceiverGains, slice.buffer, slice.offset, slice.size),
                 gpu::bound_buffer(shared::kReceiverOut, context.buffer(pass.power).handle())});
            context.commands.push(receive_, constants);
            context.commands.dispatch(groups(desc_.beams), groups(desc_.rows));
          })
      .power;
}

graph::BufferHandle Receiver::declare(graph::FrameGraph& graph, graph::BufferHandle sums,
                                      const Ping& ping, graph::BufferHandle target,
                                      const std::string& prefix) const {
  NERITIC_CHECK(ping.gains.size() == desc_.rows, "a gain a range bin is needed");
  graph::ImageHandle field = declare_resolve(graph, prefix, sums, ping);
  if (!desc_.range.weights.empty())
    field = declare_spread(graph, prefix + "sonar pulse", field, false, ping);
  if (!desc_.across.weights.empty())
    field = declare_spread(graph, prefix + "sonar beams", field, true, ping);
  return declare_receive(graph, prefix, field, ping, target);
}

}  // namespace neritic::sonar
