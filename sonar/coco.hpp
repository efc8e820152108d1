// Boxes and masks of label images in the format of the COCO data set (cocodataset.org, "Data
// format"): images, annotations, categories; masks as uncompressed run lengths down the columns.
// One owner, one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "sonar/label_energy.hpp"

namespace neritic::sonar {

// Runs of a mask [height][width] (0: outside) read column by column from the top, outside first:
// the first run may be 0 long. They add up to height * width.
std::vector<std::uint32_t> run_lengths(std::span<const std::uint8_t> mask, std::uint32_t height,
                                       std::uint32_t width);

// A picture's width is its beams, its height its range bins: x counts beams from full port, y bins
// from the nearest.
class CocoFile {
 public:
  // class_names: the categories, by class. Water is none. kShadow and kGhost are categories where
  // they are named.
  explicit CocoFile(std::map<std::uint16_t, std::string> class_names);

  // One annotation for each (class, instance) in the image whose class has a name, in that order.
  // file_name: of the picture that the labels belong to, n_beams wide and n_range high.
  void add(const std::string& file_name, const LabelImage& labels);

  nlohmann::json json() const;
  Status write(const std::filesystem::path& path) const;

 private:
  std::map<std::uint16_t, std::string> class_names_;
  nlohmann::json images_ = nlohmann::json::array(), annotations_ = nlohmann::json::array();
};

}  // namespace neritic::sonar
