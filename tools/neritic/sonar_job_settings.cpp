// The settings of a `neritic sonar` run as they stand in its results, so that a later run can tell
// whether a result would be its own.
#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/text.hpp"
#include "sonar/terms_json.hpp"
#include "tools/neritic/sonar_job.hpp"

namespace neritic::tools {
namespace {

// Everything that the terms come to: what differs in it makes another image.
std::string hash_of(const SonarJob& job) {
  const auto floats = [](Hash64& hash, const auto& values) {
    for (const auto& v : values) hash.add(v);
  };
  Hash64 hash;
  const sonar::Ping ping = sonar::ping_of(job.sonar, job.head, job.state);
  for (const glm::vec2& gain : ping.gains) hash.add(gain.x), hash.add(gain.y);
  floats(hash, ping.correction);
  hash.add(ping.noise_power);
  hash.add(ping.echo.turns_per_m), hash.add(ping.echo.cells_per_m);
  hash.add(ping.echo.patches_per_m);
  if (job.head.echo) {
    floats(hash, job.head.echo->weights);
    floats(hash, job.head.echo->gamma_quantiles);
  }
  floats(hash, job.head.receiver.range.weights);
  floats(hash, job.head.receiver.across.weights);
  const scene::SonarOutput& output = job.sonar.terms.output;
  hash.add(job.sonar.terms.labels.energy), hash.add(output.bits);
  hash.add(output.floor_db), hash.add(output.span_db);
  return hash.hex();
}

// Their names, and whether anything in them differs.
std::string terms_text(const SonarJob& job) {
  std::string names;
  const nlohmann::json terms = sonar::terms_json(job.sonar.terms);
  for (const auto& [name, value] : terms.items()) names += name + " ";
  return names + hash_of(job);
}

std::string text(double value) {
  return fmt::format("{:.12g}", value);
}
std::string pair(double from, double to) {
  return text(from) + "," + text(to);
}

// Threshold, floor, quality; "-" where the kind's own holds.
std::string detection_text(const scene::SonarDetection& d) {
  const auto or_own = [](const auto& value) { return value ? text(*value) : std::string("-"); };
  return or_own(d.threshold) + "," + or_own(d.floor_db) + "," + text(d.quality);
}

}  // namespace

bool is_camera_file(const std::string& text) {
  const std::string extension = lower_case(std::filesystem::path(text).extension().string());
  return extension == ".json" || extension == ".yaml" || extension == ".yml";
}

Result<nlohmann::json> settings_of(const SonarJob& job) {
  const SonarFlags& f = job.flags;
  const sonar::Limits& l = job.head.beams.limits;
  const sonar::Bins& bins = job.head.samples.bins;
  // Numbers as text: however a file writes numbers, these come back as they are.
  nlohmann::json json{
      {"kind", f.kind},
      {"method", f.method},
      {"range_m", pair(l.range_min_m, l.range_max_m)},
      {"azimuth_deg", pair(degrees(l.azimuth_min_rad), degrees(l.azimuth_max_rad))},
      {"elevation_deg", pair(degrees(l.elevation_min_rad), degrees(l.elevation_max_rad))},
      {"bins", fmt::format("{},{},{}", bins.range, bins.azimuth, bins.elevation)},
      {"normals", f.normals.empty() ? "estimated from depth" : "from files"},
      {"labels", f.labels.empty() ? "none" : "from files"},
      {"depth_kind", f.depth_kind},
      {"depth_scale", text(job.options.depth_scale)},
      {"axes", f.axes},
      {"normals_sign", f.normals_sign},
      {"gamma", text(job.options.gamma)},
      {"intrinsics", f.intrinsics},
      {"pixel_centers", f.pixel_centers},
      {"pictures", !f.no_pictures}};
  if (f.depth_kind == "disparity") json["baseline_m"] = text(job.options.baseline_m);
  if (!f.camera_pose.empty()) json["camera_pose"] = f.camera_pose;
  for (const auto& [key, file] :
       {std::pair{"intrinsics", f.intrinsics}, {"camera_pose", f.camera_pose}}) {
    if (!is_camera_file(file)) continue;
    NERITIC_TRY(const std::string text, read_text(file));
    Hash64 hash;
    hash.add_bytes(text.data(), text.size());
    json[key] = std::filesystem::path(file).filename().string() + " " + hash.hex();
  }
  if (job.sonar.terms.detection != scene::SonarDetection{})
    json["detection"] = detection_text(job.sonar.terms.detection);
  if (f.method == "gpu") json["gather"] = sonar::name_of(job.gather);
  if (f.method == "image") {
    json["altitude"] = f.altitude.empty() ? "from depth images" : f.altitude;
    json["incidence"] = f.incidence;
  } else if (!job.plain()) {
    json["sensor"] = job.sonar.name;
    json["terms"] = terms_text(job);
    json["seed"] = std::to_string(f.seed);
    if (!job.head.name.empty()) json["side"] = job.head.name;
  }
  return json;
}

}  // namespace neritic::tools
