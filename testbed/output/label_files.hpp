// Labels of cameras in the formats that others train with: KITTI's object files
// (OUT/kitti/CAMERA/...), COCO's panoptic segmentation (OUT/panoptic.json with a picture of
// segments beside it), and boxes in two and three dimensions as JSON. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "engine/core/growing_file.hpp"
#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

// SENSOR/boxes.json.
Status write_boxes(const std::filesystem::path& folder, const ViewImages& view,
                   const std::map<std::uint16_t, std::string>& class_names);

// KITTI's object detection benchmark (Geiger, Lenz and Urtasun 2012, devkit): label_2/N.txt with
// type, truncation, occlusion, alpha, the box in pixels, height, width, length, the middle of the
// box's underside in camera axes (x right, y down, z ahead), and the heading about y; calib/N.txt;
// image_2/N.png where there is a picture. A stereo pair's left eye has the right one's pictures as
// image_3/N.png, and its place in P3.
class KittiFiles {
 public:
  KittiFiles(std::filesystem::path out, std::map<std::uint16_t, std::string> class_names)
      : out_(std::move(out)), class_names_(std::move(class_names)) {}
  // right: of a pair whose left eye the view is; nullptr: none.
  Status add(const std::string& camera, const ViewImages& view, std::uint32_t frame,
             const ViewImages* right = nullptr);

 private:
  std::filesystem::path out_;
  std::map<std::uint16_t, std::string> class_names_;
};

// COCO's panoptic format: a segment a class and instance (the seabed and what has no instance of
// its own is stuff), its id in the pixels of a .png: R + 256 G + 65536 B.
class PanopticFiles {
 public:
  PanopticFiles(std::filesystem::path out, std::map<std::uint16_t, std::string> class_names)
      : out_(std::move(out)), class_names_(std::move(class_names)), file_(out_ / "panoptic.json") {}
  // folder, picture: of the camera's frame, from the data set's folder on.
  Status add(const std::filesystem::path& folder, const std::string& picture,
             const ViewImages& view);
  Status finish();

 private:
  std::filesystem::path out_;
  std::map<std::uint16_t, std::string> class_names_;
  GrowingFile file_;
  std::string images_;
  std::uint64_t image_count_ = 0;
};

}  // namespace neritic::testbed
