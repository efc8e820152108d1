// `neritic sonar imaging`: a sonar image from depth and normal images of anyone's making, no scene.
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "sonar/image_gather.hpp"
#include "sonar/offline_input.hpp"
#include "sonar/write_sonar.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;

// A full aperture about dead ahead, or its two edges; radians.
Result<std::pair<double, double>> aperture(const char* flag, const std::string& text) {
  NERITIC_TRY(const auto values, parse_numbers(flag, text, 1, 2));
  if (values.size() == 2) return std::pair{radians(values[0]), radians(values[1])};
  return std::pair{-radians(values[0]) / 2.0, radians(values[0]) / 2.0};
}

Result<sonar::BeamGrid> grid_of(const SonarFlags& flags) {
  sonar::BeamGrid grid;
  NERITIC_TRY(const auto range, parse_numbers("range", flags.range, 2, 2));
  NERITIC_TRY(const auto azimuth, aperture("azimuth", flags.azimuth));
  NERITIC_TRY(const auto elevation, aperture("elevation", flags.elevation));
  NERITIC_TRY(const auto bins, parse_numbers("bins", flags.bins, 3, 3));
  for (const double n : bins)
    if (n != std::floor(n) || n < 1.0 || n > sonar::kMaxBins)
      return bad_input("--bins: {:g} in '{}' found, whole numbers from 1 to {} are accepted", n,
                       flags.bins, sonar::kMaxBins);
  grid.limits = {range[0],       range[1],        azimuth.first,
                 azimuth.second, elevation.first, elevation.second};
  grid.bins = {static_cast<std::uint32_t>(bins[0]), static_cast<std::uint32_t>(bins[1]),
               static_cast<std::uint32_t>(bins[2])};
  const Status valid = sonar::validate(grid);
  if (!valid.ok()) return bad_input("--{}", valid.error().message);
  return grid;
}

Result<sonar::OfflineOptions> options_of(const SonarFlags& flags) {
  sonar::OfflineOptions options;
  options.depth_is_range = flags.depth_kind == "range";
  options.normals_face_sensor = flags.normals_sign == "facing";
  options.axes = flags.axes == "opencv" ? sonar::NormalAxes::kOpencv
                 : flags.axes == "ros"  ? sonar::NormalAxes::kRos
                                        : sonar::NormalAxes::kOpengl;
  NERITIC_TRY(const auto scale, parse_numbers("depth-scale", flags.depth_scale, 1, 1));
  NERITIC_TRY(const auto gamma, parse_numbers("gamma", flags.gamma, 1, 1));
  if (!(scale[0] > 0.0))
    return bad_input("--depth-scale: {:g} found, a positive number is accepted", scale[0]);
  if (!(gamma[0] > 0.0))
    return bad_input("--gamma: {:g} found, a positive number is accepted", gamma[0]);
  options.depth_scale = scale[0];
  options.gamma = gamma[0];
  return options;
}

Result<sonar::Intrinsics> intrinsics_of(const SonarFlags& flags, const sonar::MapFile& depth) {
  sonar::Intrinsics k;
  if (fs::path(flags.intrinsics).extension() == ".json") {
    NERITIC_TRY(k, sonar::read_intrinsics(flags.intrinsics, depth));
  } else {
    NERITIC_TRY(const auto values, parse_numbers("intrinsics", flags.intrinsics, 4, 4));
    k = {values[0], values[1], values[2], values[3]};
  }
  if (!(k.fx > 0.0 && k.fy > 0.0))
    return bad_input("--intrinsics: fx {:g}, fy {:g} found, positive numbers are accepted", k.fx,
                     k.fy);
  if (flags.pixel_centers == "integer") {
    k.cx += 0.5;
    k.cy += 0.5;
  }
  return k;
}

Result<sonar::SonarInput> input_of(const SonarFlags& flags, const sonar::OfflineOptions& options) {
  NERITIC_TRY(const sonar::MapFile depth, sonar::read_map(flags.depth));
  NERITIC_TRY(const sonar::Intrinsics intrinsics, intrinsics_of(flags, depth));
  if (depth.coding != sonar::MapFile::Coding::kNumbers && options.depth_scale == 1.0)
    log_warn("{}: whole numbers taken as metres (--depth-scale 0.001 for millimetres)", depth.path);
  std::optional<sonar::MapFile> normals, labels;
  if (!flags.normals.empty()) {
    NERITIC_TRY(normals, sonar::read_map(flags.normals));
  } else {
    log_warn("no --normals: estimated from the depth image");
  }
  if (!flags.labels.empty()) {
    NERITIC_TRY(labels, sonar::read_map(flags.labels));
  }
  return sonar::make_input(depth, normals ? &*normals : nullptr, labels ? &*labels : nullptr,
                           intrinsics, options);
}

nlohmann::json facts_of(const SonarFlags& flags, const sonar::OfflineOptions& options,
                        const sonar::SonarInput& in) {
  const sonar::Intrinsics& k = in.intrinsics;
  nlohmann::json json{{"kind", flags.kind},
                      {"method", flags.method},
                      {"depth", flags.depth.filename().string()},
                      {"depth_kind", flags.depth_kind},
                      {"depth_scale", options.depth_scale},
                      {"normals", flags.normals.empty() ? "estimated from depth"
                                                        : flags.normals.filename().string()},
                      {"axes", flags.axes},
                      {"normals_sign", flags.normals.empty() ? "facing" : flags.normals_sign},
                      {"gamma", options.gamma},
                      {"image", {in.width, in.height}},
                      {"intrinsics", {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}},
                      {"seed", nullptr}};
  if (!flags.labels.empty()) json["labels"] = flags.labels.filename().string();
  return json;
}

Result<sonar::SonarImage> on_gpu(const SonarFlags& flags, const sonar::BeamGrid& grid,
                                 const sonar::SonarInput& in, nlohmann::json& facts) {
  NERITIC_TRY(const sonar::Gather gather, sonar::gather_of(flags.gather));
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const std::unique_ptr<gpu::Device> device, gpu::Device::create(options));
  NERITIC_TRY(const auto run, sonar::ImageGather::create(*device, grid, std::span(&in, 1), gather));
  NERITIC_TRY(sonar::SonarImage image, run->run());
  facts["gather"] = sonar::name_of(gather);
  facts["device"] = device->info().name;
  facts["timings_ms"]["sonar"] = run->wall_ms();
  for (const gpu::PassTime& pass : run->pass_times()) facts["timings_ms"][pass.name] = pass.ms;
  return image;
}

}  // namespace

Status run_sonar(const SonarFlags& flags) {
  if (flags.kind != "imaging")
    return bad_input("sonar kind: '{}' found, imaging is accepted", flags.kind);
  NERITIC_TRY(const sonar::BeamGrid grid, grid_of(flags));
  const TimeNs start = now_ns();
  NERITIC_TRY(const sonar::OfflineOptions options, options_of(flags));
  NERITIC_TRY(const sonar::SonarInput in, input_of(flags, options));
  nlohmann::json facts = facts_of(flags, options, in);
  facts["timings_ms"]["read"] = to_ms(now_ns() - start);
  sonar::SonarImage image;
  if (flags.method == "reference") {
    const TimeNs begin = now_ns();
    image = sonar::reference_image(grid, std::span(&in, 1));
    facts["timings_ms"]["sonar"] = to_ms(now_ns() - begin);
    facts["device"] = "CPU, double precision";
  } else {
    NERITIC_TRY(image, on_gpu(flags, grid, in, facts));
  }
  return sonar::write_sonar(flags.out, {grid, image}, facts);
}

}  // namespace neritic::tools
