#include "sonar/coco.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/mask_runs.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::sonar {
namespace {

constexpr std::uint16_t kSeabed = scene::kClasses[0].id;

std::uint64_t key_of(std::uint16_t class_id, std::uint32_t part) {
  return std::uint64_t{class_id} << 32 | part;
}

// A number from 1 on for each connected part of shadow, 0 for small parts and for all else.
std::vector<std::uint32_t> shadow_parts(const LabelImage& labels) {
  const int height = static_cast<int>(labels.n_range), width = static_cast<int>(labels.n_beams);
  constexpr std::uint32_t kNew = ~0u;
  std::vector<std::uint32_t> parts(labels.classes.size());
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = labels.classes[i] == kShadow ? kNew : 0;
  std::uint32_t count = 0;
  std::vector<std::size_t> part;  // its bins, which are its queue too
  for (std::size_t first = 0; first < parts.size(); ++first) {
    if (parts[first] != kNew) continue;
    part.assign(1, first);
    parts[first] = ++count;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const int x = static_cast<int>(part[next]) % width, y = static_cast<int>(part[next]) / width;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          const std::size_t at =
              static_cast<std::size_t>(v) * labels.n_beams + static_cast<std::size_t>(u);
          if (parts[at] != kNew) continue;
          parts[at] = count;
          part.push_back(at);
        }
    }
    if (part.size() >= CocoFile::kLeastShadow) continue;
    for (const std::size_t at : part) parts[at] = 0;
    --count;
  }
  return parts;
}

// For each part of a shadow: the class and instance that is next nearer in the beams of most of its
// bins, without seabed, ghosts and shadows; parts with none before them are absent.
std::map<std::uint32_t, std::uint64_t> casters_of(const LabelImage& labels,
                                                  const std::vector<std::uint32_t>& parts,
                                                  RangeAxis range) {
  std::map<std::uint32_t, std::map<std::uint64_t, std::size_t>> bins;
  std::map<std::uint32_t, std::uint64_t> out;
  if (parts.empty()) return out;
  // Outwards along each beam, with what the last object on the way was.
  const auto walk = [&](std::size_t at, std::ptrdiff_t step, std::uint32_t count) {
    std::uint64_t last = 0;
    for (std::uint32_t i = 0; i < count; ++i, at += static_cast<std::size_t>(step)) {
      const std::uint16_t class_id = labels.classes[at];
      if (parts[at] != 0 && last != 0) ++bins[parts[at]][last];
      if (class_id != kWater && class_id != kSeabed && class_id != kShadow && class_id != kGhost &&
          labels.instances[at] != 0)
        last = key_of(class_id, labels.instances[at]);
    }
  };
  const std::uint32_t height = labels.n_range, width = labels.n_beams, half = width / 2;
  if (range == RangeAxis::kDown)
    for (std::uint32_t x = 0; x < width; ++x) walk(x, width, height);
  else
    for (std::size_t y = 0; y < height; ++y) {
      walk(y * width + half - 1, -1, half);
      walk(y * width + half, 1, half);
    }
  for (const auto& [part, by_object] : bins)
    out[part] =
        std::ranges::max_element(by_object, {}, [](const auto& b) { return b.second; })->first;
  return out;
}

}  // namespace

std::vector<std::uint32_t> run_lengths(std::span<const std::uint8_t> mask, std::uint32_t height,
                                       std::uint32_t width) {
  NERITIC_CHECK(mask.size() == std::size_t{height} * width, "{} pixels for {} x {}", mask.size(),
                height, width);
  MaskRuns out;
  for (std::uint32_t x = 0; x < width; ++x)
    for (std::uint32_t y = 0; y < height; ++y)
      if (mask[std::size_t{y} * width + x] != 0) out.add(x, y, height);
  out.close(mask.size());
  return out.runs;
}

CocoFile::CocoFile(std::map<std::uint16_t, std::string> class_names, RangeAxis range)
    : class_names_(std::move(class_names)), range_(range) {
  class_names_.erase(kWater);
}

void CocoFile::add(const std::string& file_name, const LabelImage& labels) {
  const std::uint32_t height = labels.n_range, width = labels.n_beams;
  const std::size_t image_id = images_.size() + 1;
  images_.push_back(
      {{"id", image_id}, {"file_name", file_name}, {"width", width}, {"height", height}});
  const std::vector<std::uint32_t> parts =
      class_names_.contains(kShadow) ? shadow_parts(labels) : std::vector<std::uint32_t>{};
  std::map<std::uint64_t, MaskRuns> masks;
  for (std::uint32_t x = 0; x < width; ++x) {
    std::uint64_t last_key = 0;
    MaskRuns* last = nullptr;
    for (std::uint32_t y = 0; y < height; ++y) {
      const std::size_t at = std::size_t{y} * width + x;
      if (labels.classes[at] == kWater) continue;
      const std::uint64_t key = key_of(
          labels.classes[at],
          labels.classes[at] == kShadow && !parts.empty() ? parts[at] : labels.instances[at]);
      if (last == nullptr || key != last_key) {
        if (!class_names_.contains(labels.classes[at])) continue;
        last = &masks[key];
        last_key = key;
      }
      last->add(x, y, height);
    }
  }
  const std::map<std::uint32_t, std::uint64_t> casters = casters_of(labels, parts, range_);
  std::map<std::uint64_t, std::size_t> ids;  // of annotations; shadows come after what casts them
  for (auto& [key, mask] : masks) {
    mask.close(std::uint64_t{height} * width);
    const std::size_t id = ids[key] = annotations_.size() + 1;
    const auto class_id = static_cast<std::uint16_t>(key >> 32);
    const auto part = static_cast<std::uint32_t>(key);  // the instance of all but shadow
    annotations_.push_back(
        {{"id", id},
         {"image_id", image_id},
         {"category_id", class_id},
         {"instance", class_id == kShadow ? 0 : part},
         // Several objects, or a surface all around: the box has no meaning.
         {"iscrowd", part == 0 || class_id == kSeabed ? 1 : 0},
         {"area", mask.area},
         {"bbox", {mask.left, mask.top, mask.right - mask.left + 1, mask.bottom - mask.top + 1}},
         {"segmentation", {{"size", {height, width}}, {"counts", mask.runs}}}});
    if (class_id != kShadow || !casters.contains(part)) continue;
    if (const auto caster = ids.find(casters.at(part)); caster != ids.end())
      annotations_.back()["cast_by"] = caster->second;
  }
}

nlohmann::json CocoFile::json(const nlohmann::json& scale) const {
  auto categories = nlohmann::json::array();
  for (const auto& [id, name] : class_names_)
    categories.push_back({{"id", id}, {"name", name}, {"supercategory", ""}});
  const char* axes = range_ == RangeAxis::kDown
                         ? "x counts beams from full port (or pings), y range bins from the nearest"
                         : "x counts range bins, port's reversed and then starboard's, y pings";
  nlohmann::json info{
      {"description",
       fmt::format("sonar labels by energy: {}; masks: uncompressed run lengths down the columns; "
                   "cast_by: annotation of what casts a shadow",
                   axes)}};
  info.update(scale);
  return {{"info", info},
          {"images", images_},
          {"annotations", annotations_},
          {"categories", categories}};
}

Status CocoFile::write(const std::filesystem::path& path, const nlohmann::json& scale) const {
  return write_text(path, json_text(json(scale), -1) + "\n");
}

}  // namespace neritic::sonar
