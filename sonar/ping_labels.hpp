// Labels by energy of single beams (echo sounder, side-scan, mechanical), which are a bin wide a
// ping: laid side by side over a track, as their waterfall is. One owner, one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/core/image.hpp"
#include "sonar/coco.hpp"
#include "sonar/coco_pictures.hpp"

namespace neritic::sonar {

// [n] of one ping.
struct PingLine {
  std::vector<std::uint16_t> classes, instances;
  std::vector<float> intensity;
};
// Nearest first, of one beam's labels and image (CHECKed).
PingLine ping_line(const LabelImage& labels, std::span<const float> intensity);
// A side-scan's: port reversed, then starboard.
PingLine ping_line(const PingLine& port, const PingLine& starboard);

// Laid as arrays: a ping a row, or a ping a column of [n_range][pings].
enum class PingsAlong { kRows, kColumns };

class PingLabels {
 public:
  // All lines are as long as the first (CHECKed).
  void append(const PingLine& line);
  std::size_t pings() const { return pings_; }

  // PREFIX_labels.npy, PREFIX_instances.npy uint16.
  Status write(const std::filesystem::path& folder, const std::string& prefix,
               PingsAlong along) const;
  ImageU16 classes(PingsAlong along) const;
  // Pictures coco/pings_FIRST.png of at most kPingsAPicture each with their annotations.
  static constexpr std::size_t kPingsAPicture = 2048;
  Status add_to(CocoFile& coco, CocoPictures& pictures, PingsAlong along) const;

 private:
  template <class T>
  std::vector<T> laid(const std::vector<T>& lines, std::size_t first, std::size_t count,
                      PingsAlong along) const;
  std::size_t pings_ = 0, bins_ = 0;
  std::vector<std::uint16_t> classes_, instances_;  // [pings][bins]
  std::vector<float> intensity_;
};

}  // namespace neritic::sonar
