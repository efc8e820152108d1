// Results that accumulate while a sonar moves along a track: point cloud and bathymetric grid of a
// profiling sonar, the range-time record of an echo sounder, the waterfall of a side-scan, the turn
// of a mechanical scanner, COCO boxes with their pictures. Fed frame by frame; written once. One
// thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "testbed/output/output.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

struct SurveyOptions {
  double chart_cell_m = 0.0;  // of bathymetric grids; 0: a fiftieth of the sonar's farthest range
  bool tracks = true;         // false: boxes alone, which one frame has too
};

// kBadInput where a side-scan's picture camera does not look straight down.
Status check_picture_camera(const scene::Sonar& sonar, const Pose& world_from_camera);

class Survey {
 public:
  // The scene tells the sonars' kinds, the classes' names and where the true bottom lies (its
  // objects of class seabed). Must outlive it. out: where OUT/track/SONAR/ is written for each
  // sonar with results of a track.
  Survey(const scene::Scene& scene, std::filesystem::path out, const SurveyOptions& options = {});
  ~Survey();

  // number: of the frame, as its folder is named (frame_folder). Writes the picture that COCO boxes
  // lie over, OUT/track/SONAR/coco/FRAME.png: one grey pixel a bin. Those of single beams, which
  // lie side by side, come with all else (coco/pings_FIRST.png). kBadInput where a side-scan's
  // picture camera is not in the frame or does not suit it.
  Status add(const FrameResult& result, std::uint32_t number, double time_s);
  // Writes all else. True: some sonar had results.
  Result<bool> write(const FrameFacts& facts) const;
  // Advice if the user named no cell size and a chart's cells are finer than its pings lie.
  std::optional<std::string> hint() const;

 private:
  struct Record;
  Record& record_of(const SonarFrame& frame);
  const scene::Scene& scene_;
  const std::filesystem::path out_;
  const SurveyOptions options_;
  std::map<std::string, std::unique_ptr<Record>> records_;
};

}  // namespace neritic::testbed
