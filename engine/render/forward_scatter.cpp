// WaterPasses: forward scatter, as a pyramid of octaves (shared/forward_scatter.h).
#include <algorithm>

#include "engine/render/renderer.hpp"
#include "engine/render/water_passes.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

constexpr std::uint32_t groups_of(std::uint32_t size) {
  return (size + shared::kShadeGroup - 1) / shared::kShadeGroup;
}

std::uint32_t parts(std::uint32_t size, std::uint32_t side) {
  return (size + side - 1) / side;
}

Status make_scatter(gpu::Device& device, gpu::Pipeline& pipeline, const char* name,
                    std::span<const std::uint32_t> code, std::uint32_t side, bool push) {
  if (pipeline) return {};
  gpu::ComputePipelineDesc desc;
  desc.name = name;
  desc.code = code;
  desc.layout.bindings = {{shared::kScatterFrom, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                          {shared::kScatterTo, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
  if (push) desc.layout.push_constant_bytes = sizeof(shared::ScatterPush);
  if (side > 0) desc.constants = {{shared::kSpecScatterSide, side}};
  NERITIC_TRY(pipeline, gpu::Pipeline::create(device, desc));
  return {};
}

}  // namespace

std::vector<ScatterLevel> scatter_levels(const scene::ForwardScatter& settings,
                                         const shared::Lighting& lighting, std::uint32_t width,
                                         std::uint32_t height, double pixels_rad) {
  std::vector<ScatterLevel> levels;
  std::uint32_t side = 1u << shared::kScatterFirstLevel;
  width = parts(width, side);
  height = parts(height, side);
  for (std::uint32_t i = 0; i < settings.levels; ++i) {
    ScatterLevel level{width, height, {}};
    level.push.scattering = lighting.particle_scattering;
    level.push.angle_rad = static_cast<float>(settings.angle_rad);
    const double cut = shared::kScatterCut * pixels_rad / side;
    level.push.high_cycles_rad = i == 0 ? 0.0f : static_cast<float>(2.0 * cut);
    level.push.low_cycles_rad = static_cast<float>(cut);
    levels.push_back(level);
    if (width == 1 && height == 1) break;
    width = parts(width, 2);
    height = parts(height, 2);
    side *= 2;
  }
  levels.back().push.low_cycles_rad = 0.0f;
  return levels;
}

Result<graph::ImageHandle> WaterPasses::declare_forward_scatter(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    graph::ImageHandle scattered, const GBuffer& gbuffer, const ViewSet& views,
    const shared::Lighting& lighting, const scene::ForwardScatter& settings) {
  NERITIC_TRY_STATUS(make_scatter(device_, scatter_first_, "scatter first",
                                  shaders::kScatterDownComp, 1u << shared::kScatterFirstLevel,
                                  false));
  NERITIC_TRY_STATUS(
      make_scatter(device_, scatter_down_, "scatter down", shaders::kScatterDownComp, 2, false));
  NERITIC_TRY_STATUS(
      make_scatter(device_, scatter_up_, "scatter up", shaders::kScatterUpComp, 0, true));
  NERITIC_TRY_STATUS(
      make_scatter(device_, scatter_add_, "scatter add", shaders::kScatterAddComp, 0, false));
  const FrustumTangents& tangents = views.views.front().tangents;
  const double pixels_rad = gbuffer.height / (tangents.top - tangents.bottom);
  std::vector<ScatterLevel> levels =
      scatter_levels(settings, lighting, gbuffer.width, gbuffer.height, pixels_rad);
  struct Data {
    graph::ImageHandle hdr, scattered;
    std::vector<graph::ImageHandle> levels;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "forward scatter",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(fmt::format("{} octaves", levels.size()));
        data.scattered = scattered;
        builder.read(scattered, graph::Access::kStorageReadCompute);
        for (std::size_t i = 0; i < levels.size(); ++i)
          data.levels.push_back(builder.write(
              builder.create_image(fmt::format("{}scatter {}", prefix, i),
                                   {kHdrFormat, levels[i].width, levels[i].height, gbuffer.layers}),
              graph::Access::kStorageWriteCompute));
        data.hdr = builder.write(hdr, graph::Access::kStorageWriteCompute);
      },
      [this, levels, gbuffer](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const auto run = [&](const gpu::Pipeline& pipeline, graph::ImageHandle from,
                             graph::ImageHandle to, const shared::ScatterPush* push,
                             std::uint32_t width, std::uint32_t height) {
          commands.bind_pipeline(pipeline);
          commands.bind(pipeline,
                        {gpu::bound_storage_image(shared::kScatterFrom, context.image(from).view()),
                         gpu::bound_storage_image(shared::kScatterTo, context.image(to).view())});
          if (push) commands.push(pipeline, *push);
          commands.dispatch(groups_of(width), groups_of(height), gbuffer.layers);
        };
        graph::ImageHandle from = data.scattered;
        for (std::size_t i = 0; i < levels.size(); ++i) {
          if (i > 0) commands.wait_for_dispatch();
          run(i == 0 ? scatter_first_ : scatter_down_, from, data.levels[i], nullptr,
              levels[i].width, levels[i].height);
          from = data.levels[i];
        }
        for (std::size_t i = levels.size(); i-- > 0;) {
          commands.wait_for_dispatch();
          // The coarsest reads no other; what is bound there is not used.
          run(scatter_up_, i + 1 < levels.size() ? data.levels[i + 1] : data.scattered,
              data.levels[i], &levels[i].push, levels[i].width, levels[i].height);
        }
        commands.wait_for_dispatch();
        run(scatter_add_, data.levels[0], data.hdr, nullptr, levels[0].width, levels[0].height);
      });
  return pass.hdr;
}

}  // namespace neritic::render
