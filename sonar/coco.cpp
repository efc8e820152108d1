#include "sonar/coco.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"

namespace neritic::sonar {
namespace {

// What an annotation says of one object, gathered in a walk down the columns.
struct Mask {
  std::uint32_t left = ~0u, top = ~0u, right = 0, bottom = 0;  // inclusive
  std::uint64_t area = 0;
  std::vector<std::uint32_t> runs{0};  // ends with a run inside the mask, once there is any
  std::uint64_t covered = 0;           // pixels that the runs span

  void add(std::uint32_t x, std::uint32_t y, std::uint32_t height) {
    const std::uint64_t at = std::uint64_t{x} * height + y;
    if (at == covered && area > 0) {
      ++runs.back();
    } else {
      if (area > 0) runs.push_back(0);
      runs.back() = static_cast<std::uint32_t>(at - covered);
      runs.push_back(1);
    }
    covered = at + 1;
    ++area;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  void close(std::uint64_t pixels) {
    if (covered < pixels) {
      if (area > 0) runs.push_back(0);
      runs.back() = static_cast<std::uint32_t>(pixels - covered);
    }
  }
};

}  // namespace

std::vector<std::uint32_t> run_lengths(std::span<const std::uint8_t> mask, std::uint32_t height,
                                       std::uint32_t width) {
  NERITIC_CHECK(mask.size() == std::size_t{height} * width, "{} pixels for {} x {}", mask.size(),
                height, width);
  Mask out;
  for (std::uint32_t x = 0; x < width; ++x)
    for (std::uint32_t y = 0; y < height; ++y)
      if (mask[std::size_t{y} * width + x] != 0) out.add(x, y, height);
  out.close(mask.size());
  return out.runs;
}

CocoFile::CocoFile(std::map<std::uint16_t, std::string> class_names)
    : class_names_(std::move(class_names)) {
  class_names_.erase(kWater);
}

void CocoFile::add(const std::string& file_name, const LabelImage& labels) {
  const std::uint32_t height = labels.n_range, width = labels.n_beams;
  const std::size_t image_id = images_.size() + 1;
  images_.push_back(
      {{"id", image_id}, {"file_name", file_name}, {"width", width}, {"height", height}});
  std::map<std::uint32_t, Mask> masks;  // by class, instance
  for (std::uint32_t x = 0; x < width; ++x) {
    std::uint32_t last_key = 0;
    Mask* last = nullptr;
    for (std::uint32_t y = 0; y < height; ++y) {
      const std::size_t at = std::size_t{y} * width + x;
      if (labels.classes[at] == kWater) continue;
      const std::uint32_t key = std::uint32_t{labels.classes[at]} << 16 | labels.instances[at];
      if (last == nullptr || key != last_key) {
        if (!class_names_.contains(labels.classes[at])) continue;
        last = &masks[key];
        last_key = key;
      }
      last->add(x, y, height);
    }
  }
  for (auto& [key, mask] : masks) {
    mask.close(std::uint64_t{height} * width);
    annotations_.push_back(
        {{"id", annotations_.size() + 1},
         {"image_id", image_id},
         {"category_id", key >> 16},
         {"instance", key & 0xffff},
         {"iscrowd", (key & 0xffff) == 0 ? 1 : 0},  // of many things, whose box tells nothing
         {"area", mask.area},
         {"bbox", {mask.left, mask.top, mask.right - mask.left + 1, mask.bottom - mask.top + 1}},
         {"segmentation", {{"size", {height, width}}, {"counts", mask.runs}}}});
  }
}

nlohmann::json CocoFile::json() const {
  auto categories = nlohmann::json::array();
  for (const auto& [id, name] : class_names_)
    categories.push_back({{"id", id}, {"name", name}, {"supercategory", ""}});
  return {{"info",
           {{"description",
             "sonar labels by energy: x counts beams from full port, y range bins "
             "from the nearest; masks: uncompressed run lengths down the columns"}}},
          {"images", images_},
          {"annotations", annotations_},
          {"categories", categories}};
}

Status CocoFile::write(const std::filesystem::path& path) const {
  return write_text(path, json_text(json(), -1) + "\n");
}

}  // namespace neritic::sonar
