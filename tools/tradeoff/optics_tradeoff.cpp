#include "tools/tradeoff/optics_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/render/caustic_waves.hpp"
#include "engine/render/renderer.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/session.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/bands_error.hpp"
#include "tools/tradeoff/shaft_error.hpp"
#include "tools/tradeoff/skylight_error.hpp"

namespace neritic::tools {
namespace {

// Type II in the green, 1/m: particles' b, pure water's b, c.
constexpr double kParticles = 0.357, kWater = 0.0019, kBeam = 0.42;

// --- Inscatter -----------------------------------------------------------------------------------

// Henyey and Greenstein 1941 with g = 0.924, and Morel 1974 for pure water, 1/m sr.
double scattered_at(double cosine) {
  constexpr double g = 0.924;
  const double d = 1.0 + g * g - 2.0 * g * cosine;
  return kParticles * (1.0 - g * g) / (4.0 * kPi * d * std::sqrt(d)) +
         kWater * 0.06225 * (1.0 + 0.835 * cosine * cosine);
}

struct Sight {
  Vec3 from_lamp, direction;  // of the eye; unit
  double length_m;
};

// The light that a candela sends along the sight from a metre at t.
double source_at(const Sight& sight, double t) {
  const Vec3 travel = sight.from_lamp + sight.direction * t;
  const double way = std::max(glm::length(travel), 0.05);
  return scattered_at(glm::dot(travel / way, -sight.direction)) * std::exp(-kBeam * (way + t)) /
         (way * way);
}

// Brute force: the midpoint rule with steps of even length.
double inscatter_truth(const Sight& sight, int parts) {
  double sum = 0.0;
  const double step = sight.length_m / parts;
  for (int i = 0; i < parts; ++i) sum += source_at(sight, (i + 0.5) * step) * step;
  return sum;
}

// As shading does: samples at even angles as the lamp sees the sight (shaders/shared/water.glsl).
double inscatter_of(const Sight& sight, std::uint32_t samples) {
  const double nearest = -glm::dot(sight.from_lamp, sight.direction);
  const double aside = std::max(glm::length(sight.from_lamp + sight.direction * nearest), 0.05);
  const double first = std::atan((0.0 - nearest) / aside),
               last = std::atan((sight.length_m - nearest) / aside);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const double angle = first + (last - first) * (i + 0.5) / samples;
    const double t = nearest + aside * std::tan(angle), cosine = std::cos(angle);
    sum += source_at(sight, t) * aside / (cosine * cosine);
  }
  return sum * (last - first) / samples;
}

// Lamps beside the eye and farther off, sights past them and towards them.
double inscatter_error(std::uint32_t samples, int parts) {
  double sum = 0.0;
  int count = 0;
  for (const Vec3& lamp : {Vec3(0.2, 0.1, 0.0), Vec3(0.6, 0.3, -0.5), Vec3(1.5, 0.0, -3.0)})
    for (const double turn_deg : {-20.0, 0.0, 15.0})
      for (const double length_m : {1.0, 4.0, 12.0}) {
        const Sight sight{
            -lamp, Vec3(std::sin(radians(turn_deg)), 0.0, -std::cos(radians(turn_deg))), length_m};
        const double off = inscatter_of(sight, samples) / inscatter_truth(sight, parts) - 1.0;
        sum += off * off;
        ++count;
      }
  return std::sqrt(sum / count);
}

// Shading's time with one lamp in open water, less that without it.
Result<double> inscatter_ms(gpu::Device& device, std::uint32_t samples, bool quick) {
  double shade[2] = {1e300, 1e300};
  const std::uint32_t width = quick ? 64 : 640, height = quick ? 36 : 360;
  for (const bool lit : {false, true}) {
    scene::Scene scene;
    scene.path = "optics";
    scene.water = scene::Water{.type = "II", .scattering = true};
    scene::Camera camera;
    camera.name = "eye";
    camera.width = width;
    camera.height = height;
    camera.mount.pose.position_m = Vec3(0.0, -20.0, 0.0);
    camera.detail.inscatter_samples = samples;
    scene.cameras.push_back(camera);
    scene::Lamp lamp;
    lamp.mount.pose.position_m = Vec3(0.3, -19.9, 0.0);
    if (lit) scene.lamps.push_back(lamp);
    NERITIC_TRY(const auto session, testbed::Session::create(device, std::move(scene)));
    for (int i = 0; i < 4; ++i) {
      testbed::FrameRequest request;
      request.cameras = {0};
      request.capture = testbed::Capture{.motion = false}.without_geometry();
      NERITIC_TRY(const testbed::FrameResult result, session->render(request));
      for (const gpu::PassTime& pass : result.passes)
        if (pass.name == "eye shade") shade[lit] = std::min(shade[lit], pass.ms);
    }
  }
  return std::max(shade[1] - shade[0], 0.0) * 1e6 / (double(width) * height);
}

// --- Caustics ------------------------------------------------------------------------------------

constexpr std::uint32_t kBins = 48;  // a side, on which light is compared
constexpr std::uint32_t kLevel = 6;  // of the depths, 1.60 m

// Vector form of Snell's law, into water.
Vec3 refracted(const Vec3& travel, const Vec3& normal) {
  const double ratio = 1.0 / shared::kWaterIndex, cosine = -glm::dot(travel, normal);
  return ratio * travel +
         (ratio * cosine - std::sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine))) * normal;
}

// Light on the level over that under flat water, by this number of rays a side of the tile.
std::vector<double> caustics_truth(const shared::CausticsParams& params, int rays) {
  std::vector<double> light(kBins * kBins, 0.0);
  const double depth_m = shared::kCausticFirst_m * std::pow(shared::kCausticStep, kLevel);
  const double tile_m = params.tile_m;
  const Vec3 air = glm::normalize(Vec3(params.travel_air));
  const Vec3 flat = refracted(air, Vec3(0.0, 1.0, 0.0));
  for (int j = 0; j < rays; ++j)
    for (int i = 0; i < rays; ++i) {
      const double x = (i + 0.5) * tile_m / rays, z = (j + 0.5) * tile_m / rays;
      Vec2 slope(0.0);
      for (std::uint32_t w = 0; w < params.count; ++w) {
        const Vec2 number(params.waves[w].wave_number);
        slope -= params.waves[w].amplitude_m *
                 std::sin(number.x * x + number.y * z + params.waves[w].angle_rad) * number;
      }
      const Vec3 below = refracted(air, glm::normalize(Vec3(-slope.x, 1.0, -slope.y)));
      const double u = x + depth_m * (below.x / -below.y - flat.x / -flat.y),
                   v = z + depth_m * (below.z / -below.y - flat.z / -flat.y);
      const auto bin = [&](double place) {
        const double whole = place / tile_m - std::floor(place / tile_m);
        return std::min(static_cast<std::uint32_t>(whole * kBins), kBins - 1);
      };
      light[bin(v) * kBins + bin(u)] += double(kBins) * kBins / (double(rays) * rays);
    }
  return light;
}

Result<OpticsPoint> caustics_point(gpu::Device& device, std::uint32_t texels, int rays) {
  const scene::Caustics caustics{.texels = texels};
  const shared::CausticsParams params =
      render::caustics_params(caustics, glm::normalize(Vec3(0.4, 1.0, 0.2)), 3.0, 7);
  OpticsPoint point{"caustics", texels, 0.0, 1e300};
  NERITIC_TRY(const auto renderer, render::Renderer::create(device));
  NERITIC_TRY(const auto frames, gpu::Frames::create(device));
  frames->enable_timing(true);
  graph::Executor executor(*frames);
  testbed::ReadbackPool pool;
  std::vector<double> light(kBins * kBins, 0.0);
  for (int repeat = 0; repeat < 4; ++repeat) {
    graph::FrameGraph graph;
    NERITIC_TRY(const graph::ImageHandle image, renderer->declare_caustics(graph, params));
    NERITIC_TRY(const testbed::Readback pin,
                pool.declare(graph, device, "caustics", image, render::kHdrFormat, texels, texels,
                             shared::kCausticLayers));
    NERITIC_TRY(gpu::Commands * commands, frames->begin());
    NERITIC_TRY(const graph::Plan* plan, executor.run(graph, *commands));
    (void)plan;
    NERITIC_TRY(const std::uint64_t done, frames->submit());
    NERITIC_TRY_STATUS(frames->wait(done));
    double ms = 0.0;
    for (const gpu::PassTime& pass : frames->pass_times_of(done))
      if (pass.name.starts_with("caustics") && pass.name.find("readback") == std::string::npos)
        ms += pass.ms;
    point.ms = std::min(point.ms, ms);
    if (repeat > 0) continue;
    const auto halves = pin->mapped<std::uint16_t>();
    const std::uint32_t part = texels / kBins;
    for (std::uint32_t y = 0; y < texels; ++y)
      for (std::uint32_t x = 0; x < texels; ++x) {
        const std::size_t texel =
            (std::size_t{kLevel / shared::kCausticLayerStep} * texels + y) * texels + x;
        light[(y / part) * kBins + x / part] +=
            glm::unpackHalf1x16(halves[texel * 4 + kLevel % shared::kCausticLayerStep]) /
            (double(part) * part);
      }
  }
  const std::vector<double> truth = caustics_truth(params, rays);
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += (light[i] - truth[i]) * (light[i] - truth[i]);
  point.error = std::sqrt(sum / static_cast<double>(truth.size()));
  return point;
}

// --- Forward scatter -----------------------------------------------------------------------------

constexpr std::uint32_t kWide = 2048, kHigh = 64;
constexpr double kPixelsRad = 692.0;  // of 1280 x 720 at 55 degrees

// Wells 1973: contrast of psi cycles a radian after a distance, theta_0 = 0.03. Its brackets are
// the integral of the phase function's share that a frequency loses; here by steps over the angle.
double wells_contrast(double psi, double distance_m, int parts) {
  // (1 - exp(-x)) / x is the mean of exp(-x u) over u in [0, 1].
  const double x = 2.0 * kPi * 0.03 * psi;
  double mean = 0.0;
  for (int i = 0; i < parts; ++i) mean += std::exp(-x * (i + 0.5) / parts) / parts;
  return std::exp(-(kBeam - kParticles * mean) * distance_m);
}

Result<gpu::Image> picture_of(gpu::Device& device, const char* name,
                              const std::function<Vec4(int)>& column) {
  NERITIC_TRY(
      gpu::Image image,
      gpu::Image::create(device, {name, render::kHdrFormat, kWide, kHigh, 1, 1,
                                  VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                  true}));
  std::vector<std::uint16_t> texels;
  for (std::uint32_t y = 0; y < kHigh; ++y)
    for (std::uint32_t x = 0; x < kWide; ++x)
      for (int i = 0; i < 4; ++i)
        texels.push_back(glm::packHalf1x16(static_cast<float>(column(static_cast<int>(x))[i])));
  NERITIC_TRY_STATUS(gpu::upload_image(device, image, std::as_bytes(std::span(texels))));
  return image;
}

// Contrast that the passes leave of stripes; ms: of them.
Result<double> contrast_left(gpu::Device& device, double psi, double distance_m,
                             std::uint32_t octaves, double& ms) {
  shared::Lighting light{};
  light.terms = shared::kLightWater | shared::kLightForwardScatter;
  light.particle_scattering = Vec3f(float(kParticles));
  light.beam_attenuation = Vec3f(float(kBeam));
  const auto stripes = [&](int x) {
    return std::cos(2.0 * kPi * psi * (x + 0.5 - double(kWide) / 2) / kPixelsRad);
  };
  const double scale = 100.0 * std::exp((kBeam - kParticles) * distance_m);
  const double sharp = scale * std::exp(-kBeam * distance_m),
               kept = scale * std::exp(-(kBeam - kParticles) * distance_m);
  NERITIC_TRY(const gpu::Image hdr, picture_of(device, "picture", [&](int x) {
                return Vec4(Vec3(sharp * stripes(x) + 300.0), 1.0);
              }));
  NERITIC_TRY(const gpu::Image scattered, picture_of(device, "scattered", [&](int x) {
                return Vec4(Vec3(kept * stripes(x)), distance_m);
              }));
  render::WaterPasses passes(device);
  render::ViewSet views;
  views.width = kWide;
  views.height = kHigh;
  views.views.resize(1);
  const double top = 0.5 * kHigh / kPixelsRad, right = 0.5 * kWide / kPixelsRad;
  views.views[0].tangents = {-right, right, -top, top};
  render::GBuffer gbuffer;
  gbuffer.width = kWide;
  gbuffer.height = kHigh;
  NERITIC_TRY(const auto frames, gpu::Frames::create(device));
  frames->enable_timing(true);
  graph::Executor executor(*frames);
  graph::FrameGraph graph;
  const graph::ImportState state{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  NERITIC_TRY(const graph::ImageHandle out,
              passes.declare_forward_scatter(graph, "", graph.import_image(hdr, state),
                                             graph.import_image(scattered, state), gbuffer, views,
                                             light, {.angle_rad = 0.03, .levels = octaves}));
  graph.output(out, graph::Access::kTransferRead);
  NERITIC_TRY(gpu::Commands * commands, frames->begin());
  NERITIC_TRY(const graph::Plan* plan, executor.run(graph, *commands));
  (void)plan;
  NERITIC_TRY(const std::uint64_t done, frames->submit());
  NERITIC_TRY_STATUS(frames->wait(done));
  for (const gpu::PassTime& pass : frames->pass_times_of(done))
    if (pass.name == "forward scatter") ms = std::min(ms, pass.ms * 1e6 / (double(kWide) * kHigh));
  NERITIC_TRY(const std::vector<std::byte> bytes,
              gpu::read_image(device, hdr, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
  const auto* halves = reinterpret_cast<const std::uint16_t*>(bytes.data());
  const double period = kPixelsRad / psi;
  const int half = static_cast<int>(std::max(1.0, std::floor(384.0 / period)) * period);
  double sum = 0.0, norm = 0.0;
  for (int x = int(kWide) / 2 - half; x < int(kWide) / 2 + half; ++x) {
    const auto at = static_cast<std::size_t>(4 * (int(kHigh) / 2 * int(kWide) + x) + 1);
    sum += (glm::unpackHalf1x16(halves[at]) - 300.0) * stripes(x);
    norm += stripes(x) * stripes(x);
  }
  return sum / norm / scale;
}

std::vector<std::uint32_t> samples_of(bool quick) {
  return quick ? std::vector<std::uint32_t>{2, 8} : std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32};
}
std::vector<std::uint32_t> texels_of(bool quick) {
  return quick ? std::vector<std::uint32_t>{48, 96}
               : std::vector<std::uint32_t>{48, 96, 144, 192, 288, 384, 576};
}
std::vector<std::uint32_t> octaves_of(bool quick) {
  return quick ? std::vector<std::uint32_t>{3, 7} : std::vector<std::uint32_t>{2, 3, 4, 5, 6, 7, 8};
}

std::vector<std::uint32_t> shaft_samples_of(bool quick) {
  return quick ? std::vector<std::uint32_t>{4, 12}
               : std::vector<std::uint32_t>{2, 4, 8, 12, 24, 48};
}

std::vector<std::uint32_t> skylight_cells_of(bool quick) {
  return quick ? std::vector<std::uint32_t>{80, 40}
               : std::vector<std::uint32_t>{160, 80, 40, 20, 10};
}

}  // namespace

std::uint64_t steps(const OpticsTradeoffOptions& options) {
  return samples_of(options.quick).size() + texels_of(options.quick).size() +
         octaves_of(options.quick).size() + shaft_samples_of(options.quick).size() +
         skylight_cells_of(options.quick).size() + std::size(kBandCounts);
}

Result<OpticsTradeoff> run_optics_tradeoff(const OpticsTradeoffOptions& options) {
  gpu::DeviceOptions device_options;
  device_options.device = options.device;
  device_options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  OpticsTradeoff out{device->info().name, {}};
  for (const std::uint32_t samples : samples_of(options.quick)) {
    NERITIC_TRY(const double ms, inscatter_ms(*device, samples, options.quick));
    out.points.push_back(
        {"inscatter", samples, inscatter_error(samples, options.quick ? 20'000 : 200'000), ms});
    options.step();
  }
  for (const std::uint32_t texels : texels_of(options.quick)) {
    NERITIC_TRY(OpticsPoint point, caustics_point(*device, texels, options.quick ? 480 : 2400));
    out.points.push_back(std::move(point));
    options.step();
  }
  for (const std::uint32_t octaves : octaves_of(options.quick)) {
    OpticsPoint point{"forward scatter", octaves, 0.0, 1e300};
    for (const double distance_m : {5.0, 20.0})
      for (const double psi : {2.0, 5.0, 12.0, 40.0}) {
        NERITIC_TRY(const double left, contrast_left(*device, psi, distance_m, octaves, point.ms));
        point.error =
            std::max(point.error, std::abs(left - wells_contrast(psi, distance_m, 10'000)));
      }
    out.points.push_back(std::move(point));
    options.step();
  }
  for (const std::uint32_t samples : shaft_samples_of(options.quick)) {
    NERITIC_TRY(OpticsPoint point, shaft_point(*device, samples, options.quick));
    out.points.push_back(std::move(point));
    options.step();
  }
  for (const std::uint32_t cell_cm : skylight_cells_of(options.quick)) {
    out.points.push_back(skylight_point(cell_cm, options.quick));
    options.step();
  }
  for (const std::uint32_t bands : kBandCounts) {
    NERITIC_TRY(OpticsPoint point, bands_point(*device, bands, options.quick));
    out.points.push_back(std::move(point));
    options.step();
  }
  return out;
}

Result<bool> write_optics_tradeoff(const std::filesystem::path& folder,
                                   const OpticsTradeoff& tradeoff) {
  std::string csv = "term,value,error,ms\n";
  std::string md = fmt::format(
      "# The water's optics: error over cost\n\n{}. Against brute force in double.\n\n"
      "- inscatter: a lamp's beam along 27 sights by samples at even angles, root mean square of "
      "the relative error against steps of even length; ms a lamp and megapixel.\n"
      "- caustics: light 1.60 m under a tile of 6 m by texels a side, root mean square on 48 x 48 "
      "squares (mean 1) against rays refracted one by one; ms a tile.\n"
      "- forward scatter: contrast of 2 to 40 cycles a radian at 5 and 20 m by octaves, largest "
      "difference from Wells's integral; ms a megapixel.\n"
      "- light shafts: the sun's light along sights in type IB from 3 m, by samples, root mean "
      "square against steps of even length; ms a megapixel.\n"
      "- skylight: the share of the sky's light in and about a hold with a door and a hatch, by "
      "centimetres a cell, root mean square against rays; ms of the host, once, for 1 176 m3.\n"
      "- bands: largest CIEDE2000 of a white card from 1 to 20 m in types I, III and 5C against "
      "every nanometre; ms a megapixel of open water.\n\n| term | value | error | ms "
      "|\n|---|---|---|---|\n",
      tradeoff.device);
  nlohmann::json json{{"device", tradeoff.device}};
  Page page{"The water's optics: error over cost", {tradeoff.device}};
  page.columns = 3;
  for (const char* term :
       {"inscatter", "caustics", "forward scatter", "light shafts", "skylight", "bands"}) {
    Panel panel{term, {"device, ms"}, {"error"}};
    Series series{term, {}, {}};
    for (const OpticsPoint& p : tradeoff.points) {
      if (p.term != term) continue;
      csv += fmt::format("{},{},{:.6g},{:.4g}\n", p.term, p.value, p.error, p.ms);
      md += fmt::format("| {} | {} | {:.4f} | {:.2f} |\n", p.term, p.value, p.error, p.ms);
      json["points"].push_back(
          {{"term", p.term}, {"value", p.value}, {"error", p.error}, {"ms", p.ms}});
      series.x.push_back(std::max(p.ms, 1e-3));
      series.y.push_back(p.error);
      series.notes.push_back(fmt::format("{}", p.value));
    }
    panel.series.push_back(std::move(series));
    page.panels.push_back(std::move(panel));
  }
  NERITIC_TRY(const std::string cards, card_table());
  md += cards;
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "optics.csv", csv));
  NERITIC_TRY_STATUS(write_text(folder / "optics.md", md));
  NERITIC_TRY_STATUS(write_json(folder / "optics.json", json));
  return write_picture(folder / "optics.png", page_data(page));
}

}  // namespace neritic::tools
