#include "tools/tradeoff/sonar_tradeoff.hpp"

#include <algorithm>
#include <map>

#include "engine/core/refusal.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

using sonar::Gather;

constexpr Gather kGathers[] = {Gather::kNearest, Gather::kPlane, Gather::kPublished};
constexpr NormalCoding kCodings[] = {NormalCoding::kRgb8Gamma, NormalCoding::kRgb8,
                                     NormalCoding::kOctahedral16, NormalCoding::kFloat};
// The resolution at which bins and normals are compared.
constexpr double kMiddleScale = 0.5;

std::vector<double> volume_scales(bool quick) {
  if (quick) return {0.25, 0.5, 1.0};
  return {0.125, 0.18, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0};
}

std::vector<sonar::Bins> bins_of(bool quick) {
  if (quick) return {{100, 100, 100}, {50, 50, 50}};
  return {{500, 500, 500}, {500, 500, 250}, {250, 250, 250}, {125, 125, 125}};
}

struct Setting {
  std::string name;
  std::unique_ptr<RayWorld> world;
  sonar::BeamGrid grid;  // limits of its sonar, finest bins
};

class Sweep {
 public:
  Sweep(gpu::Device& device, const Setting& setting, const SonarTradeoffOptions& options,
        std::vector<Truth> truths, std::map<double, double> raster_ms, std::vector<Point>& points)
      : device_(device),
        setting_(setting),
        options_(options),
        truths_(std::move(truths)),
        raster_ms_(std::move(raster_ms)),
        points_(points) {}

  Status run() {
    for (const double scale : volume_scales(options_.quick)) {
      const auto images = cast(setting_.grid, scale, NormalCoding::kOctahedral16);
      for (const Gather gather : kGathers)
        NERITIC_TRY_STATUS(
            add("resolution", setting_.grid, images, scale, NormalCoding::kOctahedral16, gather));
    }
    for (std::size_t i = 1; i < truths_.size(); ++i) {
      sonar::BeamGrid grid = setting_.grid;
      grid.bins = truths_[i].bins;
      const auto images = cast(grid, kMiddleScale, NormalCoding::kOctahedral16);
      for (const Gather gather : kGathers)
        NERITIC_TRY_STATUS(
            add("bins", grid, images, kMiddleScale, NormalCoding::kOctahedral16, gather));
    }
    for (const NormalCoding coding : kCodings) {
      const auto images = cast(setting_.grid, kMiddleScale, coding);
      for (const Gather gather : kGathers)
        NERITIC_TRY_STATUS(add("normals", setting_.grid, images, kMiddleScale, coding, gather));
    }
    return {};
  }

 private:
  std::vector<sonar::SonarInput> cast(const sonar::BeamGrid& grid, double scale,
                                      NormalCoding coding) const {
    std::vector<sonar::SonarInput> images;
    for (const sonar::Sector& sector : sonar::plan_sectors(grid)) {
      const auto size = sonar::gbuffer_size(grid, sector, scale);
      images.push_back(
          with_normals(cast_gbuffer(*setting_.world, sector, size.width, size.height), coding));
    }
    return images;
  }

  Status add(const char* sweep, const sonar::BeamGrid& grid,
             const std::vector<sonar::SonarInput>& images, double scale, NormalCoding coding,
             Gather gather) {
    const auto truth = std::find_if(truths_.begin(), truths_.end(), [&](const Truth& t) {
      return t.bins.range == grid.bins.range && t.bins.azimuth == grid.bins.azimuth;
    });
    NERITIC_TRY(Point point,
                measure_gather(device_, grid, images, gather, *truth, options_.quick ? 1 : 7));
    point.scene = setting_.name;
    point.sweep = sweep;
    point.images = "rays";
    point.normals = name_of(coding);
    point.scale = scale;
    const auto raster = raster_ms_.find(scale);
    const bool same_bins = grid.bins.elevation == setting_.grid.bins.elevation;
    if (raster != raster_ms_.end() && same_bins) point.raster_ms = raster->second;
    points_.push_back(point);
    options_.step();
    return {};
  }

  gpu::Device& device_;
  const Setting& setting_;
  const SonarTradeoffOptions& options_;
  std::vector<Truth> truths_;
  std::map<double, double> raster_ms_;
  std::vector<Point>& points_;
};

Setting analytic_setting(const SonarTradeoffOptions& options) {
  Setting setting{"analytic", make_analytic_world(), {}};
  setting.grid.bins = bins_of(options.quick).front();
  return setting;
}

Result<Setting> scene_setting(const scene::Scene& scene, const SonarTradeoffOptions& options) {
  if (scene.sonars.empty()) return refusal(scene.path, "no sonar", "a scene with one");
  const scene::Sonar& s = scene.sonars.front();
  Setting setting;
  setting.name = std::filesystem::path(scene.path).stem().string();
  setting.grid = sonar::symmetric_grid(s.range_min_m, s.range_max_m, s.azimuth_rad, s.elevation_rad,
                                       bins_of(options.quick).front());
  NERITIC_TRY(setting.world,
              make_triangle_world(flatten(scene, 0.0, inverse(scene.world_from(s.mount)))));
  return setting;
}

// The renderer's time for the scene's sonar at each scale, and the error of its own images.
Status measure_renderer(gpu::Device& device, scene::Scene scene, const Setting& setting,
                        const Truth& truth, const SonarTradeoffOptions& options,
                        std::map<double, double>& raster_ms, std::vector<Point>& points) {
  scene::Sonar plain = scene.sonars.front();
  plain.bins_range = setting.grid.bins.range;
  plain.bins_azimuth = setting.grid.bins.azimuth;
  plain.bins_elevation = setting.grid.bins.elevation;
  plain.gather = "plane";
  scene.sonars.clear();
  for (const double scale : volume_scales(options.quick)) {
    plain.gbuffer_scale = scale;
    scene.sonars.push_back(plain);
  }
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  session->frames().enable_timing(true);
  for (std::size_t i = 0; i < session->scene().sonars.size(); ++i) {
    FrameRequest request;
    request.sonars = {i};
    request.capture = request.capture.without_geometry();
    std::vector<std::pair<double, double>> times;  // raster, gather
    Point point;
    for (int repeat = 0; repeat < (options.quick ? 2 : 6); ++repeat) {
      NERITIC_TRY(const FrameResult frame, session->render(request));
      if (repeat == 0) {
        point.error = compare(frame.sonars[0].image.intensity, truth,
                              setting.grid.limits.range_max_m - setting.grid.limits.range_min_m);
        continue;
      }
      double raster = 0.0, gather = 0.0;
      for (const gpu::PassTime& pass : frame.passes) {
        if (pass.name == "record") continue;
        const bool gathers = pass.name.find("sonar gather") != std::string::npos ||
                             pass.name.find("sonar clear") != std::string::npos;
        (gathers ? gather : raster) += pass.ms;
      }
      times.emplace_back(raster, gather);
    }
    std::sort(times.begin(), times.end());
    point.raster_ms = times.front().first;
    point.gather_ms = times.front().second;
    point.scene = setting.name;
    point.sweep = "renderer";
    point.images = "renderer";
    point.gather = "plane";
    point.normals = name_of(NormalCoding::kOctahedral16);
    point.scale = volume_scales(options.quick)[i];
    const auto size =
        sonar::gbuffer_size(setting.grid, sonar::plan_sectors(setting.grid).front(), point.scale);
    point.width = size.width;
    point.height = size.height;
    point.bins = setting.grid.bins;
    raster_ms[point.scale] = point.raster_ms;
    points.push_back(point);
    options.step();
  }
  return {};
}

std::vector<Truth> truths_for(const Setting& setting, bool quick) {
  std::vector<Truth> truths =
      trace_truth(*setting.world, setting.grid, bins_of(quick), quick ? 4 : 8);
  return truths;
}

}  // namespace

namespace {

// Enough to see that it works.
void make_small(KindSetting& kind) {
  const bool one_beam =
      kind.base.bins_azimuth == 1 || kind.base.kind == scene::SonarKind::kEchoSounder;
  if (!one_beam) {
    kind.base.bins_range /= 4;
    kind.base.bins_azimuth /= 4;
  }
  kind.middle.rows = std::max(std::min(kind.middle.rows, 64u), kind.middle.rows / 4);
  kind.shots.resize(1);
}

// Each kind in the scene, with the triangles as rays see them about its first sonar.
Status measure_kinds(gpu::Device& device, const scene::Scene& scene,
                     const SonarTradeoffOptions& options, SonarTradeoff& out) {
  const Pose place = place_of(scene);
  NERITIC_TRY(const auto world,
              make_triangle_world(flatten(scene, 0.0, Pose{-place.position_m, Quat(1, 0, 0, 0)})));
  const RayHit below = world->cast(Vec3(0, -1, 0));
  // Over open water the fans look as far as they would 5 m above a bottom.
  const double altitude_m = below.t > 0.0 ? below.t : 5.0;
  out.kinds_scene = std::filesystem::path(scene.path).stem().string();
  for (KindSetting& kind : kind_settings(scene, altitude_m)) {
    if (!options.kind.empty() && options.kind != scene::name_of(kind.base.kind)) continue;
    if (options.quick) make_small(kind);
    NERITIC_TRY(KindResult result, sweep_kind(device, scene, *world, kind,
                                              {options.quick, options.step, options.now}));
    out.kinds.push_back(std::move(result));
    NERITIC_TRY_STATUS(options.part_done(out.kinds.back().kind, out));
  }
  return {};
}

std::uint64_t plain_steps(const SonarTradeoffOptions& options) {
  if (!options.kind.empty()) return 0;
  const std::uint64_t sweeps =
      std::size(kGathers) * (volume_scales(options.quick).size() + bins_of(options.quick).size() -
                             1 + std::size(kCodings));
  return options.scene.empty() ? sweeps + 1
                               : 2 * (sweeps + 1) + volume_scales(options.quick).size();
}

Status measure_plain(gpu::Device& device, const SonarTradeoffOptions& options, SonarTradeoff& out) {
  if (!options.scene.empty()) {
    NERITIC_TRY(const scene::Scene scene, scene::load_scene(options.scene));
    NERITIC_TRY(const Setting setting, scene_setting(scene, options));
    const auto truths = truths_for(setting, options.quick);
    options.step();
    std::map<double, double> raster_ms;
    NERITIC_TRY_STATUS(
        measure_renderer(device, scene, setting, truths.front(), options, raster_ms, out.points));
    NERITIC_TRY_STATUS(Sweep(device, setting, options, truths, raster_ms, out.points).run());
  }
  const Setting analytic = analytic_setting(options);
  const auto truths = truths_for(analytic, options.quick);
  options.step();
  return Sweep(device, analytic, options, truths, {}, out.points).run();
}

}  // namespace

std::uint64_t steps(const SonarTradeoffOptions& options) {
  std::uint64_t count = plain_steps(options);
  using enum scene::SonarKind;
  for (const auto kind : {kImaging, kProfiling, kEchoSounder, kSideScan, kMechanical})
    if (!options.scene.empty() && (options.kind.empty() || options.kind == scene::name_of(kind)))
      count += kind_steps(kind, options.quick);
  return count;
}

Result<SonarTradeoff> run_sonar_tradeoff(const SonarTradeoffOptions& options) {
  gpu::DeviceOptions device_options;
  device_options.device = options.device;
  device_options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  SonarTradeoff out;
  out.device = device->info().name;
  out.quick = options.quick;
  out.rays_a_cell = options.quick ? 16 : 64;
  if (options.kind.empty()) {
    options.now("the plain cosine");
    NERITIC_TRY_STATUS(measure_plain(*device, options, out));
    NERITIC_TRY_STATUS(options.part_done("plain", out));
  }
  if (!options.scene.empty()) {
    NERITIC_TRY(const scene::Scene scene, scene::load_scene(options.scene));
    if (scene.sonars.empty()) return refusal(scene.path, "no sonar", "a scene with one");
    NERITIC_TRY_STATUS(measure_kinds(*device, scene, options, out));
  }
  return out;
}

}  // namespace neritic::tools
