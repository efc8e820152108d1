// Depth, normal and label maps from files of any kind that people keep them in: .npy, .npz, PNG (1
// to 16 bit), .pgm, .pfm and OpenEXR. Values as stored, in double, so that nothing is lost. Any
// thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::sonar {

struct MapFile {
  enum class Coding { kNumbers, kCoded8, kCoded16 };  // floats; or integers of 8 or 16 bit
  std::string path;
  std::uint32_t width = 0, height = 0, channels = 1;
  Coding coding = Coding::kNumbers;
  bool whole_numbers = false;              // held as integers of any size
  bool palette = false;                    // indices of a PNG's palette
  std::vector<double> values;              // [height][width][channels]
  std::vector<std::string> channel_names;  // of an EXR; else empty

  double at(std::size_t pixel, std::uint32_t channel) const {
    return values[pixel * channels + channel];
  }
  std::size_t pixels() const { return std::size_t{width} * height; }
};

// Picks the array of an .npz, by name. The numbers of a PNG with a palette are its colours as
// normals, else its indices, as files of class masks use them.
enum class MapUse { kDepth, kNormals, kLabels };

// kBadInput with the path, what was found and what is accepted.
Result<MapFile> read_map(const std::filesystem::path& path, MapUse use = MapUse::kDepth);

}  // namespace neritic::sonar
