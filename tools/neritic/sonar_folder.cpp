#include "tools/neritic/sonar_folder.hpp"

#include <malloc.h>

#include <atomic>
#include <set>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/sensors/validation.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/interrupt.hpp"
#include "tools/neritic/sonar_picture.hpp"
#include "tools/neritic/sonar_pipeline.hpp"
#include "tools/neritic/sonar_resume.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;
using sonar::FrameFiles;

constexpr const char* kMaps[] = {"npy", "png", "exr"};
constexpr const char* kPictures[] = {"png", "jpg", "jpeg"};

struct Group {
  FrameGroup group;
  const char* flag;
  const std::string& pattern;
};
std::vector<Group> groups_of(const SonarFlags& flags) {
  return {{kDepthGroup, "depth", flags.depth},
          {kNormalGroup, "normals", flags.normals},
          {kLabelGroup, "labels", flags.labels},
          {kPictureGroup, "picture", flags.picture}};
}

// Files of the other groups that no frame has taken.
void list_unpaired(const SonarJob& job, const std::vector<std::vector<fs::path>>& files,
                   const std::vector<FrameFiles>& frames, FrameGroup lead, FrameList& skipped) {
  const std::vector<Group> groups = groups_of(job.flags);
  std::set<fs::path> taken;
  for (const FrameFiles& frame : frames) taken.insert(frame.paths.begin(), frame.paths.end());
  for (const Group& g : groups)
    for (const fs::path& file : files[g.group])
      if (!taken.contains(file))
        skipped.add_file(file, fmt::format("no file in --{} belongs to it", groups[lead].flag));
}

// The frames, their paths by FrameGroup whatever group leads.
Result<std::vector<FrameFiles>> frames_of(const SonarJob& job, FrameList& skipped) {
  const FrameGroup lead = job.flags.method == "image" ? kPictureGroup : kDepthGroup;
  std::vector<std::vector<fs::path>> files(kGroups);
  for (const Group& g : groups_of(job.flags)) {
    if (g.pattern.empty()) continue;
    if (!sonar::names_many(g.pattern))
      return refusal(fmt::format("--{}", g.flag), fmt::format("the file {}", g.pattern),
                     "a folder or a pattern, as the other flags have");
    std::span<const char* const> kinds = kMaps;
    if (g.group == kPictureGroup) kinds = kPictures;
    std::vector<sonar::UnusableFile> unusable;
    NERITIC_TRY(files[g.group], sonar::list_files(g.pattern, kinds, unusable));
    for (const sonar::UnusableFile& file : unusable) skipped.add_file(file.path, file.reason);
  }
  std::swap(files[0], files[lead]);
  NERITIC_TRY(std::vector<FrameFiles> frames, sonar::pair_frames(files));
  for (FrameFiles& frame : frames) std::swap(frame.paths[0], frame.paths[lead]);
  std::swap(files[0], files[lead]);
  list_unpaired(job, files, frames, lead, skipped);
  return frames;
}

// The first group that is asked for and of which the frame has no file.
Status complete(const SonarJob& job, const FrameFiles& frame) {
  for (const Group& g : groups_of(job.flags))
    if (!g.pattern.empty() && frame.paths[g.group].empty())
      return refusal(
          "", fmt::format("no file for frame '{}' in --{} {}", frame.name, g.flag, g.pattern),
          "a file for each frame");
  return {};
}

// How one kind of frame is made.
template <class LoadedT, class HeardT>
struct Maker {
  using Loaded = LoadedT;
  using Heard = HeardT;
  std::function<Result<Loaded>(const FrameFiles&)> load;  // any thread
  std::function<Result<Heard>(Loaded)> hear;              // the calling thread
  std::function<Status(const fs::path&, Heard)> write;    // any thread
};

// Each frame takes and returns tens of megabytes. By default glibc gives such blocks back to the
// system and asks for them anew, page by page: a quarter of the whole run's time at 640 x 480.
void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

struct FolderRun {
  const SonarJob& job;
  const std::vector<FrameFiles>& frames;
  const std::vector<std::size_t>& todo;
  FrameList &skipped, &silent;
  std::size_t workers;
  const Interrupt& interrupt;
  std::atomic<std::size_t>& written;
};

// A fault in one frame's files leaves the frame out and deletes its results of an earlier run; any
// other fault ends the run.
template <class T>
Result<std::optional<T>> or_skip(const FolderRun& run, std::size_t frame, Result<T> made) {
  if (made.ok()) return std::optional<T>(std::move(*made));
  if (made.error().code != ErrorCode::kBadInput) return made.error();
  run.skipped.add(frame, made.error().message);
  NERITIC_TRY_STATUS(drop_result(run.job.flags.out, run.frames[frame].name));
  return std::optional<T>();
}

template <class M>
Status run_frames(const FolderRun& run, SonarNotes& notes, const M& maker) {
  using Heard = typename M::Heard;
  using Frames = Pipeline<typename M::Loaded, std::optional<Heard>>;
  Progress progress("frame", run.todo.size());
  typename Frames::Steps steps;
  steps.read = [&](std::size_t i) -> Result<std::optional<typename M::Loaded>> {
    const FrameFiles& frame = run.frames[run.todo[i]];
    if (const Status all = complete(run.job, frame); !all.ok())
      return or_skip(run, run.todo[i], Result<typename M::Loaded>(all.error()));
    const nlohmann::json stamps = file_stamps(frame);  // before they are read
    Result<typename M::Loaded> loaded = maker.load(frame);
    if (loaded.ok()) loaded->facts["files"] = stamps;
    return or_skip(run, run.todo[i], std::move(loaded));
  };
  steps.process = [&](std::size_t i, typename M::Loaded loaded) {
    return or_skip(run, run.todo[i], maker.hear(std::move(loaded)));
  };
  steps.write = [&](std::size_t i, std::optional<Heard> heard) -> Status {
    if (!heard) return {};
    const FrameFiles& frame = run.frames[run.todo[i]];
    heard->facts["settings"] = run.job.settings;
    const std::string silence = heard->facts.value("silent", "");
    NERITIC_TRY_STATUS(write_whole(run.job.flags.out, frame.name, [&](const fs::path& folder) {
      return maker.write(folder, std::move(*heard));
    }));
    ++run.written;
    if (!silence.empty()) run.silent.add(run.todo[i], silence);
    notes.release();  // not before: a run that makes nothing says why and no more
    return {};
  };
  steps.finished = [&] { progress.step(); };
  steps.stopped = [&] { return run.interrupt.requested(); };
  return Frames({run.todo.size(), run.workers, run.workers + 2}, std::move(steps)).run();
}

Status run_kind(const FolderRun& run) {
  const SonarJob& job = run.job;
  SonarNotes notes;
  if (job.flags.method == "image")
    return run_frames(run, notes,
                      Maker<PictureLine, PictureLine>{
                          [&](const FrameFiles& f) { return load_picture_line(job, f, notes); },
                          [](PictureLine line) -> Result<PictureLine> { return line; },
                          [&](const fs::path& folder, PictureLine line) {
                            return write_picture_line(job, folder, std::move(line));
                          }});
  const std::unique_ptr<sonar::PolarPanel> panel = panel_of(job);
  const auto write = [&](const fs::path& folder, HeardFrame frame) {
    return write_heard_frame(job, folder, std::move(frame), panel.get());
  };
  if (job.flags.method == "reference")
    return run_frames(run, notes,
                      Maker<HeardFrame, HeardFrame>{
                          [&](const FrameFiles& f) -> Result<HeardFrame> {
                            NERITIC_TRY(LoadedFrame frame, load_frame(job, f, notes));
                            return hear_by_reference(job, std::move(frame));
                          },
                          [](HeardFrame frame) -> Result<HeardFrame> { return frame; }, write});
  NERITIC_TRY(const std::unique_ptr<SonarEar> ear, SonarEar::create(job));
  NERITIC_TRY_STATUS(run_frames(
      run, notes,
      Maker<LoadedFrame, HeardFrame>{[&](const FrameFiles& f) { return load_frame(job, f, notes); },
                                     [&](LoadedFrame frame) { return ear->hear(std::move(frame)); },
                                     write}));
  return check_validation(ear->device());
}

// The files in the first finished frame's folder: all frames have the same.
std::string files_of_a_result(const FolderRun& run) {
  for (const FrameFiles& frame : run.frames)
    if (const auto names = result_files(run.job.flags.out / frame.name); !names.empty())
      return fmt::format("{}", fmt::join(names, ", "));
  return "";
}

// How it went, in one line and in OUT/run.json.
Result<std::string> report(const FolderRun& run, double seconds) {
  const std::size_t skipped = run.skipped.size(), made = run.written;
  const std::size_t there = run.frames.size() - run.todo.size();
  const double per_s = static_cast<double>(made) / std::max(seconds, 1e-9);
  const std::string out = run.job.flags.out.string();
  const nlohmann::json json{{"frames", run.frames.size()}, {"made", made},
                            {"already_there", there},      {"skipped", skipped},
                            {"silent", run.silent.size()}, {"seconds", seconds},
                            {"frames_per_s", per_s},       {"workers", run.workers},
                            {"settings", run.job.settings}};
  NERITIC_TRY_STATUS(write_json(run.job.flags.out / "run.json", json));
  const std::string rate =
      made > 0 ? fmt::format(" in {:.1f} s, {:.1f} frames/s", seconds, per_s) : "";
  std::string line = fmt::format("{}: {} frames{}", out, made, rate);
  if (there > 0) line += fmt::format("; {} were there already", there);
  if (const auto silent = run.silent.size(); silent > 0)
    line += fmt::format("; {} of them silent, see {}/silent.csv", silent, out);
  if (skipped > 0) line += fmt::format("; {} skipped, see {}/skipped.csv", skipped, out);
  if (const auto files = run.skipped.files(); files > 0)
    line += fmt::format("; {} files are no frame's, see {}/skipped.csv", files, out);
  if (const auto files = files_of_a_result(run); !files.empty())
    line += fmt::format("; in each folder {}", files);
  return line;
}

Error stopped_folder(const FolderRun& run) {
  const std::size_t there = run.frames.size() - run.todo.size() + run.written;
  return {ErrorCode::kInterrupted,
          fmt::format("interrupted: {} of {} frames are whole in {}, {} of them by this run; the "
                      "same command goes on from there",
                      there, run.frames.size(), run.job.flags.out.string(), run.written.load())};
}

}  // namespace

bool is_folder_job(const SonarJob& job) {
  const auto groups = groups_of(job.flags);
  return std::any_of(groups.begin(), groups.end(), [](const Group& g) {
    return !g.pattern.empty() && sonar::names_many(g.pattern);
  });
}

Result<std::string> run_folder(const SonarJob& job) {
  FrameList skipped, silent;
  NERITIC_TRY(const std::vector<FrameFiles> frames, frames_of(job, skipped));
  NERITIC_TRY(const std::vector<std::size_t> todo, frames_to_do(job, frames, silent));
  NERITIC_TRY_STATUS(make_folder(job.flags.out));
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  const Interrupt interrupt;
  std::atomic<std::size_t> written = 0;
  const FolderRun run{job,       frames, todo,
                      skipped,   silent, job.flags.workers > 0 ? job.flags.workers : cores,
                      interrupt, written};
  const TimeNs start = now_ns();
  keep_memory();
  if (!todo.empty()) NERITIC_TRY_STATUS(run_kind(run));
  const double seconds = to_ms(now_ns() - start) / 1000.0;
  const FrameGroup lead = job.flags.method == "image" ? kPictureGroup : kDepthGroup;
  NERITIC_TRY_STATUS(skipped.write(job.flags.out / "skipped.csv", frames, lead));
  NERITIC_TRY_STATUS(silent.write(job.flags.out / "silent.csv", frames, lead));
  if (written + skipped.size() < todo.size()) return stopped_folder(run);
  if (skipped.size() == frames.size())
    return bad_input("none of {} frames could be made; the first: {}", frames.size(),
                     skipped.first());
  if (job.flags.method == "image") NERITIC_TRY_STATUS(write_waterfall(job, frames));
  return report(run, seconds);
}

}  // namespace neritic::tools
