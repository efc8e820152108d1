// A sonar image as files: sonar.npy, sonar_labels.npy, sonar.png, sonar.json, and what the settings
// ask for beside them. Any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "engine/core/npz.hpp"
#include "engine/scene/sonar_settings.hpp"
#include "sonar/label_energy.hpp"
#include "sonar/panel.hpp"
#include "sonar/point_cloud.hpp"

namespace neritic::sonar {

struct SonarFiles {
  const BeamGrid& grid;
  const SonarImage& image;
  scene::SonarKind kind = scene::SonarKind::kImaging;
  bool level = false;         // the image is power, 1 being 1 uPa^2
  scene::SonarOutput output;  // bits: 0, or counts of decibels; named: the picture's scale (level)
  const LabelImage* label_energy = nullptr;  // nullptr: labels of the strongest return
  bool picture = true;                       // sonar.png too, which takes longest
  const PolarPanel* panel = nullptr;         // of grid and panel_options, for many images; or none
  const PointCloud* cloud = nullptr;  // what one ping sounds, for cloud.npy and .pcd; or none
  ArrayFormat arrays = ArrayFormat::kNpy;
  std::string name;  // the sensor's, in the picture's title
};

// Counts of what leaves a receiver of 8 or 16 bits: 0 at floor_db and below, the largest count at
// floor_db + span_db and above, decibels in between.
std::vector<std::uint16_t> quantize(std::span<const float> power, const scene::SonarOutput& output);

// How the picture shows it: decibels where it is a level, those of the output where it is named.
// name: the sensor's.
PanelOptions panel_options(scene::SonarKind kind, bool level, const scene::SonarOutput& output,
                           const std::string& name);
// The picture: polar, or for a single beam the echo over range.
ImageU8 draw_sonar(const SonarFiles& files);

// The files that write_sonar may write into a folder, the .json first.
inline constexpr const char* kSonarFiles[] = {"sonar.json",
                                              "sonar.npy",
                                              "sonar_labels.npy",
                                              "sonar_instances.npy",
                                              "sonar_label_fraction.npy",
                                              "sonar_counts.npy",
                                              "cloud.npy",
                                              "cloud.pcd",
                                              "sonar.png",
                                              "sonar.npz",
                                              "sonar_labels.npz",
                                              "sonar_instances.npz",
                                              "sonar_label_fraction.npz",
                                              "sonar_counts.npz"};
// An earlier image's files go, of whatever kind, so that none is taken for another's: the .json
// first, so that none ever describes other arrays, however far the removing comes.
Status remove_earlier_sonar(const std::filesystem::path& folder);
// The size in bytes of each of them that is there beside the .json, by name: what the .json says
// under "bytes", so that a truncated or missing file is detected.
nlohmann::json sonar_file_sizes(const std::filesystem::path& folder);

// facts: what else sonar.json shall say (options, device, timings); limits, bins and units are
// added. sonar.npy is [n_range, n_azimuth], of a single beam (no imaging or profiling sonar)
// [n_range]. With label_energy also sonar_instances.npy and sonar_label_fraction.npy, with bits
// sonar_counts.npy. An earlier image's files are removed, and the new .json is written last: where
// one is, the others are whole and its own.
Status write_sonar(const std::filesystem::path& folder, const SonarFiles& files,
                   const nlohmann::json& facts);

}  // namespace neritic::sonar
