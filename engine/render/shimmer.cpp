// WaterPasses: layers of water that bend sight (shared/shimmer.h).
#include <cmath>

#include "engine/core/random.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/water_passes.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kShimmerStream = 0x7368696d6d6572ull;  // "shimmer"
constexpr double kIndexAt_nm = 550.0;  // the index's change differs by some 4 % over the spectrum
constexpr double kLayerGravity_m_s2 = 9.80665;

double reduced(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * kPi);
}

}  // namespace

double internal_wave_s(const SeaWater& above, const WaterLayer& layer, double number_m) {
  const double light = sea_density_kg_m3(above),
               heavy = sea_density_kg_m3({layer.temperature_c, layer.salinity_psu});
  if (!(heavy > light)) return 0.0;
  const double thin2 = kLayerGravity_m_s2 * number_m * (heavy - light) / (heavy + light);
  const double buoyancy2 =
      kLayerGravity_m_s2 * (heavy - light) / (0.5 * (heavy + light) * layer.thickness_m);
  return std::sqrt(thin2 * buoyancy2 / (thin2 + buoyancy2));
}

shared::ShimmerParams shimmer_params(const WaterColumn& column, const Vec3& origin_m, double time_s,
                                     std::uint64_t seed) {
  shared::ShimmerParams out{};
  SeaWater above{column.temperature_c, column.salinity_psu};
  for (std::size_t i = 0; i < column.count; ++i) {
    const WaterLayer& layer = column.layer[i];
    const SeaWater below{layer.temperature_c, layer.salinity_psu};
    const double high = sea_refractive_index(above, kIndexAt_nm),
                 low = sea_refractive_index(below, kIndexAt_nm);
    shared::ShimmerLayer& to = out.layers[i];
    to.height_m = static_cast<float>(-layer.depth_m - origin_m.y);
    to.sigma_m = static_cast<float>(layer.sigma_m());
    to.bend = static_cast<float>(2.0 * (low - high) / (low + high));
    const double slope = layer.slope * std::sqrt(2.0 / shared::kShimmerWaves);
    for (std::uint32_t w = 0; w < shared::kShimmerWaves; ++w) {
      const RandomKey key{seed, kShimmerStream, i};
      const double share = (w + random_uniform(key, 3 * w)) / shared::kShimmerWaves;
      const double number =
          2.0 * kPi / (layer.longest_m * std::pow(layer.shortest_m / layer.longest_m, share));
      const double turn = 2.0 * kPi * random_uniform(key, 3 * w + 1);
      const Vec2 along(number * std::cos(turn), number * std::sin(turn));
      const double angle = 2.0 * kPi * random_uniform(key, 3 * w + 2) -
                           reduced(internal_wave_s(above, layer, number) * time_s) +
                           reduced(along.x * origin_m.x) + reduced(along.y * origin_m.z);
      to.waves[w] = {Vec2f(along), static_cast<float>(slope), static_cast<float>(reduced(angle))};
    }
    above = below;
  }
  return out;
}

Result<graph::ImageHandle> WaterPasses::declare_shimmer(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    const GBuffer& gbuffer, const ViewSet& views, const WaterColumn& column, double time_s,
    std::uint64_t seed) {
  static_assert(shared::kShimmerLayers == std::tuple_size_v<decltype(WaterColumn::layer)>);
  bool waves = false;
  for (const WaterLayer& layer : column.layers()) waves = waves || layer.slope > 0.0;
  const std::uint32_t count = waves ? shared::kShimmerWaves : 0;
  gpu::Pipeline& pipeline = shimmer_[{static_cast<std::uint32_t>(column.count), count}];
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "shimmer";
    desc.code = shaders::kShimmerComp;
    desc.layout.bindings = {{shared::kShimmerHdr, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShimmerDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShimmerOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kShimmerViews, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kShimmerData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    desc.constants = {{shared::kSpecShimmerLayers, static_cast<std::uint32_t>(column.count)},
                      {shared::kSpecShimmerWaves, count}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "shimmer",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(
            fmt::format("{} layer{} of water", column.count, column.count > 1 ? "s" : ""));
        builder.read(hdr, graph::Access::kSampledCompute);
        builder.read(gbuffer.depth, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + "shimmering hdr",
                                 {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
      },
      [&pipeline, hdr, gbuffer, &views,
       params = shimmer_params(column, views.origin_m(), time_s, seed)](
          const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {gpu::bound_texel_image(shared::kShimmerHdr, context.image(hdr).view()),
             gpu::bound_texel_image(shared::kShimmerDepth, context.image(gbuffer.depth).view()),
             gpu::bound_storage_image(shared::kShimmerOut, context.image(data.out).view()),
             bound_slice(shared::kShimmerViews,
                         commands.upload(std::span<const shared::View>(gpu_views(views)))),
             bound_slice(shared::kShimmerData, commands.upload(&params, sizeof params))});
        commands.dispatch(groups(gbuffer.width), groups(gbuffer.height), gbuffer.layers);
      });
  return pass.out;
}

}  // namespace neritic::render
