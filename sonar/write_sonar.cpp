#include "sonar/write_sonar.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/trace_panel.hpp"

namespace neritic::sonar {
namespace {

constexpr double kShown_db = 50.0;  // below the picture's full scale

const char* title_of(scene::SonarKind kind) {
  switch (kind) {
    case scene::SonarKind::kImaging:
      return "IMAGING SONAR";
    case scene::SonarKind::kProfiling:
      return "PROFILING SONAR";
    case scene::SonarKind::kEchoSounder:
      return "ECHO SOUNDER";
    case scene::SonarKind::kSideScan:
      return "SIDE-SCAN SONAR";
    case scene::SonarKind::kMechanical:
      return "MECHANICAL SCANNING SONAR";
  }
  return "";
}

// Whether the arrays have an axis of azimuth: of what scans azimuths always, also at one bin; a
// single beam's have none.
bool has_azimuth(const SonarFiles& files) {
  return files.kind == scene::SonarKind::kImaging || files.kind == scene::SonarKind::kProfiling ||
         files.image.n_azimuth > 1;
}

template <class T>
Status write_image(const std::filesystem::path& folder, const char* name, const SonarFiles& files,
                   const std::vector<T>& values) {
  const std::size_t shape[] = {files.image.n_range, files.image.n_azimuth};
  return write_array(folder, name, files.arrays, std::span<const T>(values),
                     std::span(shape).first(has_azimuth(files) ? 2 : 1));
}

Status write_counts(const std::filesystem::path& folder, const SonarFiles& files) {
  const std::vector<std::uint16_t> counts = quantize(files.image.intensity, files.output);
  if (files.output.bits == 16) return write_image(folder, "sonar_counts", files, counts);
  const std::vector<std::uint8_t> bytes(counts.begin(), counts.end());
  return write_image(folder, "sonar_counts", files, bytes);
}

nlohmann::json grid_facts(const BeamGrid& grid) {
  const Limits& l = grid.limits;
  return {{"limits",
           {{"range_m", {l.range_min_m, l.range_max_m}},
            {"azimuth_deg", {degrees(l.azimuth_min_rad), degrees(l.azimuth_max_rad)}},
            {"elevation_deg", {degrees(l.elevation_min_rad), degrees(l.elevation_max_rad)}}}},
          {"bins",
           {{"range", grid.bins.range},
            {"azimuth", grid.bins.azimuth},
            {"elevation", grid.bins.elevation}}}};
}

}  // namespace

Status remove_earlier_sonar(const std::filesystem::path& folder) {
  for (const char* name : kSonarFiles) NERITIC_TRY_STATUS(remove_file(folder / name));
  return {};
}

nlohmann::json sonar_file_sizes(const std::filesystem::path& folder) {
  nlohmann::json sizes = nlohmann::json::object();
  for (const char* name : std::span(kSonarFiles).subspan(1)) {
    std::error_code absent;
    const auto bytes = std::filesystem::file_size(folder / name, absent);
    if (!absent) sizes[name] = bytes;
  }
  return sizes;
}

std::vector<std::uint16_t> quantize(std::span<const float> power,
                                    const scene::SonarOutput& output) {
  const double most = output.bits == 8 ? 255.0 : 65535.0;
  std::vector<std::uint16_t> counts(power.size());
  for (std::size_t i = 0; i < power.size(); ++i) {
    if (!(power[i] > 0.0f)) continue;
    const double part = (10.0 * std::log10(power[i]) - output.floor_db) / output.span_db;
    counts[i] = static_cast<std::uint16_t>(std::lround(std::clamp(part, 0.0, 1.0) * most));
  }
  return counts;
}

PanelOptions panel_options(scene::SonarKind kind, bool level, const scene::SonarOutput& output,
                           const std::string& name) {
  PanelOptions options;
  options.title = name.empty() ? title_of(kind) : name + "   " + title_of(kind);
  if (level) options.span_db = kShown_db;
  if (level && output.named) {
    options.full_scale = std::pow(10.0, 0.1 * (output.floor_db + output.span_db));
    options.span_db = output.span_db;
  }
  return options;
}

ImageU8 draw_sonar(const SonarFiles& files) {
  if (files.panel != nullptr) return files.panel->draw(files.image);
  const PanelOptions options = panel_options(files.kind, files.level, files.output, files.name);
  if (files.image.n_azimuth > 1) return draw_panel(files.grid, files.image, options);
  return draw_trace(files.grid, files.image.intensity, options);
}

Status write_sonar(const std::filesystem::path& folder, const SonarFiles& files,
                   const nlohmann::json& facts) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(remove_earlier_sonar(folder));
  const SonarImage& image = files.image;
  NERITIC_TRY_STATUS(write_image(folder, "sonar", files, image.intensity));
  const LabelImage* energy = files.label_energy;
  NERITIC_TRY_STATUS(
      write_image(folder, "sonar_labels", files, energy ? energy->classes : image.labels));
  if (energy) {
    NERITIC_TRY_STATUS(write_image(folder, "sonar_instances", files, energy->instances));
    NERITIC_TRY_STATUS(write_image(folder, "sonar_label_fraction", files, energy->fraction));
  }
  if (files.output.bits > 0) NERITIC_TRY_STATUS(write_counts(folder, files));
  if (files.cloud != nullptr) {
    NERITIC_TRY_STATUS(write_cloud_npy(folder / "cloud.npy", *files.cloud));
    NERITIC_TRY_STATUS(write_pcd(folder / "cloud.pcd", *files.cloud));
  }
  if (files.picture) NERITIC_TRY_STATUS(scene::write_png8(folder / "sonar.png", draw_sonar(files)));
  nlohmann::json json = facts;
  json.update(grid_facts(files.grid));
  json["units"] =
      files.level ? "power after the receiver's gains, 1 is 1 uPa^2 (10 log10: dB re 1 uPa)"
      : files.kind == scene::SonarKind::kEchoSounder
          ? "mean over the cone of the cosine of incidence times reflectivity, 0 to 1"
          : "mean over elevation bins of the cosine of incidence times reflectivity, 0 to 1 a bin";
  json["layout"] = has_azimuth(files)
                       ? "sonar.npy [range, azimuth]: row 0 nearest, column 0 full port"
                       : "sonar.npy [range]: 0 nearest";
  json["labels"] = energy ? "class that gave most of the bin's energy; 65534 shadow, 65533 ghost"
                          : "class of the bin's strongest return";
  if (files.output.bits > 0)
    json["counts"] = {{"bits", files.output.bits},
                      {"floor_db", files.output.floor_db},
                      {"span_db", files.output.span_db}};
  const PanelOptions panel = panel_options(files.kind, files.level, files.output, files.name);
  json["display"] = {{"full_scale", panel_full_scale(image, panel)}, {"gamma", panel.gamma}};
  if (panel.span_db > 0.0)
    json["display"] = {{"full_scale", panel_full_scale(image, panel)}, {"span_db", panel.span_db}};
  json["bytes"] = sonar_file_sizes(folder);
  return write_json(folder / "sonar.json", json);
}

}  // namespace neritic::sonar
