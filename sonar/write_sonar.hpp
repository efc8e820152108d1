// A sonar image as files: sonar.npy, sonar_labels.npy, sonar.png, sonar.json. Any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "sonar/panel.hpp"

namespace neritic::sonar {

// facts: what else sonar.json shall say (options, device, timings); limits, bins and units are
// added. The .json is written last: where it is, the others are whole.
Status write_sonar(const std::filesystem::path& folder, const BeamGrid& grid,
                   const SonarImage& image, const nlohmann::json& facts,
                   const PanelOptions& panel = {});

}  // namespace neritic::sonar
