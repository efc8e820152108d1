// The sight of cameras as one data set in the format of COCO (cocodataset.org, "Data format"), for
// training and judging detectors: OUT/coco.json with a category a class, an image a picture and an
// annotation for each instance in it. Boxes and masks are of visible pixels. Written as it grows
// (growing_file.hpp). One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "engine/core/growing_file.hpp"
#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

class CameraCoco {
 public:
  // class_names: the categories, by class; what has none is in no annotation.
  CameraCoco(const std::filesystem::path& file, std::map<std::uint16_t, std::string> class_names);

  // view: with labels and instances. file_name: of the picture, from the data set's folder on.
  // Instance 0 and the seabed are crowds: their boxes have no meaning.
  Status add(const std::string& file_name, const std::string& camera, const ViewImages& view,
             const FrameResult& frame);
  Status finish();

 private:
  Status begin();
  std::map<std::uint16_t, std::string> class_names_;
  GrowingFile file_;
  std::string images_;  // a line each, for the end of the file
  std::uint64_t image_count_ = 0, annotations_ = 0;
};

}  // namespace neritic::testbed
