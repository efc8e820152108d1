#include "testbed/output/survey.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/scene_surface.hpp"
#include "sonar/bathymetry.hpp"
#include "sonar/coco.hpp"
#include "sonar/detection.hpp"
#include "sonar/mechanical_scan.hpp"
#include "sonar/ping_labels.hpp"
#include "sonar/point_cloud.hpp"
#include "sonar/quality.hpp"
#include "sonar/sidescan_from_image.hpp"
#include "sonar/terms_json.hpp"
#include "sonar/terrain_error.hpp"
#include "testbed/output/pictures.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;
using scene::SonarKind;

constexpr double kNadir_rad = radians(5.0);
constexpr double kStraightDown = 0.966;  // cosine: 15 degrees of roll and pitch
constexpr std::uint16_t kSeabedClass = scene::kClasses[0].id;

// A side-scan's options for what pictures tell: brightness, no levels.
sonar::SidescanOptions brightness_of(sonar::SidescanOptions options) {
  options.levels = false;
  return options;
}

nlohmann::json facts_json(const FrameFacts& facts, std::size_t pings) {
  return {{"scene", facts.scene}, {"seed", facts.seed}, {"device", facts.device}, {"pings", pings}};
}

// The bottom is what objects of class seabed show from above.
std::vector<std::shared_ptr<scene::Surface>> seabeds(const scene::Scene& scene) {
  std::vector<std::shared_ptr<scene::Surface>> out;
  for (const scene::Object& object : scene.objects) {
    if (object.class_id != kSeabedClass || object.model < 0) continue;
    std::vector<Mat4> places;
    for (std::size_t i = 0; i < object.instance_count(); ++i)
      places.push_back(scene.world_from_copy(object, i));
    out.push_back(std::make_shared<scene::Surface>(
        *scene.models[static_cast<std::size_t>(object.model)], places));
  }
  return out;
}

sonar::TrueDepth true_depth(const scene::Scene& scene) {
  return [surfaces = seabeds(scene)](double x_m, double z_m) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const auto& surface : surfaces)
      if (const auto at = surface->at(x_m, z_m)) highest = std::max(highest, at->y_m);
    return std::isfinite(highest) ? -highest : std::numeric_limits<double>::quiet_NaN();
  };
}

std::vector<float> floor_of(const SonarFrame& frame) {
  return sonar::detection_floor(frame.terms.detection, frame.noise_power);
}

bool is_single_beam(SonarKind kind) {
  return kind != SonarKind::kImaging && kind != SonarKind::kProfiling;
}

// Whether a sounding's class is of something that stands on the bottom; what has no class is taken
// for the bottom.
bool is_object(std::uint16_t class_id) {
  return class_id != sonar::kWater && class_id != kSeabedClass;
}

// For the files that a single beam accumulates.
const char* prefix_of(SonarKind kind) {
  return kind == SonarKind::kSideScan     ? "sidescan"
         : kind == SonarKind::kMechanical ? "mechanical"
                                          : "echo_trace";
}

// As it pings: what a quality level makes of the settings.
scene::Sonar as_sampled(scene::Sonar sonar) {
  const Status applied = sonar::apply_quality(sonar);
  NERITIC_CHECK(applied.ok(), "a sonar that has pinged: {}", applied.error().message);
  return sonar;
}

}  // namespace

struct Survey::Record {
  explicit Record(const scene::Sonar& settings) : sonar(as_sampled(settings)) {}
  const scene::Sonar sonar;
  std::size_t pings = 0;
  // For a profiling sonar.
  sonar::PointCloud cloud;
  std::unique_ptr<sonar::Bathymetry> bathymetry;
  double cell_m = 0.0;
  // The chart's error counts soundings of the bottom, and not of things that stand on it.
  std::unique_ptr<sonar::Bathymetry> terrain;
  std::vector<Vec3> terrain_points, nadir;
  std::vector<Vec3> places;  // of each ping
  std::unique_ptr<sonar::EchoTrace> trace;
  std::unique_ptr<sonar::SidescanRecord> sidescan;
  std::unique_ptr<sonar::SidescanRecord> from_pictures;  // of the side-scan's picture camera
  SonarFrame port;  // kept until the starboard side of the same ping comes
  std::unique_ptr<sonar::MechanicalScan> scan;
  std::unique_ptr<sonar::PingLabels> labels;  // of a single beam
  sonar::PingLine port_labels;
  std::unique_ptr<sonar::CocoFile> coco;
  std::unique_ptr<sonar::CocoPictures> pictures;

  bool accumulates() const { return bathymetry || trace || sidescan || scan || labels || coco; }
  void add(const SonarFrame& frame, double time_s);
  Status add_labels(const SonarFrame& frame, std::uint32_t number);
  Status write_labels(const fs::path& folder) const;
  void add_profile(const SonarFrame& frame);
  Status add_picture(const FrameResult& result, const Pose& world_from_sonar, double time_s);
  Status write(const fs::path& folder, const scene::Scene& scene, const FrameFacts& facts) const;
  Status write_bathymetry(const fs::path& folder, const scene::Scene& scene,
                          nlohmann::json json) const;
};

Survey::Survey(const scene::Scene& scene, fs::path out, const SurveyOptions& options)
    : scene_(scene), out_(std::move(out)), options_(options) {}
Survey::~Survey() = default;

Survey::Record& Survey::record_of(const SonarFrame& frame) {
  std::unique_ptr<Record>& slot = records_[frame.name];
  if (slot) return *slot;
  const auto settings = std::ranges::find(scene_.sonars, frame.name, &scene::Sonar::name);
  NERITIC_CHECK(settings != scene_.sonars.end(), "{} is no sonar of the scene", frame.name);
  slot = std::make_unique<Record>(*settings);
  Record& r = *slot;
  const sonar::Limits& l = frame.grid.limits;
  const scene::SonarTerms& terms = frame.terms;
  if (terms.labels.coco) {
    std::map<std::uint16_t, std::string> names = scene_.class_names;
    for (const scene::ClassName& known : scene::kClasses) names.emplace(known.id, known.name);
    names.emplace(sonar::kShadow, "shadow");
    names.emplace(sonar::kGhost, "ghost");
    r.coco = std::make_unique<sonar::CocoFile>(std::move(names), frame.kind == SonarKind::kSideScan
                                                                     ? sonar::RangeAxis::kOutwards
                                                                     : sonar::RangeAxis::kDown);
    r.pictures = std::make_unique<sonar::CocoPictures>(out_ / "track" / frame.name, frame.level,
                                                       terms.output);
  }
  if (is_single_beam(frame.kind) && terms.labels.energy && (options_.tracks || r.coco))
    r.labels = std::make_unique<sonar::PingLabels>();
  if (!options_.tracks) return r;
  if (frame.kind == SonarKind::kProfiling) {
    const double cell_m =
        options_.chart_cell_m > 0.0 ? options_.chart_cell_m : l.range_max_m / 50.0;
    r.bathymetry = std::make_unique<sonar::Bathymetry>(cell_m);
    r.terrain = std::make_unique<sonar::Bathymetry>(cell_m);
    r.cell_m = cell_m;
  }
  if (frame.kind == SonarKind::kEchoSounder)
    r.trace = std::make_unique<sonar::EchoTrace>(
        sonar::echo_trace_options(frame.grid, terms, floor_of(frame)));
  if (frame.kind == SonarKind::kSideScan)
    r.sidescan = std::make_unique<sonar::SidescanRecord>(
        sonar::sidescan_options(frame.grid, terms, floor_of(frame)));
  if (!r.sonar.picture_camera.empty())
    r.from_pictures = std::make_unique<sonar::SidescanRecord>(brightness_of(r.sidescan->options()));
  if (frame.kind == SonarKind::kMechanical)
    r.scan = std::make_unique<sonar::MechanicalScan>(sonar::MechanicalScanOptions{
        .n_range = frame.grid.bins.range,
        .range_min_m = l.range_min_m,
        .range_max_m = l.range_max_m,
        .beam_rad = std::max(r.sonar.step_rad, l.azimuth_max_rad - l.azimuth_min_rad),
        .elevation_rad = r.sonar.elevation_rad,
        .bins_elevation = r.sonar.bins_elevation,
        .levels = terms.level.has_value()});
  return r;
}

Status Survey::add(const FrameResult& result, std::uint32_t number, double time_s) {
  for (const SonarFrame& frame : result.sonars) {
    if (!frame.heard()) continue;
    Record& record = record_of(frame);
    const Pose& world_from_sonar = frame.world_from_sonar;
    record.add(frame, time_s);
    if (frame.label_energy) NERITIC_TRY_STATUS(record.add_labels(frame, number));
    if (record.from_pictures && frame.head == "port")
      NERITIC_TRY_STATUS(record.add_picture(result, world_from_sonar, time_s));
  }
  return {};
}

Status check_picture_camera(const scene::Sonar& sonar, const Pose& world_from_camera) {
  const Vec3 down = world_from_camera.rotation * Vec3(0, 0, -1);
  if (down.y > -kStraightDown)
    return refusal(
        fmt::format("sonar {}: picture_camera", sonar.name),
        fmt::format("{}, which looks {:.0f} degrees off straight down", sonar.picture_camera,
                    degrees(std::acos(std::clamp(-down.y, -1.0, 1.0)))),
        fmt::format("at most {:.0f} degrees", degrees(std::acos(kStraightDown))));
  return {};
}

// The image-based line of the same ping, from what the named camera sees.
Status Survey::Record::add_picture(const FrameResult& result, const Pose& world_from_sonar,
                                   double time_s) {
  const ViewImages* eye = nullptr;
  for (const CameraFrame& camera : result.cameras)
    if (camera.name == sonar.picture_camera) eye = &camera.eyes.front();
  if (!eye || eye->color.empty() || eye->depth.empty())
    return refusal(fmt::format("sonar {}: picture_camera", sonar.name), sonar.picture_camera,
                   "a camera of the scene with its picture and depth");
  NERITIC_TRY_STATUS(check_picture_camera(sonar, eye->world_from_view));
  const sonar::SeabedPicture picture{
      sonar::brightness_of(eye->color),
      {eye->intrinsics.fx, eye->intrinsics.fy, eye->intrinsics.cx, eye->intrinsics.cy},
      eye->depth.data};
  const sonar::SidescanOptions& o = from_pictures->options();
  NERITIC_TRY(const sonar::SidescanLine line,
              sonar::sidescan_from_picture(picture, {.n_range = o.n_range,
                                                     .range_min_m = o.range_min_m,
                                                     .range_max_m = o.range_max_m,
                                                     .beam_along_rad = sonar.azimuth_rad}));
  from_pictures->append(line.port, line.starboard, world_from_sonar, time_s);
  return {};
}

void Survey::Record::add(const SonarFrame& frame, double time_s) {
  const Pose& world_from_sonar = frame.world_from_sonar;
  if (frame.head != "port") ++pings;
  const std::vector<float>& heard = frame.image.intensity;
  if (bathymetry) add_profile(frame);
  if (trace) trace->append(heard, time_s, -world_from_sonar.position_m.y);
  if (scan) scan->append(heard, {frame.heading_rad, world_from_sonar, time_s});
  if (sidescan && frame.head == "port") port = frame;
  if (sidescan && frame.head == "starboard")
    sidescan->append(port.image.intensity, heard, world_from_sonar, time_s);
}

// A single beam's lines are laid side by side until the end; else a picture beside coco.json, which
// names it from there.
Status Survey::Record::add_labels(const SonarFrame& frame, std::uint32_t number) {
  if (labels) {
    sonar::PingLine line = sonar::ping_line(*frame.label_energy, frame.image.intensity);
    if (frame.head == "port")
      port_labels = std::move(line);
    else
      labels->append(frame.head.empty() ? line : sonar::ping_line(port_labels, line));
    return {};
  }
  if (!coco) return {};
  const std::string name = "coco/" + frame_folder(number) + ".png";
  coco->add(name, *frame.label_energy);
  return pictures->add(name, frame.image);
}

Status Survey::Record::write_labels(const fs::path& folder) const {
  using sonar::PingsAlong;
  if (labels) {
    const bool across = sonar.kind == SonarKind::kMechanical;  // as its mechanical.npy
    const PingsAlong along = across ? PingsAlong::kColumns : PingsAlong::kRows;
    const std::string prefix = prefix_of(sonar.kind);
    NERITIC_TRY_STATUS(labels->write(folder, prefix, along));
    NERITIC_TRY_STATUS(scene::write_png8(folder / (prefix + "_labels.png"),
                                         labels_picture(labels->classes(along))));
    // In pictures range grows downwards, a side-scan's outwards.
    if (coco)
      NERITIC_TRY_STATUS(labels->add_to(
          *coco, *pictures,
          sonar.kind == SonarKind::kSideScan ? PingsAlong::kRows : PingsAlong::kColumns));
  }
  if (!coco) return {};
  NERITIC_TRY_STATUS(pictures->finish());
  return coco->write(folder / "coco.json", pictures->scale());
}

void Survey::Record::add_profile(const SonarFrame& frame) {
  const auto detections = sonar::detect_bottom(frame.grid, frame.image.intensity,
                                               frame.terms.detection, floor_of(frame));
  sonar::append(cloud, frame.grid, detections, frame.world_from_head);
  places.push_back(frame.world_from_head.position_m);
  std::vector<sonar::BottomDetection> of_terrain;
  for (const sonar::BottomDetection& d : detections) {
    const Vec3 point = frame.world_from_head * sonar::detection_point(frame.grid, d);
    bathymetry->add(point);
    if (is_object(sonar::detected_class(frame.grid, frame.image.labels, d))) continue;
    of_terrain.push_back(d);
    terrain->add(point);
    terrain_points.push_back(point);
  }
  for (const sonar::BottomDetection& d :
       sonar::nadir_detections(frame.grid, of_terrain, frame.world_from_head, kNadir_rad))
    nadir.push_back(frame.world_from_head * sonar::detection_point(frame.grid, d));
}

Status Survey::Record::write_bathymetry(const fs::path& folder, const scene::Scene& scene,
                                        nlohmann::json json) const {
  NERITIC_TRY_STATUS(sonar::write_cloud_npy(folder / "cloud.npy", cloud));
  NERITIC_TRY_STATUS(sonar::write_pcd(folder / "cloud.pcd", cloud));
  NERITIC_TRY(const sonar::BathymetryGrid grid, bathymetry->grid());
  NERITIC_TRY(const sonar::BathymetryGrid bottom, terrain->grid());
  const sonar::TrueDepth truth = true_depth(scene);
  json["soundings"] = cloud.size();
  json["error"] = {
      {"of", "soundings of the seabed; those on objects are in the chart and the cloud alone"},
      {"soundings_on_objects", cloud.size() - terrain_points.size()},
      {"terrain_soundings", sonar::to_json(sonar::point_error(terrain_points, truth))},
      {"grid_at_cell_centres",
       sonar::to_json(grid_error(bottom, truth, sonar::CompareAt::kCellCentre))},
      {"grid_at_soundings", sonar::to_json(grid_error(bottom, truth, sonar::CompareAt::kCentroid))},
      {"nadir_soundings", sonar::to_json(sonar::point_error(nadir, truth))},
      {"range_bin_m", (sonar.range_max_m - sonar.range_min_m) / sonar.bins_range}};
  return sonar::write_bathymetry(folder, grid, json);
}

Status Survey::Record::write(const fs::path& folder, const scene::Scene& scene,
                             const FrameFacts& facts) const {
  nlohmann::json json = facts_json(facts, pings);
  json["sensor"] = sonar::sensor_json(sonar);
  NERITIC_TRY_STATUS(make_folder(folder));
  if (bathymetry) NERITIC_TRY_STATUS(write_bathymetry(folder, scene, json));
  if (trace) NERITIC_TRY_STATUS(sonar::write_echo_trace(folder, *trace, json));
  if (sidescan) NERITIC_TRY_STATUS(sonar::write_sidescan(folder, *sidescan, json));
  if (from_pictures && from_pictures->pings() > 0) {
    NERITIC_TRY_STATUS(make_folder(folder / "from_pictures"));
    NERITIC_TRY_STATUS(sonar::write_sidescan(folder / "from_pictures", *from_pictures, json));
  }
  if (scan)
    NERITIC_TRY_STATUS(sonar::write_mechanical_scan(
        folder, *scan, std::max(4.0 * scan->options().range_step_m(), 0.01), json));
  return write_labels(folder);
}

Result<bool> Survey::write(const FrameFacts& facts) const {
  bool wrote = false;
  for (const auto& [name, record] : records_) {
    if (!record->accumulates()) continue;
    NERITIC_TRY_STATUS(record->write(out_ / "track" / name, scene_, facts));
    wrote = true;
  }
  return wrote;
}

std::optional<std::string> Survey::hint() const {
  if (options_.chart_cell_m > 0.0) return std::nullopt;
  for (const auto& [name, record] : records_) {
    const std::vector<Vec3>& places = record->places;
    if (places.size() < 2) continue;
    double way_m = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i)
      way_m += std::hypot(places[i].x - places[i - 1].x, places[i].z - places[i - 1].z);
    const double apart_m = way_m / static_cast<double>(places.size() - 1), cell_m = record->cell_m;
    if (apart_m > 1.2 * cell_m)
      return fmt::format(
          "{}: pings are {:.2g} m apart on the chart's cells of {:.2g} m, which leaves stripes "
          "(--chart-cell {:.2g})",
          name, apart_m, cell_m, std::ceil(20.0 * apart_m) / 20.0);
  }
  return std::nullopt;
}

}  // namespace neritic::testbed
