// The data of a run that are written, by name: the user's choice (`render --only`), and what a
// frame must give for it. Pure functions; any thread.
#pragma once

#include <bitset>
#include <span>
#include <string_view>

#include "engine/core/result.hpp"
#include "testbed/sensors/frame_request.hpp"

namespace neritic::testbed {

enum class Dataset {
  kColor,
  kDepth,
  kNormals,
  kLabels,
  kInstances,
  kMotion,
  kSonar,       // what sonars hear, and accumulate
  kCoco,        // boxes and masks of what cameras see
  kTrajectory,  // where every participant is
  kLinear,      // of cameras that name it: the picture before the tone curve
  kRaw,         // of cameras that name it: the image sensor's counts
  kBoxes,       // of what cameras see, in two and three dimensions
  kKitti,       // the same as KITTI's files
  kPanoptic,    // segments as COCO's panoptic format
};
// In the order of Dataset.
inline constexpr std::string_view kDatasetNames[] = {
    "color", "depth",      "normals", "labels", "instances", "motion", "sonar",
    "coco",  "trajectory", "linear",  "raw",    "boxes",     "kitti",  "panoptic"};

class Datasets {
 public:
  Datasets() = default;  // none
  // The default: all but the formats that repeat what other files hold.
  static Datasets all() {
    Datasets out;
    out.bits_.set();
    for (const Dataset again : {Dataset::kBoxes, Dataset::kKitti, Dataset::kPanoptic})
      out.bits_.reset(static_cast<std::size_t>(again));
    return out;
  }
  bool has(Dataset one) const { return bits_.test(static_cast<std::size_t>(one)); }
  Datasets& add(Dataset one) {
    bits_.set(static_cast<std::size_t>(one));
    return *this;
  }
  // Whether cameras, and whether sonars give any of it.
  bool of_cameras() const;
  bool of_sonars() const;

 private:
  std::bitset<std::size(kDatasetNames)> bits_;
};

// "color,depth" or several of them. kBadInput names the flag, the word and the names accepted.
Result<Datasets> parse_datasets(std::string_view flag, std::span<const std::string> lists);

// The data that frames must bring to the host.
Capture capture_of(const Datasets& datasets);

}  // namespace neritic::testbed
