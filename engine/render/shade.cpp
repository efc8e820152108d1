// Renderer: creation, and the compute passes on the G-buffer: shade and tonemap.
#include <algorithm>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/render/lighting.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

struct Rows {  // of workgroups
  std::uint32_t first = 0, end = 0;
};

// Rows of workgroups that one pipeline shades, or a list of tiles (shaders/shade_tiles.comp).
struct ShadePart {
  Rows rows;
  bool sea = false;
  bool surfaces = true;
  std::uint32_t list = 0;
  const gpu::Pipeline* pipeline = nullptr;
};

// Numbers that tell whether a sight meets the sea's surface before the water has hidden it
// (sea_meets in shaders/shared/sea_surface.glsl, with room for the waves' height).
struct SeaSight {
  float clearest;  // the least attenuation of a beam, 1/m
  float off_m;     // the least that any view's window lies under its highest waves
};

SeaSight sea_sight(std::span<const shared::View> eyes, const ViewSet& views,
                   const shared::Lighting& lighting, const shared::Waves& waves) {
  SeaSight sight{std::min({lighting.beam_attenuation.x, lighting.beam_attenuation.y,
                           lighting.beam_attenuation.z}),
                 std::numeric_limits<float>::infinity()};
  const float room_m = 6.0f * waves.height_rms_m + 0.05f;
  for (const shared::View& view : eyes) {
    // The window that it looks through is higher than the eye (shaders/shade.comp).
    float highest = 0.0f;
    for (const float y : {0.0f, static_cast<float>(views.height)})
      for (const float x : {0.0f, static_cast<float>(views.width)})
        highest = std::max(highest, view.ray_corner.y + x * view.ray_dx.y + y * view.ray_dy.y);
    sight.off_m = std::min(sight.off_m, lighting.origin_depth_m - view.eye.y + waves.eye_height_m -
                                            highest * view.near_m - room_m);
  }
  return sight;
}

// The rows where some view's sight may meet it.
Rows rows_of_sea(std::span<const shared::View> eyes, const ViewSet& views, const SeaSight& sight,
                 std::uint32_t groups_high) {
  if (!(sight.off_m > 0.0f)) return {0, groups_high};
  std::uint32_t first = groups_high, end = 0;
  const float least = std::max(sight.off_m * sight.clearest / shared::kSeaFaded, 2e-3f);
  for (const shared::View& view : eyes)
    for (std::uint32_t g = 0; g < groups_high; ++g) {
      float up = -1.0f;  // at least the sine of every sight of these rows, as rays are 1 or longer
      for (const float y : {g * 8.0f, g * 8.0f + 8.0f})
        for (const float x : {0.0f, static_cast<float>(views.width)})
          up = std::max(up, view.ray_corner.y + x * view.ray_dx.y + y * view.ray_dy.y);
      if (up <= 0.99f * least) continue;
      first = std::min(first, g);
      end = std::max(end, g + 1);
    }
  static_assert(shared::kShadeGroup == 8);
  return first < end ? Rows{first, end} : Rows{};
}

// The parts of a picture that is shaded by rows: those that see the sea, and the others.
std::vector<ShadePart> parts_by_rows(Rows sea, std::uint32_t groups_high) {
  std::vector<ShadePart> parts;
  if (sea.first < sea.end) parts.push_back({.rows = sea, .sea = true});
  if (sea.first > 0) parts.push_back({.rows = {0, sea.first}});
  if (sea.end < groups_high) parts.push_back({.rows = {sea.end, groups_high}});
  return parts;
}

// The same by lists of tiles (shaders/shade_tiles.comp).
std::vector<ShadePart> parts_by_tiles(bool sea) {
  std::vector<ShadePart> parts;
  for (std::uint32_t list = 0; list < (sea ? shared::kShadeTileLists : shared::kShadeTileSea);
       ++list)
    parts.push_back({.sea = (list & shared::kShadeTileSea) != 0,
                     .surfaces = (list & shared::kShadeTileSolid) != 0,
                     .list = list});
  return parts;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device) {
  std::unique_ptr<Renderer> renderer(new Renderer(device));
  NERITIC_TRY(renderer->material_layout_, create_material_layout(device));
  NERITIC_TRY(renderer->nothing_,
              gpu::Buffer::create(device, {"nothing", 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
  NERITIC_TRY(renderer->nowhere_,
              gpu::Buffer::create(device, {"nowhere", 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
  NERITIC_TRY(renderer->tile_sampler_,
              gpu::Sampler::create(device, {.name = "tile", .mipmapped = false}));
  return renderer;
}

Result<graph::ImageHandle> Renderer::declare_shade(graph::FrameGraph& graph,
                                                   const std::string& prefix,
                                                   const ShadeInputs& inputs) {
  const GBuffer& gbuffer = inputs.gbuffer;
  const ViewSet& views = inputs.views;
  const shared::Lighting& lighting = inputs.lighting;
  const LightImages light = inputs.light;
  const std::optional<shared::Waves> waves =
      inputs.waves ? std::optional(*inputs.waves) : std::nullopt;
  NERITIC_CHECK(waves || !(lighting.terms & shared::kLightWaves), "{}shade: no waves", prefix);
  // Rows and tiles that see no sea are spared its waves: a CPU driver computes them for every
  // pixel.
  const std::uint32_t high = groups(gbuffer.height);
  const auto all_eyes = gpu_views(views);
  const std::span eyes = std::span(all_eyes).first(views.views.size());
  const SeaSight sight = sea_sight(eyes, views, lighting, waves.value_or(shared::Waves{}));
  const Rows sea =
      lighting.terms & shared::kLightSurface ? rows_of_sea(eyes, views, sight, high) : Rows{};
  const bool sees_sea = sea.first < sea.end;
  // Tiles of water alone are shaded without what solids need. Not with several layers: a CPU's
  // driver must see which layer a workgroup reads.
  const bool tiled = gbuffer.layers == 1;
  graph::BufferHandle tiles;
  if (tiled) {
    NERITIC_TRY(tiles,
                declare_shade_tiles(
                    graph, prefix, gbuffer,
                    {.wide = groups(gbuffer.width),
                     .high = high,
                     .near_m = eyes[0].near_m,
                     .sea_off_m = sees_sea ? sight.off_m : std::numeric_limits<float>::infinity(),
                     .sea_clearest = sight.clearest,
                     .ray_corner = eyes[0].ray_corner,
                     .ray_dx = eyes[0].ray_dx,
                     .ray_dy = eyes[0].ray_dy}));
  }
  std::vector<ShadePart> parts = tiled ? parts_by_tiles(sees_sea) : parts_by_rows(sea, high);
  for (ShadePart& part : parts) {
    gpu::Pipeline& pipeline = shade_[{
        lighting.terms, lighting.lamp_count, inputs.visibility_step, inputs.inscatter_samples,
        (part.sea ? 1u : 0u) + (part.surfaces ? 2u : 0u) + (tiled ? 4u : 0u)}];
    part.pipeline = &pipeline;
    if (pipeline) continue;
    gpu::ComputePipelineDesc desc;
    desc.name = "shade";
    desc.code = shaders::kShadeComp;
    desc.layout.bindings = {{shared::kShadeViews, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kShadeLighting, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kShadeDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeNormal, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeAlbedo, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeMaterial, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeEmissive, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeHdr, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kShadeSeen, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeCaustics, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                            {shared::kShadeShafts, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeLampMaps, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeLampShadows, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kShadeScattered, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kShadeWaves, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kShadeSkylight, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeTiles, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    desc.constants = {{shared::kSpecTerms, lighting.terms},
                      {shared::kSpecLamps, lighting.lamp_count},
                      {shared::kSpecSeenStep, inputs.visibility_step},
                      {shared::kSpecGlowSamples, inputs.inscatter_samples},
                      {shared::kSpecSeaSeen, part.sea ? 1u : 0u},
                      {shared::kSpecTiled, tiled ? 1u : 0u},
                      {shared::kSpecSurfaces, part.surfaces ? 1u : 0u}};
    desc.layout.push_constant_bytes = sizeof(shared::ShadePush);
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle hdr, scattered;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "shade",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(names_of_terms(lighting));
        for (const graph::ImageHandle handle :
             {gbuffer.depth, gbuffer.normal, gbuffer.albedo, gbuffer.material, gbuffer.emissive,
              light.seen, light.caustics, light.shafts, light.skylight, light.lamp_maps})
          if (handle) builder.read(handle, graph::Access::kSampledCompute);
        if (tiles) {
          builder.read(tiles, graph::Access::kIndirectBuffer);
          builder.read(tiles, graph::Access::kStorageReadCompute);
        }
        data.hdr = builder.write(
            builder.create_image(prefix + "hdr",
                                 {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
        if (lighting.terms & shared::kLightForwardScatter)
          data.scattered = builder.write(
              builder.create_image(prefix + "scattered",
                                   {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
              graph::Access::kStorageWriteCompute);
      },
      [this, parts, gbuffer, lighting, light, waves, tiles, &views](const Data& data,
                                                                    graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::UploadSlice view_data =
            commands.upload(std::span<const shared::View>(gpu_views(views)));
        const gpu::UploadSlice light_data = commands.upload(&lighting, sizeof lighting);
        const gpu::UploadSlice shadow_data =
            commands.upload(&light.lamp_shadows, sizeof light.lamp_shadows);
        // Without waves the shader reads nothing of what is bound there; it is large enough.
        static_assert(sizeof(shared::Waves) <= sizeof(shared::View) * shared::kMaxViews);
        const gpu::UploadSlice wave_data =
            waves ? commands.upload(&*waves, sizeof *waves) : view_data;
        const auto texels = [&](std::uint32_t binding, graph::ImageHandle handle) {
          return gpu::bound_texel_image(binding, context.image(handle).view());
        };
        const auto resources = {
            gpu::bound_buffer(shared::kShadeViews, view_data.buffer, view_data.offset,
                              view_data.size),
            gpu::bound_buffer(shared::kShadeLighting, light_data.buffer, light_data.offset,
                              light_data.size),
            texels(shared::kShadeDepth, gbuffer.depth),
            texels(shared::kShadeNormal, gbuffer.normal),
            texels(shared::kShadeAlbedo, gbuffer.albedo),
            texels(shared::kShadeMaterial, gbuffer.material),
            // Without emission the shader's flag keeps it from reading what is bound here.
            texels(shared::kShadeEmissive, gbuffer.emissive ? gbuffer.emissive : gbuffer.albedo),
            gpu::bound_storage_image(shared::kShadeHdr, context.image(data.hdr).view()),
            texels(shared::kShadeSeen, light.seen ? light.seen : gbuffer.albedo),
            gpu::bound_texture(
                shared::kShadeCaustics,
                context.image(light.caustics ? light.caustics : gbuffer.albedo).view(),
                tile_sampler_.handle()),
            texels(shared::kShadeShafts, light.shafts ? light.shafts : gbuffer.albedo),
            texels(shared::kShadeSkylight, light.skylight ? light.skylight : gbuffer.albedo),
            texels(shared::kShadeLampMaps, light.lamp_maps ? light.lamp_maps : gbuffer.depth),
            gpu::bound_buffer(shared::kShadeLampShadows, shadow_data.buffer, shadow_data.offset,
                              shadow_data.size),
            gpu::bound_buffer(shared::kShadeWaves, wave_data.buffer, wave_data.offset,
                              wave_data.size),
            gpu::bound_storage_image(
                shared::kShadeScattered,
                context.image(data.scattered ? data.scattered : data.hdr).view()),
            gpu::bound_buffer(shared::kShadeTiles,
                              tiles ? context.buffer(tiles).handle() : nothing_.handle())};
        // Their layouts are the same, so what is bound for one stays bound for all.
        commands.bind(*parts.front().pipeline, resources);
        for (const ShadePart& part : parts) {
          commands.bind_pipeline(*part.pipeline);
          if (!tiles) {
            commands.push(*part.pipeline, shared::ShadePush{part.rows.first, 0});
            commands.dispatch(groups(gbuffer.width), part.rows.end - part.rows.first,
                              gbuffer.layers);
            continue;
          }
          const std::uint32_t count = groups(gbuffer.width) * groups(gbuffer.height);
          commands.push(*part.pipeline,
                        shared::ShadePush{0, shared::kShadeTileHead * shared::kShadeTileLists +
                                                 count * part.list});
          vkCmdDispatchIndirect(
              context.cmd(), context.buffer(tiles).handle(),
              VkDeviceSize{sizeof(std::uint32_t)} * shared::kShadeTileHead * part.list);
        }
      });
  if (inputs.scattered) *inputs.scattered = pass.scattered;
  return pass.hdr;
}

Result<graph::BufferHandle> Renderer::declare_shade_tiles(graph::FrameGraph& graph,
                                                          const std::string& prefix,
                                                          const GBuffer& gbuffer,
                                                          const shared::ShadeTilesPush& push) {
  if (!shade_tiles_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "shade tiles";
    desc.code = shaders::kShadeTilesComp;
    desc.layout.bindings = {{shared::kShadeTilesDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeTilesOut, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    desc.layout.push_constant_bytes = sizeof(shared::ShadeTilesPush);
    NERITIC_TRY(shade_tiles_, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::BufferHandle tiles;
  };
  const std::uint64_t words = std::uint64_t{shared::kShadeTileLists} *
                              (shared::kShadeTileHead + std::uint64_t{push.wide} * push.high);
  const Data& cleared = graph.add_pass<Data>(
      prefix + "shade tiles clear",
      [&](graph::PassBuilder& builder, Data& data) {
        data.tiles = builder.write(
            builder.create_buffer(prefix + "shade tiles", sizeof(std::uint32_t) * words),
            graph::Access::kTransferWrite);
      },
      [](const Data& data, graph::PassContext& context) {
        constexpr VkDeviceSize kHeads =
            sizeof(std::uint32_t) * shared::kShadeTileHead * shared::kShadeTileLists;
        vkCmdFillBuffer(context.cmd(), context.buffer(data.tiles).handle(), 0, kHeads, 0);
      });
  const Data& sorted = graph.add_pass<Data>(
      prefix + "shade tiles",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(gbuffer.depth, graph::Access::kSampledCompute);
        data.tiles = builder.write(cleared.tiles, graph::Access::kStorageWriteCompute);
      },
      [this, depth = gbuffer.depth, push](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(shade_tiles_);
        commands.bind(
            shade_tiles_,
            {gpu::bound_texel_image(shared::kShadeTilesDepth, context.image(depth).view()),
             gpu::bound_buffer(shared::kShadeTilesOut, context.buffer(data.tiles).handle())});
        commands.push(shade_tiles_, push);
        commands.dispatch(groups(push.wide), groups(push.high));
      });
  return sorted.tiles;
}

// Both filters bind their source at 0 and their result at 1.
static_assert(shared::kTonemapHdr == 0 && shared::kTonemapOut == 1 && shared::kAntialiasIn == 0 &&
              shared::kAntialiasOut == 1 && shared::kAverageIn == 0 && shared::kAverageOut == 1);

Result<graph::ImageHandle> Renderer::declare_filter(graph::FrameGraph& graph,
                                                    const std::string& prefix,
                                                    const PictureFilter& filter,
                                                    gpu::Pipeline& pipeline, graph::ImageHandle in,
                                                    std::uint32_t width, std::uint32_t height,
                                                    std::uint32_t layers) {
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = filter.name;
    desc.code = filter.code;
    desc.constants = filter.constants;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + filter.name,
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(in, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + filter.result, {filter.format, width, height, layers}),
            graph::Access::kStorageWriteCompute);
      },
      [&pipeline, in, width, height, layers, block = filter.block](const Data& data,
                                                                   graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(pipeline);
        commands.bind(pipeline, {gpu::bound_texel_image(0, context.image(in).view()),
                                 gpu::bound_storage_image(1, context.image(data.out).view())});
        commands.dispatch(groups((width + block - 1) / block), groups((height + block - 1) / block),
                          layers);
      });
  return pass.out;
}

Result<graph::ImageHandle> Renderer::declare_average(graph::FrameGraph& graph,
                                                     const std::string& prefix,
                                                     graph::ImageHandle hdr, std::uint32_t side,
                                                     std::uint32_t width, std::uint32_t height,
                                                     std::uint32_t layers) {
  return declare_filter(graph, prefix,
                        {"average",
                         "mean hdr",
                         shaders::kAverageComp,
                         {{shared::kSpecAverageSide, side}},
                         1,
                         kHdrFormat},
                        average_[side], hdr, width, height, layers);
}

Result<graph::ImageHandle> Renderer::declare_resize(graph::FrameGraph& graph,
                                                    const std::string& prefix,
                                                    graph::ImageHandle color, std::uint32_t width,
                                                    std::uint32_t height, std::uint32_t layers) {
  return declare_filter(graph, prefix,
                        {"resize", "full color", shaders::kResizeComp, {}, shared::kResizeBlock},
                        resize_, color, width, height, layers);
}

Result<graph::ImageHandle> Renderer::declare_picture(graph::FrameGraph& graph,
                                                     const std::string& prefix,
                                                     graph::ImageHandle hdr, std::uint32_t width,
                                                     std::uint32_t height, std::uint32_t layers,
                                                     bool antialias) {
  const PictureFilter tonemap{
      "tonemap", "color", shaders::kTonemapComp, {{shared::kSpecLumaInAlpha, antialias ? 1u : 0u}}};
  NERITIC_TRY(const graph::ImageHandle color,
              declare_filter(graph, prefix, tonemap, antialias ? tonemap_luma_ : tonemap_, hdr,
                             width, height, layers));
  if (!antialias) return color;
  return declare_filter(
      graph, prefix,
      {"antialias", "smooth color", shaders::kAntialiasComp, {}, shared::kAntialiasBlock},
      antialias_, color, width, height, layers);
}

}  // namespace neritic::render
