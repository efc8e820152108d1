#include "testbed/output/camera_coco.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/mask_runs.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint16_t kSeabed = scene::kClasses[0].id;

// By class and instance.
std::map<std::pair<std::uint16_t, std::uint16_t>, MaskRuns> masks_of(const ViewImages& view) {
  std::map<std::pair<std::uint16_t, std::uint16_t>, MaskRuns> masks;
  for (std::uint32_t x = 0; x < view.width; ++x) {
    std::pair<std::uint16_t, std::uint16_t> last_key{};
    MaskRuns* last = nullptr;
    for (std::uint32_t y = 0; y < view.height; ++y) {
      const std::pair key(view.labels.at(x, y), view.instances.at(x, y));
      if (key.first == 0) continue;
      if (last == nullptr || key != last_key) last = &masks[key];
      last_key = key;
      last->add(x, y, view.height);
    }
  }
  for (auto& [key, mask] : masks) mask.close(std::uint64_t{view.width} * view.height);
  return masks;
}

}  // namespace

CameraCoco::CameraCoco(const std::filesystem::path& file,
                       std::map<std::uint16_t, std::string> class_names)
    : class_names_(std::move(class_names)), file_(file) {}

Status CameraCoco::begin() {
  auto categories = nlohmann::json::array();
  for (const auto& [id, name] : class_names_)
    categories.push_back({{"id", id}, {"name", name}, {"supercategory", ""}});
  const nlohmann::json info{
      {"description",
       "what cameras see: boxes [x, y, width, height] and masks of visible pixels; masks: "
       "uncompressed run lengths down the columns; instance: as in instances.npy"}};
  return file_.append(fmt::format("{{\"info\": {},\n\"categories\": {},\n\"annotations\": [",
                                  json_text(info, -1), json_text(categories, -1)));
}

Status CameraCoco::add(const std::string& file_name, const std::string& camera,
                       const ViewImages& view, const FrameResult& frame) {
  if (image_count_ == 0) NERITIC_TRY_STATUS(begin());
  const nlohmann::json image{{"id", ++image_count_},  {"file_name", file_name},
                             {"width", view.width},   {"height", view.height},
                             {"camera", camera},      {"frame", frame.frame},
                             {"time_s", frame.time_s}};
  images_ += (image_count_ > 1 ? ",\n" : "\n") + json_text(image, -1);
  for (const auto& [key, mask] : masks_of(view)) {
    const auto& [class_id, instance] = key;
    if (!class_names_.contains(class_id)) continue;
    const bool crowd = instance == 0 || class_id == kSeabed;
    NERITIC_TRY_STATUS(file_.append(fmt::format(
        "{}\n{{\"id\": {}, \"image_id\": {}, \"category_id\": {}, \"instance\": {}, \"iscrowd\": "
        "{}, \"area\": {}, \"bbox\": [{}, {}, {}, {}], \"segmentation\": {{\"size\": [{}, {}], "
        "\"counts\": [{}]}}}}",
        annotations_ > 0 ? "," : "", annotations_ + 1, image_count_, class_id, instance,
        crowd ? 1 : 0, mask.area, mask.left, mask.top, mask.right - mask.left + 1,
        mask.bottom - mask.top + 1, view.height, view.width, fmt::join(mask.runs, ","))));
    ++annotations_;
  }
  return {};
}

Status CameraCoco::finish() {
  if (image_count_ == 0) return {};
  NERITIC_TRY_STATUS(file_.append("],\n\"images\": [" + images_ + "]}\n"));
  return file_.finish();
}

}  // namespace neritic::testbed
