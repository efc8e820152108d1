#include "tools/tradeoff/camera_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/sensors/session.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/flip.hpp"

namespace neritic::tools {
namespace {

using scene::PictureDetail;

struct KnobSetting {
  std::string knob, value;
  PictureDetail detail;
};

// Each knob over its range, the others at the level "standard"; then the levels.
std::vector<KnobSetting> settings_of(bool quick) {
  std::vector<KnobSetting> out;
  const auto knob = [&](const std::string& name, const std::vector<double>& values, auto turn) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (quick && i > 0 && i + 1 < values.size()) continue;
      KnobSetting setting{name, fmt::format("{:g}", values[i]), {}};
      turn(setting.detail, values[i]);
      out.push_back(std::move(setting));
    }
  };
  const auto whole = [](double value) { return static_cast<std::uint32_t>(value); };
  knob("resolution", {0.25, 0.35, 0.5, 0.7, 0.85, 1.0, 2.0},
       [](PictureDetail& d, double v) { d.resolution = v; });
  knob("shadow_size", {0.125, 0.25, 0.5, 1.0, 2.0},
       [](PictureDetail& d, double v) { d.shadow_size = v; });
  knob("cascades", {1, 2, 3, 4}, [&](PictureDetail& d, double v) { d.cascades = whole(v); });
  knob("shadow_samples", {3, 5, 7, 9, 18},
       [&](PictureDetail& d, double v) { d.shadow_samples = whole(v); });
  knob("visibility_step", {4, 3, 2, 1},
       [&](PictureDetail& d, double v) { d.visibility_step = whole(v); });
  knob("mesh_error", {2.5, 2.0, 1.0, 0.5, 0.25, 0.0},
       [](PictureDetail& d, double v) { d.mesh_error = v; });
  knob("occlusion_samples", {0.25, 0.5, 1.0, 2.0, 4.0},
       [](PictureDetail& d, double v) { d.occlusion_samples = v; });
  knob("shaft_samples", {0.25, 0.5, 1, 2},
       [&](PictureDetail& d, double v) { d.shaft_samples = v; });
  knob("inscatter_samples", {1, 2, 4, 8, 16},
       [&](PictureDetail& d, double v) { d.inscatter_samples = whole(v); });
  knob("waves", {4, 12, 24, 48}, [&](PictureDetail& d, double v) { d.waves = whole(v); });
  knob("scatter_levels", {2, 4, 6, 8},
       [&](PictureDetail& d, double v) { d.scatter_levels = whole(v); });
  knob("particles", {0.0, 0.25, 0.5, 1.0}, [](PictureDetail& d, double v) { d.particles = v; });
  for (const std::string_view level : scene::kPictureLevels)
    out.push_back({"level", std::string(level), scene::picture_level(level).detail});
  return out;
}

struct Shown {
  ImageU8 color;
  double ms = 1e300;
};

Result<Shown> show(testbed::Session& session, const PictureDetail& detail, int repeats) {
  const scene::Camera& camera = session.scene().cameras.front();
  Shown out;
  for (int i = 0; i < repeats; ++i) {
    testbed::FrameRequest request;
    request.views.push_back({.name = camera.name,
                             .views = testbed::camera_views(session.scene(), camera),
                             .exposure = camera.exposure,
                             .antialias = camera.antialias,
                             .detail = detail,
                             .capture = testbed::Capture{.motion = false}.without_geometry()});
    NERITIC_TRY(testbed::FrameResult result, session.render(request));
    double ms = 0.0;
    for (const gpu::PassTime& pass : result.passes)
      if (pass.name != "record" && pass.name.find("readback") == std::string::npos) ms += pass.ms;
    // The first frame draws what later ones keep: maps of what stands still.
    if (i > 0 || repeats == 1) out.ms = std::min(out.ms, ms);
    out.color = std::move(result.views[0].eyes[0].color);
  }
  return out;
}

std::string psnr(double error) {
  return error > 0.0 ? fmt::format("{:.1f}", -20.0 * std::log10(error)) : "exact";
}

}  // namespace

std::uint64_t steps(const CameraTradeoffOptions& options) {
  return settings_of(options.quick).size();
}

double rms_error(const ImageU8& shown, const ImageU8& wanted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < wanted.data.size(); ++i) {
    const double off = (int(shown.data[i]) - int(wanted.data[i])) / 255.0;
    sum += off * off;
  }
  return wanted.data.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(wanted.data.size()));
}

Result<CameraTradeoff> run_camera_tradeoff(const CameraTradeoffOptions& options) {
  gpu::DeviceOptions device_options;
  device_options.device = options.device;
  device_options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  NERITIC_TRY(scene::Scene scene, scene::load_scene(options.scene));
  if (scene.cameras.empty()) return refusal(options.scene, "no camera", "a scene with a camera");
  scene::Camera& camera = scene.cameras.front();
  camera.stereo_baseline_m = 0.0;
  if (options.quick) {
    camera.width = std::max(camera.width / 8, 16u);
    camera.height = std::max(camera.height / 8, 16u);
  }
  CameraTradeoff out{device->info().name, options.scene, camera.name,
                     camera.width,        camera.height, {}};
  NERITIC_TRY(const auto session, testbed::Session::create(*device, std::move(scene)));
  // Every knob at its best, with four times the pixels of the level "reference".
  PictureDetail best_detail = scene::picture_level("reference").detail;
  best_detail.resolution = scene::kMostResolution;
  NERITIC_TRY(const Shown best, show(*session, best_detail, 1));
  for (const KnobSetting& setting : settings_of(options.quick)) {
    NERITIC_TRY(const Shown shown, show(*session, setting.detail, options.quick ? 2 : 4));
    out.points.push_back({setting.knob, setting.value, shown.ms, rms_error(shown.color, best.color),
                          flip_error(shown.color, best.color)});
    options.step();
  }
  return out;
}

Result<bool> write_camera_tradeoff(const std::filesystem::path& folder,
                                   const CameraTradeoff& tradeoff) {
  std::string csv = "knob,value,ms,error,psnr_db,flip\n";
  std::string md = fmt::format(
      "# A camera's picture: error over cost\n\n{}; `{}`, camera {}, {} x {}. Against "
      "`reference` with a resolution of 4; the other knobs are those of `standard`. ms: all passes "
      "of the "
      "device, maps of what stands still kept. Error: root mean square, 1 from black to white. "
      "FLIP: how much an eye sees of it, 0 to 1 (Andersson et al. 2020), at 67 pixels a "
      "degree.\n\n| knob | value | ms | error | "
      "PSNR, dB | FLIP |\n|---|---|---|---|---|---|\n",
      tradeoff.device, tradeoff.scene, tradeoff.camera, tradeoff.width, tradeoff.height);
  nlohmann::json json{{"device", tradeoff.device},
                      {"scene", tradeoff.scene},
                      {"camera", tradeoff.camera},
                      {"size", {tradeoff.width, tradeoff.height}}};
  Page page{"A camera's picture: error over cost",
            {fmt::format("{}, camera {} of {}, {} x {}", tradeoff.device, tradeoff.camera,
                         tradeoff.scene, tradeoff.width, tradeoff.height)}};
  Panel plain{"Root mean square", {"device, ms a frame"}, {"error, 1 from black to white"}};
  Panel seen{"As an eye sees it", {"device, ms a frame"}, {"FLIP, 0 to 1"}};
  for (std::size_t i = 0; i < tradeoff.points.size();) {
    const std::string& knob = tradeoff.points[i].knob;
    Series errors{knob, {}, {}}, eyes{knob, {}, {}};
    for (; i < tradeoff.points.size() && tradeoff.points[i].knob == knob; ++i) {
      const CameraPoint& p = tradeoff.points[i];
      csv += fmt::format("{},{},{:.3f},{:.6f},{},{:.6f}\n", p.knob, p.value, p.ms, p.error,
                         psnr(p.error), p.flip);
      md += fmt::format("| {} | {} | {:.1f} | {:.4f} | {} | {:.4f} |\n", p.knob, p.value, p.ms,
                        p.error, psnr(p.error), p.flip);
      json["points"].push_back({{"knob", p.knob},
                                {"value", p.value},
                                {"ms", p.ms},
                                {"error", p.error},
                                {"flip", p.flip}});
      for (Series* series : {&errors, &eyes}) {
        series->x.push_back(p.ms);
        series->notes.push_back(p.value);
      }
      errors.y.push_back(std::max(p.error, 1e-5));
      eyes.y.push_back(std::max(p.flip, 1e-6));
    }
    plain.series.push_back(std::move(errors));
    seen.series.push_back(std::move(eyes));
  }
  page.panels = {std::move(plain), std::move(seen)};
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "camera.csv", csv));
  NERITIC_TRY_STATUS(write_text(folder / "camera.md", md));
  NERITIC_TRY_STATUS(write_json(folder / "camera.json", json));
  return write_picture(folder / "camera.png", page_data(page));
}

}  // namespace neritic::tools
