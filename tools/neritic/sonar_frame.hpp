// One frame of `neritic sonar`: its images read, its sonar image made, its files written. Reading
// and writing may run on any thread, several frames at once.
#pragma once

#include <memory>

#include "engine/gpu/device.hpp"
#include "sonar/image_gather.hpp"
#include "sonar/offline_frames.hpp"
#include "sonar/panel.hpp"
#include "tools/neritic/sonar_job.hpp"
#include "tools/neritic/sonar_notes.hpp"

namespace neritic::tools {

// Where a group of images stands in FrameFiles::paths.
enum FrameGroup : std::size_t { kDepthGroup, kNormalGroup, kLabelGroup, kPictureGroup, kGroups };

// Says once that whole numbers are taken as metres, where the map holds some and no scale is given.
void note_whole_metres(const SonarJob& job, const sonar::MapFile& depth, SonarNotes& notes);

struct LoadedFrame {
  sonar::SonarInput in;
  sonar::FrameFiles files;
  nlohmann::json facts;  // for sonar.json
};
// kBadInput that names the file or flag.
Result<LoadedFrame> load_frame(const SonarJob& job, const sonar::FrameFiles& files,
                               SonarNotes& notes);
// The pinhole that the flags give to a depth image (or picture).
Result<Intrinsics> frame_intrinsics(const SonarFlags& flags, const sonar::MapFile& image);

struct HeardFrame {
  sonar::SonarImage image;
  std::optional<sonar::LabelImage> label_energy;
  nlohmann::json facts;
};
// The published loop on the CPU. Any thread.
HeardFrame hear_by_reference(const SonarJob& job, LoadedFrame frame);

// The same on a GPU, with the terms. Keeps its passes from frame to frame while the images' size
// and pinhole stay the same. One thread.
class SonarEar {
 public:
  static Result<std::unique_ptr<SonarEar>> create(const SonarJob& job);
  // kBadInput where the frame cannot be taken; any other error is the device's.
  Result<HeardFrame> hear(LoadedFrame frame);
  const gpu::Device& device() const { return *device_; }

 private:
  explicit SonarEar(const SonarJob& job) : job_(job) {}
  Status prepare(const sonar::SonarInput& in);

  const SonarJob& job_;
  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<sonar::ImageGather> gather_;  // after device_: goes first
  sonar::SonarInput shape_;                     // what gather_ was made for, without its pixels
};

// Into the folder, sonar.json last. panel: the job's, where there are many frames to draw.
Status write_heard_frame(const SonarJob& job, const std::filesystem::path& folder, HeardFrame frame,
                         const sonar::PolarPanel* panel = nullptr);
// Nothing where no picture is asked for, or it is not polar.
std::unique_ptr<sonar::PolarPanel> panel_of(const SonarJob& job);

}  // namespace neritic::tools
