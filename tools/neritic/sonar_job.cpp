#include "tools/neritic/sonar_job.hpp"

#include <cmath>
#include <tuple>

#include "engine/core/refusal.hpp"
#include "engine/scene/sonar_file.hpp"
#include "sonar/detection.hpp"
#include "testbed/sensors/session.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

using scene::SonarKind;

// Without --sensor: imaging as published, the others as the presets of assets/sensors.
scene::Sonar default_sonar(SonarKind kind) {
  scene::Sonar s;  // imaging
  s.kind = kind;
  const auto put = [&s](double nearest_m, double farthest_m, double azimuth_deg,
                        double elevation_deg, const sonar::Bins& bins) {
    s.range_min_m = nearest_m;
    s.range_max_m = farthest_m;
    s.azimuth_rad = radians(azimuth_deg);
    s.elevation_rad = radians(elevation_deg);
    s.semi_angle_rad = radians(azimuth_deg / 2.0);
    s.bins_range = bins.range;
    s.bins_azimuth = bins.azimuth;
    s.bins_elevation = bins.elevation;
  };
  if (kind == SonarKind::kProfiling) put(1.0, 30.0, 90.0, 0.5, {500, 500, 8});
  if (kind == SonarKind::kEchoSounder) put(0.3, 50.0, 25.0, 25.0, {200, 32, 32});
  if (kind == SonarKind::kSideScan) put(1.0, 100.0, 1.7, 60.0, {2000, 8, 256});
  return s;
}

Result<SonarKind> kind_of(const std::string& name) {
  for (const SonarKind kind :
       {SonarKind::kImaging, SonarKind::kProfiling, SonarKind::kEchoSounder, SonarKind::kSideScan})
    if (name == scene::name_of(kind)) return kind;
  return refusal("sonar", fmt::format("kind '{}'", name),
                 "imaging, profiling, echosounder or sidescan");
}

// A full aperture about dead ahead, or its two edges; radians.
Result<std::pair<double, double>> aperture(const char* flag, const std::string& text) {
  NERITIC_TRY(const auto values, parse_numbers(flag, text, 1, 2));
  if (values.size() == 2) return std::pair{radians(values[0]), radians(values[1])};
  if (!(values[0] > 0.0))
    return refusal(fmt::format("--{}", flag), fmt::format("{:g} degrees", values[0]),
                   "more than 0, or two edges");
  return std::pair{-radians(values[0]) / 2.0, radians(values[0]) / 2.0};
}

Result<sonar::Bins> bins_of(const std::string& text) {
  NERITIC_TRY(const auto bins, parse_numbers("bins", text, 3, 3));
  for (const double n : bins)
    if (n != std::floor(n) || n < 1.0 || n > sonar::kMaxBins)
      return refusal("--bins", fmt::format("{:g} in '{}'", n, text),
                     fmt::format("whole numbers from 1 to {}", sonar::kMaxBins));
  return sonar::Bins{static_cast<std::uint32_t>(bins[0]), static_cast<std::uint32_t>(bins[1]),
                     static_cast<std::uint32_t>(bins[2])};
}

// The sensor's own grid, with what the flags say instead.
Result<sonar::BeamGrid> grid_of(const SonarFlags& flags, const scene::Sonar& s) {
  const bool cone = s.kind == SonarKind::kEchoSounder;
  sonar::BeamGrid grid = sonar::symmetric_grid(s.range_min_m, s.range_max_m,
                                               cone ? 2.0 * s.semi_angle_rad : s.azimuth_rad,
                                               cone ? 2.0 * s.semi_angle_rad : s.elevation_rad,
                                               {s.bins_range, s.bins_azimuth, s.bins_elevation});
  sonar::Limits& l = grid.limits;
  if (!flags.range.empty()) {
    NERITIC_TRY(const auto range, parse_numbers("range", flags.range, 2, 2));
    l.range_min_m = range[0];
    l.range_max_m = range[1];
  }
  std::string across = flags.azimuth, upright = flags.elevation;
  if (cone) {  // as wide as it is high
    if (across.empty()) across = upright;
    if (upright.empty()) upright = across;
    if (across != upright)
      return refusal("--elevation", fmt::format("'{}'", upright),
                     fmt::format("'{}', as --azimuth, for a cone", across));
  }
  if (!across.empty()) {
    NERITIC_TRY(const auto edges, aperture("azimuth", across));
    std::tie(l.azimuth_min_rad, l.azimuth_max_rad) = edges;
  }
  if (!upright.empty()) {
    NERITIC_TRY(const auto edges, aperture("elevation", upright));
    std::tie(l.elevation_min_rad, l.elevation_max_rad) = edges;
  }
  if (!flags.bins.empty()) {
    NERITIC_TRY(grid.bins, bins_of(flags.bins));
  }
  const Status valid = sonar::validate(grid);
  if (!valid.ok()) return bad_input("--{}", valid.error().message);
  return grid;
}

void put_grid(scene::Sonar& sonar, const sonar::BeamGrid& grid) {
  const sonar::Limits& l = grid.limits;
  sonar.range_min_m = l.range_min_m;
  sonar.range_max_m = l.range_max_m;
  sonar.azimuth_rad = l.azimuth_max_rad - l.azimuth_min_rad;
  sonar.elevation_rad = l.elevation_max_rad - l.elevation_min_rad;
  sonar.semi_angle_rad = sonar.azimuth_rad / 2.0;
  sonar.bins_range = grid.bins.range;
  sonar.bins_azimuth = grid.bins.azimuth;
  sonar.bins_elevation = grid.bins.elevation;
}

// Refuses terms that need more than images: a scene, a track or other sensors.
Status refuse_terms(const std::string& file, const scene::SonarTerms& terms) {
  const auto refuse = [&](const char* key, const char* why) {
    return refusal(fmt::format("{}: {}", file, key), "the key", fmt::format("none, since {}", why));
  };
  if (terms.ghosts) return refuse("ghosts", "images do not show what a mirror would");
  if (terms.motion) return refuse("motion", "images do not tell how the sonar moves");
  if (terms.labels.coco) return refuse("labels.coco", "images do not name their classes");
  return {};
}

Result<scene::Sonar> sensor_of(const SonarFlags& flags, SonarKind kind) {
  if (flags.sensor.empty() && !flags.quality.empty())
    return refusal("--quality", "without --sensor", "with --sensor, or --bins alone");
  if (!flags.bins.empty() && !flags.quality.empty())
    return refusal("--bins", "beside --quality", "one of them");
  if (flags.sensor.empty()) return default_sonar(kind);
  NERITIC_TRY(scene::Sonar sonar, scene::load_sonar(flags.sensor));
  const std::string file = flags.sensor.string();
  if (sonar.kind != kind)
    return refusal(file, fmt::format("a sensor of kind {}", scene::name_of(sonar.kind)),
                   fmt::format("{} (neritic sonar {})", flags.kind, flags.kind));
  NERITIC_TRY_STATUS(refuse_terms(file, sonar.terms));
  if (!flags.quality.empty()) {
    sonar.quality = flags.quality;
    sonar.max_error = 0.0;
  }
  return sonar;
}

// The head of the sensor; its grids as asked where edges are not symmetric.
Result<sonar::Head> head_of(const scene::Sonar& sonar, const sonar::BeamGrid& grid,
                            const SonarFlags& flags) {
  auto heads = sonar::plan_heads(sonar);
  if (!heads.ok())
    return flags.sensor.empty() ? heads.error()
                                : bad_input("{}: {}", flags.sensor.string(), heads.error().message);
  sonar::Head head = std::move((*heads)[heads->size() > 1 && flags.side == "starboard" ? 1 : 0]);
  const sonar::Limits& l = grid.limits;
  const bool symmetric =
      l.azimuth_min_rad == -l.azimuth_max_rad && l.elevation_min_rad == -l.elevation_max_rad;
  if (head.echo && !symmetric)
    return refusal(
        fmt::format("--{}", l.azimuth_min_rad == -l.azimuth_max_rad ? "elevation" : "azimuth"),
        "two edges", "one full aperture for a sensor with terms");
  if (!head.echo) head.beams = head.samples = grid;
  return head;
}

// Plain imaging is the published algorithm; a thin swath would fall between its pixels.
Result<sonar::Gather> gather_of(const SonarFlags& flags, const scene::Sonar& sonar, bool plain) {
  std::string name = flags.gather;
  if (name.empty()) name = sonar.gather;
  const bool published = plain && sonar.kind == SonarKind::kImaging;
  if (name.empty()) name = published ? "published" : kDefaultGather;
  return sonar::gather_of(name);
}

Status check_method(const SonarFlags& flags, bool plain) {
  if (flags.method == "reference" && !plain)
    return refusal("--method", "reference",
                   fmt::format("gpu for {}", flags.sensor.empty() ? "kind " + flags.kind
                                                                  : "a sensor with terms"));
  if (flags.method != "gpu" && (!flags.device.empty() || flags.validation))
    return refusal("--device, --validate", "without --method gpu", "with it");
  if (flags.method == "reference" && !flags.gather.empty() && flags.gather != "published")
    return refusal("--gather", fmt::format("'{}'", flags.gather),
                   "published with --method reference");
  if (flags.method != "image") {
    if (flags.depth.empty()) return refusal("--depth", "none", "a depth image");
    if (!flags.picture.empty() || !flags.altitude.empty() || flags.incidence)
      return refusal("--picture, --altitude, --incidence", "without --method image", "with it");
    return {};
  }
  if (flags.kind != "sidescan")
    return refusal("--method", "image", "gpu or reference, or image for kind sidescan");
  if (!flags.sensor.empty())
    return refusal("--sensor", "with --method image", "none, since this method has no terms");
  if (flags.picture.empty()) return refusal("--picture", "none", "a picture");
  if (flags.depth.empty() == flags.altitude.empty())
    return refusal("--depth, --altitude", flags.depth.empty() ? "neither" : "both",
                   "one of them with --method image");
  return {};
}

// A flag that would change nothing is a mistake somewhere.
Status check_effects(const SonarFlags& flags, const SonarJob& job) {
  const auto refuse = [&flags](std::initializer_list<const char*> names, const char* where) {
    for (const char* name : names)
      if (flags.given.contains(name))
        return Status(refusal(name, "in a run that would ignore it", fmt::format("{}", where)));
    return Status();
  };
  if (flags.method == "image")
    NERITIC_TRY_STATUS(
        refuse({"--normals", "--labels", "--gather", "--elevation"}, "without --method image"));
  if (flags.normals.empty())
    NERITIC_TRY_STATUS(
        refuse({"--axes", "--normals-sign", "--gamma", "--camera-pose"}, "with --normals"));
  if (flags.depth.empty())
    NERITIC_TRY_STATUS(refuse({"--depth-kind", "--depth-scale"}, "with --depth"));
  if (flags.depth_kind != "disparity")
    NERITIC_TRY_STATUS(refuse({"--baseline"}, "with --depth-kind disparity"));
  if (flags.kind != "sidescan" || flags.method == "image")
    NERITIC_TRY_STATUS(refuse({"--side"}, "for the acoustic kind sidescan"));
  if (!job.sonar.terms.level)
    NERITIC_TRY_STATUS(refuse({"--backscatter-db"}, "with --sensor of a device with a level"));
  if (!job.sonar.terms.speckle && !job.sonar.terms.noise)
    NERITIC_TRY_STATUS(refuse({"--seed"}, "with --sensor of a device with speckle or noise"));
  return {};
}

Result<sonar::OfflineOptions> options_of(const SonarFlags& flags) {
  sonar::OfflineOptions options;
  options.depth_kind = flags.depth_kind == "range"       ? sonar::DepthKind::kRange
                       : flags.depth_kind == "disparity" ? sonar::DepthKind::kDisparity
                                                         : sonar::DepthKind::kPlanar;
  options.normals_face_sensor = flags.normals_sign == "facing";
  options.axes = flags.axes == "opencv" ? sonar::NormalAxes::kOpencv
                 : flags.axes == "ros"  ? sonar::NormalAxes::kRos
                                        : sonar::NormalAxes::kOpengl;
  NERITIC_TRY(const auto scale, parse_numbers("depth-scale", flags.depth_scale, 1, 1));
  NERITIC_TRY(const auto gamma, parse_numbers("gamma", flags.gamma, 1, 1));
  if (!(scale[0] > 0.0))
    return refusal("--depth-scale", fmt::format("{:g}", scale[0]), "a positive number");
  if (!(gamma[0] > 0.0))
    return refusal("--gamma", fmt::format("{:g}", gamma[0]), "a positive number");
  if (options.depth_kind == sonar::DepthKind::kDisparity) {
    if (flags.baseline.empty())
      return refusal("--baseline", "none", "metres, beside --depth-kind disparity");
    NERITIC_TRY(const auto baseline, parse_numbers("baseline", flags.baseline, 1, 1));
    if (!(baseline[0] > 0.0))
      return refusal("--baseline", fmt::format("{:g}", baseline[0]), "a positive number");
    options.baseline_m = baseline[0];
  }
  if (!flags.camera_pose.empty() && !is_camera_file(flags.camera_pose)) {
    NERITIC_TRY(const auto q, parse_numbers("camera-pose", flags.camera_pose, 4, 4));
    NERITIC_TRY(options.world_from_camera, sonar::rotation_of(q, "--camera-pose"));
  }
  options.depth_scale = scale[0];
  options.gamma = gamma[0];
  return options;
}

// Where the image's axis is level, or a side-scan's tilt, at the depth that the sensor's water
// names or at the surface.
Result<sonar::PingState> state_of(const SonarJob& job) {
  sonar::PingState state;
  state.world_from_sonar.position_m.y = -job.sonar.terms.water.depth_m.value_or(0.0);
  state.world_from_sonar.rotation = job.head.sonar_from_head.rotation;
  state.gbuffer_in_world_axes = false;
  state.seed = job.flags.seed;
  state.stream = job.flags.side == "starboard" ? 1 : 0;
  NERITIC_TRY(const auto strength, parse_numbers("backscatter-db", job.flags.backscatter_db, 1, 1));
  if (!(strength[0] >= -100.0 && strength[0] <= 20.0))
    return refusal("--backscatter-db", fmt::format("{:g}", strength[0]), "-100 to 20");
  state.backscatter_scale = std::pow(10.0, strength[0] / 10.0);
  return state;
}

}  // namespace

Result<SonarJob> plan_job(const SonarFlags& flags) {
  SonarJob job;
  job.flags = flags;
  NERITIC_TRY(const SonarKind kind, kind_of(flags.kind));
  NERITIC_TRY(job.sonar, sensor_of(flags, kind));
  NERITIC_TRY(const sonar::BeamGrid grid, grid_of(flags, job.sonar));
  put_grid(job.sonar, grid);
  NERITIC_TRY(job.head, head_of(job.sonar, grid, flags));
  NERITIC_TRY_STATUS(check_method(flags, job.plain()));
  NERITIC_TRY(job.gather, gather_of(flags, job.sonar, job.plain()));
  const std::string gather = flags.gather.empty() && !flags.sensor.empty()
                                 ? flags.sensor.string() + ": gather"
                                 : std::string("--gather");
  if (job.gather == sonar::Gather::kPublished && !job.plain())
    return refusal(
        gather, "published",
        fmt::format("plane or nearest for {}",
                    flags.sensor.empty() ? "kind " + flags.kind : "a sensor with terms"));
  if (job.gather == sonar::Gather::kNearest && job.sonar.terms.labels.energy)
    return refusal(gather, "nearest",
                   "plane with labels.energy, since shadow needs a beam's footprint");
  NERITIC_TRY_STATUS(check_effects(flags, job));
  NERITIC_TRY(job.options, options_of(flags));
  NERITIC_TRY(job.state, state_of(job));
  if (job.sonar.terms.noise)
    job.detection_floor =
        sonar::detection_floor(job.sonar.terms.detection,
                               sonar::noise_by_row(sonar::ping_of(job.sonar, job.head, job.state)));
  NERITIC_TRY(job.settings, settings_of(job));
  return job;
}

}  // namespace neritic::tools
