#include "testbed/output/label_files.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint16_t kStuffClass = scene::kClasses[0].id;

std::string name_of(const std::map<std::uint16_t, std::string>& names, std::uint16_t id) {
  const auto at = names.find(id);
  return at == names.end() ? fmt::format("class_{}", id) : at->second;
}

nlohmann::json json_of(const Vec3& v) {
  return {v.x, v.y, v.z};
}
nlohmann::json json_of(const PixelBox& box) {
  return {box.left, box.top, box.right - box.left, box.bottom - box.top};
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * kPi);
}

// KITTI knows three grades.
int occlusion_of(double share) {
  return share < 0.1 ? 0 : share < 0.5 ? 1 : 2;
}

// A projection in KITTI's form: a camera that stands right_m along x from the axes of the labels.
std::string projection_of(const Intrinsics& k, double right_m) {
  return fmt::format("{:.9g} 0 {:.9g} {:.9g} 0 {:.9g} {:.9g} 0 0 0 1 0", k.fx, k.cx,
                     right_m == 0.0 ? 0.0 : -k.fx * right_m, k.fy, k.cy);
}

// KITTI's colour cameras are 2 and 3, its grey ones 0 and 1 beside them. Pictures are rectified;
// there is no laser scanner or inertial unit, whose axes are therefore the camera's.
std::string calibration_of(const ViewImages& view, const ViewImages* right) {
  const std::string left_p = projection_of(view.intrinsics, 0.0);
  const std::string right_p =
      right == nullptr
          ? left_p
          : projection_of(right->intrinsics, glm::distance(view.world_from_view.position_m,
                                                           right->world_from_view.position_m));
  constexpr const char* kSame = "1 0 0 0 0 1 0 0 0 0 1 0";
  return fmt::format(
      "P0: {0}\nP1: {1}\nP2: {0}\nP3: {1}\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: {2}\n"
      "Tr_imu_to_velo: {2}\n",
      left_p, right_p, kSame);
}

}  // namespace

Status write_boxes(const std::filesystem::path& folder, const ViewImages& view,
                   const std::map<std::uint16_t, std::string>& class_names) {
  auto boxes = nlohmann::json::array();
  for (const InstanceBox& box : view.boxes) {
    const Quat& q = box.world_from_box.rotation;
    boxes.push_back({{"class", box.class_id},
                     {"class_name", name_of(class_names, box.class_id)},
                     {"instance", box.instance},
                     {"object", box.object},
                     {"bbox", json_of(box.seen)},
                     {"bbox_whole", json_of(box.whole)},
                     {"visible_px", box.seen_px},
                     {"truncated", box.truncated},
                     {"occluded", box.occluded},
                     {"box",
                      {{"position_m", json_of(box.world_from_box.position_m)},
                       {"rotation_xyzw", {q.x, q.y, q.z, q.w}},
                       {"size_m", json_of(box.size_m)}}}});
  }
  return write_json(folder / "boxes.json",
                    {{"boxes", boxes},
                     {"bbox",
                      "[left, top, width, height], pixels; bbox_whole: as if nothing stood "
                      "before it, beyond the picture's edges too"},
                     {"box",
                      "middle and sides along x, y, z of the object's axes (x right, y up, "
                      "z backwards), world_from_box"}});
}

Status KittiFiles::add(const std::string& camera, const ViewImages& view, std::uint32_t frame,
                       const ViewImages* right) {
  const std::filesystem::path root = out_ / "kitti" / camera;
  const std::string number = fmt::format("{:06}", frame);
  std::string lines;
  for (const InstanceBox& box : view.boxes) {
    if (box.class_id == kStuffClass) continue;
    const Vec3& middle = box.upright_middle_m;
    // From view axes (y up, z backwards) to KITTI's: x right, y down, z ahead; the underside.
    const double x = middle.x, y = -middle.y + 0.5 * box.upright_size_m.y, z = -middle.z;
    // Heading (sin, cos) of the yaw about the view's y: KITTI's 0 looks along x.
    const double turn =
        wrapped(std::atan2(-std::cos(box.upright_yaw_rad), -std::sin(box.upright_yaw_rad)));
    const double alpha = wrapped(turn - std::atan2(x, z));
    lines += fmt::format(
        "{} {:.2f} {} {:.4f} {:.2f} {:.2f} {:.2f} {:.2f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} "
        "{:.4f}\n",
        name_of(class_names_, box.class_id), box.truncated, occlusion_of(box.occluded), alpha,
        box.seen.left, box.seen.top, box.seen.right, box.seen.bottom, box.upright_size_m.y,
        box.upright_size_m.x, box.upright_size_m.z, x, y, z, turn);
  }
  for (const char* folder : {"label_2", "calib", "image_2"})
    NERITIC_TRY_STATUS(make_folder(root / folder));
  NERITIC_TRY_STATUS(write_text(root / "label_2" / (number + ".txt"), lines));
  NERITIC_TRY_STATUS(write_text(root / "calib" / (number + ".txt"), calibration_of(view, right)));
  if (right != nullptr && !right->color.empty()) {
    NERITIC_TRY_STATUS(make_folder(root / "image_3"));
    NERITIC_TRY_STATUS(scene::write_png8(root / "image_3" / (number + ".png"), right->color));
  }
  if (view.color.empty()) return {};
  return scene::write_png8(root / "image_2" / (number + ".png"), view.color);
}

Status PanopticFiles::add(const std::filesystem::path& folder, const std::string& picture,
                          const ViewImages& view) {
  struct Segment {
    std::uint64_t area = 0;
    std::uint32_t left = ~0u, top = ~0u, right = 0, bottom = 0;
    std::uint16_t class_id = 0;
  };
  std::map<std::uint32_t, Segment> segments;
  ImageU8 pixels(view.width, view.height, 3);
  for (std::uint32_t y = 0; y < view.height; ++y)
    for (std::uint32_t x = 0; x < view.width; ++x) {
      const std::uint16_t class_id = view.labels.at(x, y), instance = view.instances.at(x, y);
      if (class_id == 0 || !class_names_.contains(class_id)) continue;
      // Instances come first in the id; stuff is numbered after them by its class.
      const bool stuff = instance == 0 || class_id == kStuffClass;
      const std::uint32_t id = stuff ? 65536u + class_id : instance;
      Segment& s = segments[id];
      s.class_id = class_id;
      ++s.area;
      s.left = std::min(s.left, x);
      s.right = std::max(s.right, x);
      s.top = std::min(s.top, y);
      s.bottom = std::max(s.bottom, y);
      for (std::size_t c = 0; c < 3; ++c)
        pixels.data[3 * (std::size_t{y} * view.width + x) + c] =
            static_cast<std::uint8_t>(id >> (8 * c));
    }
  NERITIC_TRY_STATUS(make_folder(out_ / folder));
  NERITIC_TRY_STATUS(scene::write_png8(out_ / folder / "panoptic.png", pixels));
  if (image_count_++ == 0) {
    auto categories = nlohmann::json::array();
    for (const auto& [id, name] : class_names_)
      categories.push_back({{"id", id},
                            {"name", name},
                            {"supercategory", ""},
                            {"isthing", id == kStuffClass ? 0 : 1}});
    NERITIC_TRY_STATUS(file_.append(
        fmt::format("{{\"categories\": {},\n\"annotations\": [", json_text(categories, -1))));
  }
  auto infos = nlohmann::json::array();
  for (const auto& [id, s] : segments)
    infos.push_back({{"id", id},
                     {"category_id", s.class_id},
                     {"area", s.area},
                     {"bbox", {s.left, s.top, s.right - s.left + 1, s.bottom - s.top + 1}},
                     {"iscrowd", 0}});  // stuff is told by its category
  const nlohmann::json annotation{{"image_id", image_count_},
                                  {"file_name", (folder / "panoptic.png").generic_string()},
                                  {"segments_info", infos}};
  const nlohmann::json image{
      {"id", image_count_}, {"file_name", picture}, {"width", view.width}, {"height", view.height}};
  const char* comma = image_count_ > 1 ? ",\n" : "\n";
  images_ += comma + json_text(image, -1);
  return file_.append(comma + json_text(annotation, -1));
}

Status PanopticFiles::finish() {
  if (image_count_ == 0) return {};
  NERITIC_TRY_STATUS(file_.append("],\n\"images\": [" + images_ + "]}\n"));
  return file_.finish();
}

}  // namespace neritic::testbed
