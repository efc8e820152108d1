#include "sonar/map_file.hpp"

#include "engine/core/files.hpp"
#include "engine/core/npz.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/netpbm_file.hpp"

namespace neritic::sonar {
namespace {

template <class T>
MapFile from_raster(const std::filesystem::path& path, const Raster<T>& raster,
                    MapFile::Coding coding) {
  MapFile map;
  map.path = path.string();
  map.width = raster.width;
  map.height = raster.height;
  map.channels = raster.channels;
  map.coding = coding;
  map.whole_numbers = coding != MapFile::Coding::kNumbers;
  map.values.assign(raster.data.begin(), raster.data.end());
  return map;
}

std::span<const std::string_view> names_in_archive(MapUse use) {
  static constexpr std::string_view kDepth[] = {"depth", "disparity", "range", "arr_0"};
  static constexpr std::string_view kNormals[] = {"normals", "normal", "arr_0"};
  static constexpr std::string_view kLabels[] = {"labels", "label", "mask", "arr_0"};
  if (use == MapUse::kNormals) return kNormals;
  return use == MapUse::kLabels ? std::span<const std::string_view>(kLabels) : kDepth;
}

Result<MapFile> from_array(const std::filesystem::path& path, const NpyArray& array) {
  if (array.shape.size() < 2 || array.shape.size() > 3)
    return refusal(path.string(), fmt::format("an array of {} axes", array.shape.size()),
                   "[height, width] or [height, width, channels]");
  const std::size_t channels = array.shape.size() == 3 ? array.shape[2] : 1;
  if (array.shape[0] > 32768 || array.shape[1] > 32768 || channels > 16)
    return refusal(path.string(),
                   fmt::format("{} x {} x {}", array.shape[1], array.shape[0], channels),
                   "at most 32768 x 32768 x 16");
  MapFile map;
  map.path = path.string();
  map.height = static_cast<std::uint32_t>(array.shape[0]);
  map.width = static_cast<std::uint32_t>(array.shape[1]);
  map.channels = static_cast<std::uint32_t>(channels);
  if (array.type == NpyType::kUint8) map.coding = MapFile::Coding::kCoded8;
  if (array.type == NpyType::kUint16) map.coding = MapFile::Coding::kCoded16;
  map.whole_numbers = !is_float(array.type);
  map.values = array.to_doubles();
  return map;
}

Result<MapFile> read_netpbm_map(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  NERITIC_TRY(scene::NetpbmMap read, scene::parse_netpbm(bytes, path.string()));
  MapFile map;
  map.path = path.string();
  map.width = read.width;
  map.height = read.height;
  map.channels = read.channels;
  if (read.bits == 8) map.coding = MapFile::Coding::kCoded8;
  if (read.bits == 16) map.coding = MapFile::Coding::kCoded16;
  map.whole_numbers = read.bits != 0;
  map.values = std::move(read.values);
  return map;
}

}  // namespace

Result<MapFile> read_map(const std::filesystem::path& path, MapUse use) {
  const std::string extension = lower_case(path.extension().string());
  MapFile map;
  if (extension == ".npy") {
    NERITIC_TRY(const NpyArray array, read_npy(path));
    NERITIC_TRY(map, from_array(path, array));
  } else if (extension == ".npz") {
    NERITIC_TRY(const NpyArray array, read_npz(path, names_in_archive(use)));
    NERITIC_TRY(map, from_array(path, array));
  } else if (extension == ".pgm" || extension == ".pfm") {
    NERITIC_TRY(map, read_netpbm_map(path));
  } else if (extension == ".exr") {
    NERITIC_TRY(const scene::ExrImage exr, scene::read_exr(path));
    map = from_raster(path, exr.image, MapFile::Coding::kNumbers);
    map.channel_names = exr.names;
  } else if (extension == ".png" && scene::is_png16(path)) {
    NERITIC_TRY(const ImageU16 image, scene::read_image16(path));
    map = from_raster(path, image, MapFile::Coding::kCoded16);
  } else if (extension == ".png" && use != MapUse::kNormals) {
    NERITIC_TRY(const scene::PngNumbers numbers, scene::read_png_numbers(path));
    map = from_raster(path, numbers.image, MapFile::Coding::kCoded8);
    map.palette = numbers.palette;
  } else if (extension == ".png") {
    NERITIC_TRY(const ImageU8 image, scene::read_image8(path));
    map = from_raster(path, image, MapFile::Coding::kCoded8);
  } else {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::none)
      return refusal(path.string(), error.message(), "a file or folder that can be read");
    if (!std::filesystem::exists(status))
      return refusal(path.string(), "no such file or folder", "one that can be read");
    return refusal(path.string(), fmt::format("a file named '{}'", extension),
                   ".npy, .npz, .png, .pgm, .pfm or .exr");
  }
  if (map.pixels() == 0 || map.channels == 0)
    return refusal(
        path.string(),
        fmt::format("{} x {} pixels of {} channels", map.width, map.height, map.channels),
        "at least one of each");
  return map;
}

}  // namespace neritic::sonar
