#include "testbed/output/frame_files.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

constexpr float kFarthestOfPng_m = 65.5345f;  // rounds to the last unit that is no mark

}  // namespace

FrameFiles::FrameFiles(Session& session, FrameFilesOptions options)
    : session_(session),
      options_(std::move(options)),
      survey_(session.scene(), options_.out, options_.survey),
      coco_(options_.out / "coco.json", session.scene().class_names),
      kitti_(options_.out, session.scene().class_names),
      panoptic_(options_.out, session.scene().class_names),
      trajectory_(participants_of(session.scene()), options_.out) {}

Status FrameFiles::accept(const FrameResult& frame) {
  facts_ = {frame.time_s, session_.scene().seed, options_.scene, session_.device().info().name,
            frame.passes, frame.frame_ms};
  if (options_.folders) NERITIC_TRY_STATUS(write_folders(frame));
  if (options_.format.datasets.has(Dataset::kTrajectory))
    NERITIC_TRY_STATUS(trajectory_.add(frame));
  return survey_.add(frame, frame.frame, frame.time_s);
}

Status FrameFiles::write_folders(const FrameResult& frame) {
  const std::filesystem::path folder = options_.out / frame_folder(frame.frame);
  // A camera may be there for a side-scan alone.
  for (const CameraFrame& camera : frame.cameras)
    for (std::size_t e = 0; e < camera.eyes.size() && options_.format.datasets.of_cameras(); ++e) {
      const std::string name =
          camera.eyes.size() == 1 ? camera.name : camera.name + (e == 0 ? "_left" : "_right");
      NERITIC_TRY_STATUS(
          write_camera(folder, name, camera.eyes[e], frame,
                       e == 0 && camera.eyes.size() == 2 ? &camera.eyes[1] : nullptr));
    }
  for (const SonarFrame& sonar : frame.sonars) {
    NERITIC_TRY_STATUS(
        write_sonar_frame(folder / sonar_folder(sonar), sonar, facts_, options_.format));
    written_.insert(folder / sonar.name);
  }
  return {};
}

Status FrameFiles::write_camera(const std::filesystem::path& folder, const std::string& name,
                                const ViewImages& eye, const FrameResult& frame,
                                const ViewImages* right) {
  NERITIC_TRY_STATUS(write_view(folder / name, eye, facts_, options_.format));
  written_.insert(folder / name);
  const Datasets& datasets = options_.format.datasets;
  if (datasets.has(Dataset::kDepth) && options_.format.packing == Packing::kPng) {
    pixels_ += eye.depth.data.size();
    far_pixels_ += static_cast<std::uint64_t>(std::ranges::count_if(
        eye.depth.data, [](float d) { return std::isfinite(d) && d > kFarthestOfPng_m; }));
  }
  const std::filesystem::path part = folder.filename() / name;
  const std::string picture = (part / "color.png").generic_string();
  if (datasets.has(Dataset::kBoxes))
    NERITIC_TRY_STATUS(write_boxes(folder / name, eye, session_.scene().class_names));
  if (datasets.has(Dataset::kKitti)) NERITIC_TRY_STATUS(kitti_.add(name, eye, frame.frame, right));
  if (datasets.has(Dataset::kPanoptic)) NERITIC_TRY_STATUS(panoptic_.add(part, picture, eye));
  return datasets.has(Dataset::kCoco) ? coco_.add(picture, name, eye, frame) : Status();
}

Status FrameFiles::finish() {
  NERITIC_TRY(wrote_track_, survey_.write(facts_));
  NERITIC_TRY_STATUS(trajectory_.finish());
  NERITIC_TRY_STATUS(panoptic_.finish());
  return coco_.finish();
}

std::vector<std::string> FrameFiles::hints() const {
  std::vector<std::string> hints;
  if (const auto hint = survey_.hint()) hints.push_back(*hint);
  if (far_pixels_ > 0)
    hints.push_back(fmt::format(
        "depth.png: {:.2g} % of the pixels are farther than 65.534 m, 65535 there (--compress npz "
        "keeps them)",
        100.0 * static_cast<double>(far_pixels_) / static_cast<double>(pixels_)));
  return hints;
}

}  // namespace neritic::testbed
