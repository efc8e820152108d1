// The files of a run of frames, as `render` writes them: a folder a frame and sensor, and what
// accumulates along the way. Rendering thread.
#pragma once

#include <set>

#include "testbed/output/camera_coco.hpp"
#include "testbed/output/label_files.hpp"
#include "testbed/output/survey.hpp"
#include "testbed/output/trajectory.hpp"
#include "testbed/sensors/frame_sink.hpp"

namespace neritic::testbed {

struct FrameFilesOptions {
  std::filesystem::path out;
  std::string scene;    // its file, as meta.json names it
  bool folders = true;  // false: only what accumulates
  FrameFormat format;
  SurveyOptions survey;
};

class FrameFiles final : public FrameSink {
 public:
  // The session outlives it.
  FrameFiles(Session& session, FrameFilesOptions options);
  Status accept(const FrameResult& frame) override;
  Status finish() override;

  // After finish: the sensors' folders, whether OUT/track has something, and what the user should
  // know: that a chart's cells are too fine, that depths are beyond what a .png holds.
  const std::set<std::filesystem::path>& folders() const { return written_; }
  bool wrote_track() const { return wrote_track_; }
  std::vector<std::string> hints() const;

 private:
  Status write_folders(const FrameResult& frame);
  Status write_camera(const std::filesystem::path& folder, const std::string& name,
                      const ViewImages& eye, const FrameResult& frame, const ViewImages* right);
  Session& session_;
  FrameFilesOptions options_;
  Survey survey_;
  CameraCoco coco_;
  KittiFiles kitti_;
  PanopticFiles panoptic_;
  TrajectoryFiles trajectory_;
  std::uint64_t far_pixels_ = 0, pixels_ = 0;  // of depth.png
  FrameFacts facts_;                           // of the newest frame
  std::set<std::filesystem::path> written_;
  bool wrote_track_ = false;
};

}  // namespace neritic::testbed
