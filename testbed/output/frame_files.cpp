#include "testbed/output/frame_files.hpp"

namespace neritic::testbed {

FrameFiles::FrameFiles(Session& session, FrameFilesOptions options)
    : session_(session),
      options_(std::move(options)),
      survey_(session.scene(), options_.out, options_.survey) {}

Status FrameFiles::accept(const FrameResult& frame) {
  facts_ = {frame.time_s, session_.scene().seed, options_.scene, session_.device().info().name,
            frame.passes, frame.frame_ms};
  if (options_.folders) NERITIC_TRY_STATUS(write_folders(frame));
  return survey_.add(frame, frame.frame, frame.time_s);
}

Status FrameFiles::write_folders(const FrameResult& frame) {
  const std::filesystem::path folder = options_.out / frame_folder(frame.frame);
  for (const CameraFrame& camera : frame.cameras)
    for (std::size_t e = 0; e < camera.eyes.size(); ++e) {
      const std::string name =
          camera.eyes.size() == 1 ? camera.name : camera.name + (e == 0 ? "_left" : "_right");
      NERITIC_TRY_STATUS(write_view(folder / name, camera.eyes[e], facts_));
      written_.insert(folder / name);
    }
  for (const SonarFrame& sonar : frame.sonars) {
    NERITIC_TRY_STATUS(write_sonar_frame(folder / sonar_folder(sonar), sonar, facts_));
    written_.insert(folder / sonar.name);
  }
  return {};
}

Status FrameFiles::finish() {
  NERITIC_TRY(wrote_track_, survey_.write(facts_));
  return {};
}

}  // namespace neritic::testbed
