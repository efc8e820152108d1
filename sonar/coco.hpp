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

// Where range grows in a picture: down its columns (x counts beams from full port, y bins from the
// nearest), or along its rows from the middle outwards (a side-scan's: y counts pings).
enum class RangeAxis { kDown, kOutwards };

class CocoFile {
 public:
  // class_names: the categories, by class. Water is none. kShadow and kGhost are categories where
  // they are named.
  explicit CocoFile(std::map<std::uint16_t, std::string> class_names,
                    RangeAxis range = RangeAxis::kDown);

  // One annotation for each (class, instance) in the image whose class has a name, in that order.
  // Shadow gets one for each connected part (by sides and corners) of at least kLeastShadow bins,
  // with the annotation of the object that casts it as "cast_by": the instance next nearer in most
  // of its beams, if there is one; smaller parts together are a crowd. Instance 0 and the seabed
  // are crowds.
  // file_name: of the picture that the labels belong to, n_beams wide and n_range high.
  static constexpr std::size_t kLeastShadow = 8;
  void add(const std::string& file_name, const LabelImage& labels);

  // scale: what the pictures' greys mean (CocoPictures::scale), for "info".
  nlohmann::json json(const nlohmann::json& scale = nlohmann::json::object()) const;
  Status write(const std::filesystem::path& path, const nlohmann::json& scale) const;

 private:
  std::map<std::uint16_t, std::string> class_names_;
  RangeAxis range_;
  nlohmann::json images_ = nlohmann::json::array(), annotations_ = nlohmann::json::array();
};

}  // namespace neritic::sonar
