// `neritic sonar`: sonar images from depth and normal images of anyone's making, no scene.
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/sensors/validation.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/sonar_folder.hpp"
#include "tools/neritic/sonar_picture.hpp"
#include "tools/neritic/sonar_resume.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

Status run_one(const SonarJob& job, SonarNotes& notes) {
  const SonarFlags& flags = job.flags;
  const std::filesystem::path lead = flags.method == "image" ? flags.picture : flags.depth;
  const sonar::FrameFiles files{sonar::frame_names(std::span(&lead, 1)).front(),
                                {flags.depth, flags.normals, flags.labels, flags.picture}};
  if (flags.method == "image") {
    NERITIC_TRY(PictureLine line, load_picture_line(job, files, notes));
    return write_picture_line(job, flags.out, std::move(line));
  }
  NERITIC_TRY(LoadedFrame frame, load_frame(job, files, notes));
  if (flags.method == "reference")
    return write_heard_frame(job, flags.out, hear_by_reference(job, std::move(frame)));
  NERITIC_TRY(const std::unique_ptr<SonarEar> ear, SonarEar::create(job));
  NERITIC_TRY(HeardFrame heard, ear->hear(std::move(frame)));
  NERITIC_TRY_STATUS(check_validation(ear->device()));
  return write_heard_frame(job, flags.out, std::move(heard));
}

}  // namespace

Result<std::string> run_sonar(const SonarFlags& flags) {
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out));
  NERITIC_TRY(const SonarJob job, plan_job(flags));
  const bool estimated = flags.normals.empty() && flags.method != "image";
  if (is_folder_job(job)) {
    NERITIC_TRY(std::string done, run_folder(job));
    if (estimated) log_warn("no --normals: estimated from the depth images");
    return done;
  }
  if (flags.overwrite || flags.workers > 0)
    return refusal("--overwrite, --workers", "with a single frame", "with folders of frames");
  SonarNotes notes;
  NERITIC_TRY_STATUS(run_one(job, notes));
  notes.release();
  if (estimated) log_warn("no --normals: estimated from the depth image");
  return fmt::format("{}: {}", flags.out.string(), fmt::join(result_files(flags.out), ", "));
}

}  // namespace neritic::tools
