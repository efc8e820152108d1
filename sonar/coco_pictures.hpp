// The grey pictures that boxes and masks lie over: a pixel a bin, in decibels, all of a run on one
// scale. One owner, one thread.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/core/result.hpp"
#include "engine/scene/sonar_settings.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

// Where the output is named, a grey is its count of 8 bits (quantize). Else the strongest bin of
// the whole run is white (rounded up to a whole count) and black lies 76.5 dB below it (powers: 0.3
// dB a count) or 38.25 dB (mean cosines, re 1: 0.15 dB). A louder picture later moves the scale,
// so finish() draws earlier pictures anew: their counts only fall, by whole counts.
class CocoPictures {
 public:
  // folder: which names are given from. level: the images are powers, 1 being 1 uPa^2.
  CocoPictures(std::filesystem::path folder, bool level, const scene::SonarOutput& output);

  // Writes [n_range][n_azimuth], row 0 nearest, column 0 full port. name: below the folder.
  Status add(const std::string& name, const SonarImage& image);
  // Brings all pictures to one scale.
  Status finish();
  // {floor_db, full_scale_db, units}, of black and white.
  nlohmann::json scale() const;

 private:
  std::filesystem::path folder_;
  bool level_, fixed_;
  scene::SonarOutput shown_;
  std::int64_t white_ = 0;                     // counts from 0 dB to full scale, where not fixed
  bool heard_ = false;                         // anything, so that there is a scale
  std::map<std::string, std::int64_t> drawn_;  // by name: the white that each was drawn with
};

}  // namespace neritic::sonar
