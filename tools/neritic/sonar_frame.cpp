#include "tools/neritic/sonar_frame.hpp"

#include <algorithm>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "sonar/detection.hpp"
#include "sonar/quality.hpp"
#include "sonar/terms_json.hpp"
#include "sonar/write_sonar.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;

nlohmann::json facts_of(const SonarJob& job, const sonar::FrameFiles& files,
                        const sonar::SonarInput& in) {
  const SonarFlags& flags = job.flags;
  const Intrinsics& k = in.intrinsics;
  const bool normals = !flags.normals.empty();
  nlohmann::json json{
      {"kind", flags.kind},
      {"method", flags.method},
      {"depth", files.paths[kDepthGroup].filename().string()},
      {"depth_kind", flags.depth_kind},
      {"depth_scale", job.options.depth_scale},
      {"normals", normals ? files.paths[kNormalGroup].filename().string() : "estimated from depth"},
      {"axes", flags.axes + (flags.camera_pose.empty() ? "" : ", turned from the world's")},
      {"normals_sign", normals ? flags.normals_sign : "facing"},
      {"gamma", job.options.gamma},
      {"image", {in.width, in.height}},
      {"intrinsics", {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}},
      {"seed", nullptr}};
  if (!flags.labels.empty()) json["label_image"] = files.paths[kLabelGroup].filename().string();
  if (!job.head.name.empty()) json["head"] = job.head.name + ", looking along the image's axis";
  if (!flags.sensor.empty()) json["sensor"] = job.sonar.name;
  if (job.plain()) return json;
  json["terms"] = sonar::terms_json(job.sonar.terms);
  json["seed"] = flags.seed;
  if (const auto level = sonar::quality_level(job.sonar); level.ok() && *level != nullptr)
    json["quality"] = sonar::quality_json(**level, job.sonar.max_error, false);
  if (job.sonar.terms.level) json["backscatter_db"] = std::stod(flags.backscatter_db);
  return json;
}

// Noise is drawn anew for each frame, and for the same frame the same.
std::uint32_t ping_number(const sonar::FrameFiles& files) {
  Hash64 hash;
  hash.add_bytes(files.name.data(), files.name.size());
  return static_cast<std::uint32_t>(hash.value() >> 32);
}

bool same_shape(const sonar::SonarInput& a, const sonar::SonarInput& b) {
  const Intrinsics &k = a.intrinsics, &l = b.intrinsics;
  return a.width == b.width && a.height == b.height && k.fx == l.fx && k.fy == l.fy &&
         k.cx == l.cx && k.cy == l.cy && a.normals_face_sensor == b.normals_face_sensor;
}

// Adds the findings of a sonar's kind for one ping to `facts`; gives a profiling sonar's cloud.
std::optional<sonar::PointCloud> add_findings(const SonarJob& job, const sonar::SonarImage& image,
                                              nlohmann::json& facts) {
  const sonar::BeamGrid& grid = job.head.beams;
  const scene::SonarDetection& detection = job.sonar.terms.detection;
  std::optional<sonar::PointCloud> cloud;
  if (job.sonar.kind == scene::SonarKind::kProfiling) {
    cloud.emplace();
    sonar::append(*cloud, grid,
                  sonar::detect_bottom(grid, image.intensity, detection, job.detection_floor),
                  Pose{});
    facts["detections"] = {{"points", cloud->size()}, {"axes", "x starboard, y up, z backwards"}};
  }
  if (job.sonar.kind == scene::SonarKind::kEchoSounder) {
    sonar::EchoTrace trace(sonar::echo_trace_options(grid, job.sonar.terms, job.detection_floor));
    trace.append(image.intensity, 0.0, 0.0);
    const sonar::EchoPing& ping = trace.pings().front();  // NaN, no return, becomes null
    facts["echo"] = {{"first_return_m", ping.first_m}, {"strongest_return_m", ping.strongest_m}};
  }
  return cloud;
}

// The published algorithm, by either method.
bool counts_each_bin(const SonarJob& job) {
  return job.flags.method == "reference" || job.gather == sonar::Gather::kPublished;
}

// Notes, for the first frame only, which part of the sonar's wedge the images cover.
void note_coverage(const SonarJob& job, const sonar::SonarInput& in, SonarNotes& notes) {
  if (!notes.first(SonarNotes::About::kCoverage)) return;
  const bool published = counts_each_bin(job);
  const sonar::BeamGrid& grid = job.head.beams;
  const Coverage coverage = coverage_of(grid, in);
  if (const auto note = coverage_note(grid, coverage, published)) notes.say(*note);
  if (const auto note = normals_note(coverage, job.flags.normals.empty())) notes.say(*note);
}

// Whether any pixel could be heard: within the beams that are gathered, with a normal that faces
// the sensor. Mostly the first that it looks at.
bool can_be_heard(const SonarJob& job, const sonar::SonarInput& in) {
  const sonar::Limits& l = job.head.samples.limits;
  if (in.normals.empty()) return false;
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const std::optional<Vec3> p = sonar::point_of(in, u, v);
      if (!p) continue;
      const double range_m = glm::length(*p);
      if (range_m < l.range_min_m || range_m >= l.range_max_m || !in_aperture(l, *p)) continue;
      const double* n = &in.normals[3 * (std::size_t{v} * in.width + u)];
      const auto cosine = sonar::incidence({n[0], n[1], n[2]}, *p, in.normals_face_sensor);
      if (cosine && *cosine > 0.0) return true;
    }
  return false;
}

// The reason why an image has no echo; empty if it has one. With noise the pixels decide, not bins.
std::string silence_of(const SonarJob& job, const sonar::SonarInput& in,
                       const sonar::SonarImage& image) {
  const bool heard =
      job.sonar.terms.noise
          ? can_be_heard(job, in)
          : std::ranges::any_of(image.intensity, [](float power) { return power > 0.0f; });
  if (heard) return "";
  const Coverage coverage = coverage_of(job.head.beams, in);
  if (const auto note = coverage_note(job.head.beams, coverage, false)) return *note;
  if (const auto note = normals_note(coverage, job.flags.normals.empty())) return *note;
  return "no pixel in the wedge is heard";
}

void say_silence(const SonarJob& job, const sonar::SonarInput& in, HeardFrame& heard) {
  if (const std::string why = silence_of(job, in, heard.image); !why.empty())
    heard.facts["silent"] = why;
}

// Energy labels say shadow and ghost by two numbers, which no class may have beside them.
Status check_classes(const sonar::SonarInput& in, const sonar::MapFile& labels) {
  for (const std::uint16_t label : in.labels)
    if (label == sonar::kShadow || label == sonar::kGhost)
      return refusal(
          labels.path, fmt::format("class {}", label),
          fmt::format("any but {} and {}, which mean ghost and shadow with labels.energy",
                      sonar::kGhost, sonar::kShadow));
  return {};
}

}  // namespace

Result<Intrinsics> frame_intrinsics(const SonarFlags& flags, const sonar::MapFile& image) {
  Intrinsics k;
  if (is_camera_file(flags.intrinsics)) {
    NERITIC_TRY(k, sonar::read_intrinsics(flags.intrinsics, image));
  } else {
    const auto values = parse_numbers("intrinsics", flags.intrinsics, 4, 4);
    if (!values.ok())
      return refusal("--intrinsics", fmt::format("'{}'", flags.intrinsics),
                     "fx,fy,cx,cy or a .json or .yaml file");
    k = {(*values)[0], (*values)[1], (*values)[2], (*values)[3]};
  }
  if (!(k.fx > 0.0 && k.fy > 0.0))
    return refusal("--intrinsics", fmt::format("fx {:g}, fy {:g}", k.fx, k.fy), "positive numbers");
  if (flags.pixel_centers == "integer") {
    k.cx += 0.5;
    k.cy += 0.5;
  }
  return k;
}

void note_whole_metres(const SonarJob& job, const sonar::MapFile& depth, SonarNotes& notes) {
  if (depth.whole_numbers && job.options.depth_scale == 1.0 &&
      job.options.depth_kind != sonar::DepthKind::kDisparity &&
      notes.first(SonarNotes::About::kWholeMetres))
    notes.say(fmt::format("{}: whole numbers taken as metres (--depth-scale 0.001 for millimetres)",
                          depth.path));
}

Result<LoadedFrame> load_frame(const SonarJob& job, const sonar::FrameFiles& files,
                               SonarNotes& notes) {
  const TimeNs start = now_ns();
  NERITIC_TRY(const sonar::MapFile depth, sonar::read_map(files.paths[kDepthGroup]));
  NERITIC_TRY(const Intrinsics intrinsics, frame_intrinsics(job.flags, depth));
  note_whole_metres(job, depth, notes);
  std::optional<sonar::MapFile> normals, labels;
  if (!files.paths[kNormalGroup].empty()) {
    NERITIC_TRY(normals, sonar::read_map(files.paths[kNormalGroup], sonar::MapUse::kNormals));
    if (normals->coding == sonar::MapFile::Coding::kNumbers && job.options.gamma != 1.0)
      return refusal(
          "--gamma", fmt::format("{:g}", job.options.gamma),
          fmt::format("1, since {} has plain numbers, not coded colours", normals->path));
  }
  if (!files.paths[kLabelGroup].empty()) {
    NERITIC_TRY(labels, sonar::read_map(files.paths[kLabelGroup], sonar::MapUse::kLabels));
  }
  sonar::OfflineOptions options = job.options;
  if (is_camera_file(job.flags.camera_pose)) {
    NERITIC_TRY(options.world_from_camera,
                sonar::read_camera_rotation(job.flags.camera_pose, depth));
  }
  LoadedFrame frame;
  sonar::NormalEstimate estimate;
  NERITIC_TRY(frame.in,
              sonar::make_input(depth, normals ? &*normals : nullptr, labels ? &*labels : nullptr,
                                intrinsics, options, &estimate));
  if (labels && job.sonar.terms.labels.energy) NERITIC_TRY_STATUS(check_classes(frame.in, *labels));
  note_coverage(job, frame.in, notes);
  const auto noise = noise_note(estimate);
  if (noise && notes.first(SonarNotes::About::kNoise)) notes.say(*noise);
  sonar::SmoothedDepth smoothed;
  const double bin_m = job.head.beams.range_step_m();
  if (counts_each_bin(job)) smoothed = sonar::smooth_depth(frame.in, kAcceptedNoise_bins * bin_m);
  const auto smoothing = smoothing_note(smoothed, bin_m);
  if (smoothing && notes.first(SonarNotes::About::kSmoothed)) notes.say(*smoothing);
  frame.files = files;
  frame.facts = facts_of(job, files, frame.in);
  if (!normals)
    frame.facts["estimated_normals"] = {{"depth_noise_m", estimate.noise_m},
                                        {"error_deg", degrees(estimate.error_rad)},
                                        {"width_px", estimate.width_px}};
  if (smoothing)
    frame.facts["smoothed_depth"] = {{"depth_noise_m", smoothed.noise_m},
                                     {"left_m", smoothed.left_m},
                                     {"width_px", smoothed.width_px}};
  frame.facts["timings_ms"]["read"] = to_ms(now_ns() - start);
  return frame;
}

HeardFrame hear_by_reference(const SonarJob& job, LoadedFrame frame) {
  const TimeNs begin = now_ns();
  HeardFrame heard;
  heard.image = sonar::reference_image(job.head.beams, std::span(&frame.in, 1));
  heard.facts = std::move(frame.facts);
  heard.facts["timings_ms"]["sonar"] = to_ms(now_ns() - begin);
  say_silence(job, frame.in, heard);
  heard.facts["device"] = "CPU, double precision";
  return heard;
}

Result<std::unique_ptr<SonarEar>> SonarEar::create(const SonarJob& job) {
  std::unique_ptr<SonarEar> made(new SonarEar(job));
  gpu::DeviceOptions options;
  options.device = job.flags.device;
  options.validation = job.flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(made->device_, gpu::Device::create(options));
  return made;
}

Status SonarEar::prepare(const sonar::SonarInput& in) {
  if (gather_ && same_shape(in, shape_)) return gather_->upload(std::span(&in, 1));
  gather_.reset();
  if (job_.plain()) {
    NERITIC_TRY(gather_, sonar::ImageGather::create(*device_, job_.head.beams, std::span(&in, 1),
                                                    job_.gather));
  } else {
    NERITIC_TRY(gather_,
                sonar::ImageGather::create(*device_, job_.sonar, job_.head, in, job_.gather));
  }
  shape_.width = in.width;
  shape_.height = in.height;
  shape_.intrinsics = in.intrinsics;
  shape_.normals_face_sensor = in.normals_face_sensor;
  return {};
}

Result<HeardFrame> SonarEar::hear(LoadedFrame frame) {
  NERITIC_TRY_STATUS(prepare(frame.in));
  sonar::PingState state = job_.state;
  state.ping = ping_number(frame.files);
  HeardFrame heard;
  NERITIC_TRY(heard.image, gather_->run(state));
  heard.label_energy = gather_->label_energy();
  // Images tell classes; the index that stands for the instance in the gather means nothing here.
  if (heard.label_energy)
    std::fill(heard.label_energy->instances.begin(), heard.label_energy->instances.end(),
              std::uint16_t{0});
  heard.facts = std::move(frame.facts);
  say_silence(job_, frame.in, heard);
  heard.facts["gather"] = sonar::name_of(job_.gather);
  heard.facts["device"] = device_->info().name;
  heard.facts["timings_ms"]["sonar"] = gather_->wall_ms();
  for (const gpu::PassTime& pass : gather_->pass_times())
    heard.facts["timings_ms"][pass.name] = pass.ms;
  return heard;
}

std::unique_ptr<sonar::PolarPanel> panel_of(const SonarJob& job) {
  if (job.flags.no_pictures || job.head.beams.bins.azimuth == 1) return nullptr;
  return std::make_unique<sonar::PolarPanel>(
      job.head.beams, sonar::panel_options(job.sonar.kind, job.sonar.terms.level.has_value(),
                                           job.sonar.terms.output, job.sonar.name));
}

Status write_heard_frame(const SonarJob& job, const fs::path& folder, HeardFrame frame,
                         const sonar::PolarPanel* panel) {
  const auto cloud = add_findings(job, frame.image, frame.facts);
  return sonar::write_sonar(folder,
                            {.grid = job.head.beams,
                             .image = frame.image,
                             .kind = job.sonar.kind,
                             .level = job.sonar.terms.level.has_value(),
                             .output = job.sonar.terms.output,
                             .label_energy = frame.label_energy ? &*frame.label_energy : nullptr,
                             .picture = !job.flags.no_pictures,
                             .panel = panel,
                             .cloud = cloud ? &*cloud : nullptr,
                             .name = job.sonar.name},
                            frame.facts);
}

}  // namespace neritic::tools
