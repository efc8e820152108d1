#include "testbed/sensors/view_light.hpp"

#include <algorithm>
#include <cmath>

#include "engine/render/lighting.hpp"

namespace neritic::testbed {
namespace {

std::uint32_t times(std::uint32_t named, double factor, double least, double most) {
  return static_cast<std::uint32_t>(std::clamp(std::round(named * factor), least, most));
}

// Texels of the lamps' maps by which coarser meshes may differ.
constexpr double kLampMeshError_px = 0.5;

// Caustics and the lamps' maps, which all cameras share.
Status declare_shared_light(const FrameParts& frame, const ViewsWork& work,
                            const render::DrawList& draws, const scene::PictureDetail& detail,
                            shared::Lighting& lighting, render::LightImages& light) {
  const scene::Scene& scene = frame.scene;
  FrameLight& shared_light = frame.light;
  if (!shared_light.lamps_known) {
    shared_light.lamps_known = true;
    NERITIC_TRY(auto views, render::lamp_views(scene, frame.state));
    shared_light.lamps = render::shadow_maps(
        scene, frame.gpu_scene, frame.state, std::move(views),
        {.mesh_error_px = kLampMeshError_px, .deform_need = &frame.deform_need});
    if (!shared_light.lamps.empty()) {
      NERITIC_TRY(shared_light.lamp_maps,
                  frame.renderer.declare_shadow_maps(frame.graph, "lamp shadows", frame.gpu_scene,
                                                     frame.deformed, shared_light.lamps));
    }
  }
  if (shared_light.lamp_maps) {
    lighting.terms |= shared::kLightLampShadows;
    light.lamp_maps = shared_light.lamp_maps;
    light.lamp_shadows = render::lamp_shadows(scene, work.views, shared_light.lamps);
  }
  // Only a beam throws a net, and only through a surface.
  if (!scene.sun || !scene.sun->caustics || !scene.water || !(lighting.direct_share > 0.0f))
    return {};
  scene::Caustics caustics = *scene.sun->caustics;
  caustics.texels = times(caustics.texels, detail.shadow_size, 16, 2048);
  const double origin_depth_m = static_cast<double>(lighting.origin_depth_m);
  double shallow_m = origin_depth_m - draws.highest_m, deep_m = origin_depth_m - draws.lowest_m;
  if (draws.lowest_m > draws.highest_m) shallow_m = deep_m = 0.0;  // nothing is drawn
  if (scene.sun->shafts) {  // they lie in all the water about
    shallow_m = 0.0;
    deep_m = std::max(deep_m, origin_depth_m + scene.sun->shafts->reach_m);
  }
  const auto [first, end] = render::caustic_levels(shallow_m, deep_m);
  const auto [found, is_new] = shared_light.caustics.try_emplace(caustics.texels);
  FrameLight::Net& net = found->second;
  if (is_new) {
    net.params = render::caustics_params(caustics, render::to_sun_in_air(*scene.sun),
                                         frame.state.time_s, scene.seed);
    net.params.first_level = first;
    net.params.end_level = end;
    const std::string name = caustics.texels == scene.sun->caustics->texels
                                 ? "caustics"
                                 : fmt::format("caustics of {} texels", caustics.texels);
    NERITIC_TRY(net.image, frame.renderer.declare_caustics(frame.graph, net.params, name));
  }
  net.params.first_level = std::min(net.params.first_level, first);
  net.params.end_level = std::max(net.params.end_level, end);
  lighting.terms |= shared::kLightCaustics;
  light.caustics = net.image;
  lighting.caustic_tile_m = static_cast<float>(caustics.tile_m);
  const Vec3 origin_m = work.views.origin_m();
  lighting.caustic_origin_m = {static_cast<float>(std::fmod(origin_m.x, caustics.tile_m)),
                               static_cast<float>(std::fmod(origin_m.z, caustics.tile_m))};
  return {};
}

// Beams of the sun in the water, where it scatters and something makes beams of the light.
Status declare_shafts(const FrameParts& frame, const std::string& prefix, const render::GBuffer& g,
                      const render::ViewSet& views, const scene::PictureDetail& detail,
                      const ViewsWork& work, graph::ImageHandle cascades,
                      shared::Lighting& lighting, render::LightImages& light) {
  const scene::Scene& scene = frame.scene;
  const bool scatters = (lighting.terms & shared::kLightScattering) != 0;
  if (!scene.sun || !scene.sun->shafts || !scatters || !(lighting.direct_share > 0.0f)) return {};
  if (!cascades && !light.caustics) return {};
  render::ShaftInputs inputs;
  inputs.cascades = cascades;
  inputs.cascade_count = cascades ? static_cast<std::uint32_t>(work.cascades.size()) : 0;
  inputs.caustics = light.caustics;
  if (cascades) inputs.sun = render::visibility_params(scene, views, lighting, work.cascades);
  inputs.samples = times(scene.sun->shafts->samples, detail.shaft_samples, 1, 256);
  inputs.params = {static_cast<float>(scene.sun->shafts->reach_m)};
  NERITIC_TRY(light.shafts,
              frame.renderer.declare_shafts(frame.graph, prefix, g, views, lighting, inputs));
  light.shaft_inputs = inputs;
  lighting.terms |= shared::kLightShafts;
  return {};
}

// What stands still in the way of the light from above.
Status declare_skylight(const FrameParts& frame, const std::string& prefix,
                        const render::GBuffer& g, const render::ViewSet& views,
                        const scene::PictureDetail& detail, shared::Lighting& lighting,
                        render::LightImages& light) {
  if (!(lighting.terms & shared::kLightSun)) return {};
  NERITIC_TRY(const render::SkylightGrid* const grid, frame.skylight.grid(frame));
  if (!grid) return {};
  lighting.terms |= shared::kLightSkylight;
  const std::uint32_t samples = frame.scene.ambient->skylight->samples;
  NERITIC_TRY(light.skylight, frame.renderer.declare_skylight(
                                  frame.graph, prefix, g, views, lighting,
                                  {.grid = &frame.skylight.cells(),
                                   .params = {.low = Vec3f(grid->low_m - views.origin_m()),
                                              .cell_m = static_cast<float>(grid->cell_m),
                                              .nx = grid->nx,
                                              .ny = grid->ny,
                                              .nz = grid->nz},
                                   .samples = times(samples, detail.shaft_samples, 1, 256)}));
  return {};
}

}  // namespace

std::uint64_t FrameLight::still_of(const FrameParts& frame) {
  if (!still_) still_ = render::still_hash(frame.state, frame.moving);
  return *still_;
}

std::uint32_t visibility_step(const scene::Scene& scene, const scene::PictureDetail& detail) {
  const bool full = scene.sun && scene.sun->shadows && scene.sun->shadows->full_resolution;
  return full ? 1 : detail.visibility_step;
}

Result<render::LightImages> declare_light(const FrameParts& frame, const std::string& prefix,
                                          const render::GBuffer& g, const render::ViewSet& views,
                                          const render::DrawList& draws,
                                          const scene::PictureDetail& detail, ViewsWork& work,
                                          shared::Lighting& lighting) {
  render::LightImages light;
  const scene::Scene& scene = frame.scene;
  const auto* shadows = scene.sun && scene.sun->shadows ? &*scene.sun->shadows : nullptr;
  render::VisibilityKnobs knobs{.shadow_samples = detail.shadow_samples,
                                .step = visibility_step(scene, detail)};
  if (scene.ambient && scene.ambient->occlusion_m > 0.0)
    knobs.occlusion_taps = times(scene.ambient->occlusion_samples, detail.occlusion_samples, 1, 64);
  graph::ImageHandle cascades;
  // Without a beam nothing throws a shadow: at night, or under full cloud.
  if (shadows && lighting.direct_share > 0.0f) {
    scene::SunShadows settings = *shadows;
    settings.size = times(settings.size, detail.shadow_size, 64, 4096);
    settings.cascades = std::min(settings.cascades, detail.cascades);
    work.cascades = render::sun_views(work.views, settings, Vec3(lighting.to_sun));
    knobs.cascades = settings.cascades;
    NERITIC_TRY(cascades, frame.sun_maps.declare(frame, prefix, work));
  }
  NERITIC_TRY_STATUS(declare_shared_light(frame, work, draws, detail, lighting, light));
  NERITIC_TRY_STATUS(
      declare_shafts(frame, prefix, g, views, detail, work, cascades, lighting, light));
  NERITIC_TRY_STATUS(declare_skylight(frame, prefix, g, views, detail, lighting, light));
  if (!cascades && knobs.occlusion_taps == 0) return light;
  lighting.terms |= shared::kLightSeen;
  NERITIC_TRY(light.seen, frame.renderer.declare_visibility(
                              frame.graph, prefix, g, views,
                              render::visibility_params(scene, views, lighting, work.cascades),
                              cascades, knobs));
  return light;
}

}  // namespace neritic::testbed
