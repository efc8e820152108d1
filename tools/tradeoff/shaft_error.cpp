#include "tools/tradeoff/shaft_error.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/render/caustic_waves.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/water_optics.hpp"
#include "testbed/sensors/readback.hpp"

namespace neritic::tools {
namespace {

constexpr double kReach_m = 20.0, kEyeDepth_m = 3.0, kNear_m = 0.05;
constexpr std::uint32_t kTexels = 192;

// The caustics' net as the device made it, four levels a layer.
struct Net {
  std::vector<std::uint16_t> halves;
  double tile_m = 1.0;

  double texel(std::uint32_t level, std::int64_t x, std::int64_t y) const {
    const auto wrapped = [](std::int64_t i) {
      return static_cast<std::size_t>((i % kTexels + kTexels) % kTexels);
    };
    const std::size_t layer = level / shared::kCausticLayerStep;
    return glm::unpackHalf1x16(halves[((layer * kTexels + wrapped(y)) * kTexels + wrapped(x)) * 4 +
                                      level % shared::kCausticLayerStep]);
  }
  // Between the four nearest texels.
  double at(std::uint32_t level, const Vec2& place_m) const {
    const Vec2 t = place_m / tile_m * double(kTexels) - 0.5;
    const Vec2 low = glm::floor(t), part = t - low;
    const auto x = static_cast<std::int64_t>(low.x), y = static_cast<std::int64_t>(low.y);
    return std::lerp(std::lerp(texel(level, x, y), texel(level, x + 1, y), part.x),
                     std::lerp(texel(level, x, y + 1), texel(level, x + 1, y + 1), part.x), part.y);
  }
};

// The ratio of a texel of the shafts image, as shaders/shared/shaft_texel.glsl packs it.
double ratio_of(float texel) {
  return (texel - std::floor(texel)) * double(shared::kShaftMost);
}

// The net at a place, as shaders/shared/caustic_light.glsl has it.
double lit_at(const Net& net, const shared::Lighting& light, const Vec3& place, double pixel_m) {
  const double depth_m = light.origin_depth_m - place.y;
  const Vec3 sun(light.to_sun);
  const Vec2 surface = Vec2(place.x, place.z) + Vec2(sun.x, sun.z) * (depth_m / sun.y);
  const double level = std::clamp(std::log(std::max(depth_m, 1e-3) / shared::kCausticFirst_m) /
                                      std::log(double(shared::kCausticStep)),
                                  0.0, double(shared::kCausticLevels - 1));
  const auto low = std::min(static_cast<std::uint32_t>(level), shared::kCausticLevels - 2);
  const double seen =
      std::lerp(net.at(low, surface), net.at(low + 1, surface), level - double(low));
  const double scattered = (light.particle_scattering.y + light.water_scattering.y) *
                           std::max(depth_m, 0.0) / light.sun_cosine;
  const double texel_m = net.tile_m / kTexels;
  return 1.0 + (seen - 1.0) * std::exp(-scattered) *
                   std::clamp(depth_m / shared::kCausticFirst_m, 0.0, 1.0) *
                   std::clamp(1.5 - pixel_m / (4.0 * texel_m), 0.0, 1.0);
}

// The sun's light scattered into a sight over that without waves.
double ratio_along(const Net& net, const shared::Lighting& light, const Vec3& direction,
                   double pixel_rad, int parts) {
  const double whole_m = direction.y > 0.0 ? kEyeDepth_m / direction.y : 1e9;
  const double reach_m = std::min(whole_m, kReach_m);
  const double rate = light.beam_attenuation.y - light.diffuse_attenuation.y * direction.y;
  const double step_m = reach_m / parts;
  double sum = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double way_m = (i + 0.5) * step_m;
    sum += std::exp(-rate * way_m) *
           (lit_at(net, light, direction * way_m, way_m * pixel_rad) - 1.0) * step_m;
  }
  return 1.0 + sum * rate / -std::expm1(-std::min(rate * whole_m, 40.0));
}

shared::Lighting light_of(const shared::CausticsParams& params, const render::WaterOptics& optics) {
  shared::Lighting light{};
  light.terms = shared::kLightSun | shared::kLightWater | shared::kLightScattering |
                shared::kLightCaustics | shared::kLightShafts;
  const Vec3f air = glm::normalize(params.travel_air);
  Vec3f travel = air / shared::kWaterIndex;
  travel.y = -std::sqrt(1.0f - travel.x * travel.x - travel.z * travel.z);
  light.to_sun = -travel;
  light.sun_cosine = -travel.y;
  light.surface_irradiance = Vec3f(1.0f);
  light.direct_share = 0.8f;
  light.origin_depth_m = float(kEyeDepth_m);
  light.diffuse_attenuation = Vec3f(optics.diffuse_attenuation_m);
  light.beam_attenuation = Vec3f(optics.beam_attenuation_m());
  light.water_scattering = Vec3f(optics.water_scattering_m);
  light.particle_scattering = Vec3f(optics.particle_scattering_m);
  light.caustic_tile_m = params.tile_m;
  light.exposure = 1.0f;
  return light;
}

}  // namespace

Result<OpticsPoint> shaft_point(gpu::Device& device, std::uint32_t samples, bool quick) {
  const std::uint32_t width = quick ? 128 : 320, height = quick ? 72 : 180;
  const std::uint32_t wide = width / shared::kShaftStep, high = height / shared::kShaftStep;
  shared::CausticsParams params = render::caustics_params(
      scene::Caustics{.texels = kTexels}, glm::normalize(Vec3(0.4, 1.0, 0.2)), 3.0, 7);
  NERITIC_TRY(const render::WaterOptics optics, render::jerlov_optics("IB"));
  const shared::Lighting light = light_of(params, optics);
  render::ViewSet views;
  views.width = width;
  views.height = height;
  render::ViewDesc view;
  view.tangents = tangents_from_fov(radians(55.0), double(width) / height);
  view.near_m = kNear_m;
  view.world_from_view = {Vec3(0.0, -kEyeDepth_m, 0.0),
                          glm::angleAxis(radians(12.0), Vec3(1.0, 0.0, 0.0))};
  view.next_world_from_view = view.world_from_view;
  views.views.push_back(view);
  // Open water: nothing is hit.
  const std::vector<float> depths(std::size_t{width} * height, 0.0f);
  NERITIC_TRY(gpu::Image depth,
              gpu::Image::create(
                  device, {"depth", VK_FORMAT_R32_SFLOAT, width, height, 1, 1,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, true}));
  NERITIC_TRY_STATUS(gpu::upload_image(device, depth, std::as_bytes(std::span(depths))));
  NERITIC_TRY(const auto renderer, render::Renderer::create(device));
  NERITIC_TRY(const auto frames, gpu::Frames::create(device));
  frames->enable_timing(true);
  graph::Executor executor(*frames);
  testbed::ReadbackPool pool;
  OpticsPoint point{"light shafts", samples, 0.0, 1e300};
  for (int repeat = 0; repeat < 4; ++repeat) {
    graph::FrameGraph graph;
    render::GBuffer gbuffer;
    gbuffer.width = width;
    gbuffer.height = height;
    gbuffer.depth = graph.import_image(
        depth, graph::ImportState{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    render::ShaftInputs inputs;
    NERITIC_TRY(inputs.caustics, renderer->declare_caustics(graph, params));
    inputs.samples = samples;
    inputs.params = {static_cast<float>(kReach_m)};
    NERITIC_TRY(const graph::ImageHandle shafts,
                renderer->declare_shafts(graph, "", gbuffer, views, light, inputs));
    NERITIC_TRY(const testbed::Readback net_pin,
                pool.declare(graph, device, "net", inputs.caustics, render::kHdrFormat, kTexels,
                             kTexels, shared::kCausticLayers));
    NERITIC_TRY(const testbed::Readback pin,
                pool.declare(graph, device, "shafts", shafts, VK_FORMAT_R32_SFLOAT, wide, high, 1));
    NERITIC_TRY(gpu::Commands * commands, frames->begin());
    NERITIC_TRY(const graph::Plan* plan, executor.run(graph, *commands));
    (void)plan;
    NERITIC_TRY(const std::uint64_t done, frames->submit());
    NERITIC_TRY_STATUS(frames->wait(done));
    double ms = 0.0;
    for (const gpu::PassTime& pass : frames->pass_times_of(done))
      if (pass.name == "shafts" || pass.name == "shafts blur") ms += pass.ms;
    point.ms = std::min(point.ms, ms * 1e6 / (double(width) * height));
    if (repeat > 0) continue;
    const auto net_halves = net_pin->mapped<std::uint16_t>();
    const Net net{{net_halves.begin(), net_halves.end()}, params.tile_m};
    const auto texels = pin->mapped<float>();
    const shared::View gpu_view = render::gpu_views(views)[0];
    const double pixel_rad = glm::length(Vec3(gpu_view.ray_dx)) * shared::kShaftStep;
    std::vector<double> truth;
    for (std::uint32_t y = 0; y < high; ++y)
      for (std::uint32_t x = 0; x < wide; ++x) {
        const double px = x * shared::kShaftStep + shared::kShaftStep / 2 + 0.5,
                     py = y * shared::kShaftStep + shared::kShaftStep / 2 + 0.5;
        truth.push_back(
            ratio_along(net, light,
                        glm::normalize(Vec3(gpu_view.ray_corner) + px * Vec3(gpu_view.ray_dx) +
                                       py * Vec3(gpu_view.ray_dy)),
                        pixel_rad, quick ? 400 : 3000));
      }
    double sum = 0.0;
    std::size_t count = 0;
    for (std::uint32_t y = 2; y + 2 < high; ++y)
      for (std::uint32_t x = 2; x + 2 < wide; ++x) {
        double wanted = 0.0;
        for (std::uint32_t v = 0; v < 4; ++v)
          for (std::uint32_t u = 0; u < 4; ++u)
            wanted += truth[(y + v - 2) * wide + x + u - 2] / 16.0;
        const double off = ratio_of(texels[std::size_t{y} * wide + x]) - wanted;
        sum += off * off;
        ++count;
      }
    point.error = std::sqrt(sum / static_cast<double>(count));
  }
  return point;
}

}  // namespace neritic::tools
