// The output folder of a run over many frames: finds frames that are already there and belong to
// this run, makes results appear whole, and lists frames that were left out.
#pragma once

#include <functional>
#include <map>
#include <mutex>

#include "tools/neritic/sonar_frame.hpp"

namespace neritic::tools {

// The identity of a frame's images, for sonar.json: the whole path of each with links followed, its
// size and time of last change, as the files are now.
nlohmann::json file_stamps(const sonar::FrameFiles& frame);

// The numbers of the frames without a result of the same settings and the same files as they are
// now; with --overwrite of all. A result that cannot be read is none. kBadInput where a result has
// other settings, or something else lies in its place, and names one. silent: gets those of the
// others whose sonar.json says that they are.
class FrameList;
Result<std::vector<std::size_t>> frames_to_do(const SonarJob& job,
                                              const std::vector<sonar::FrameFiles>& frames,
                                              FrameList& silent);

// Runs write on a hidden folder beside OUT/name, which then takes its place. kBadInput where a
// folder of that name has other files than a result's: a user's own files are never removed.
// Any thread.
Status write_whole(const std::filesystem::path& out, const std::string& name,
                   const std::function<Status(const std::filesystem::path&)>& write);
// Removes an earlier result of that name, if there is one: of a frame that can no longer be made.
// Anything else stays. Any thread.
Status drop_result(const std::filesystem::path& out, const std::string& name);

// Names of what lies in a result's folder, arrays first; empty where none is.
std::vector<std::string> result_files(const std::filesystem::path& folder);

// Frames that were left out, or are silent, with the reasons. Any thread.
class FrameList {
 public:
  void add(std::size_t frame, std::string reason);
  // A file that is no frame's, below the frames in the list.
  void add_file(const std::filesystem::path& path, std::string reason);
  std::size_t size() const;   // of frames
  std::size_t files() const;  // of such files
  std::string first() const;  // reason of the first frame; CHECKed
  // file,reason, in order of frames; removes an older list where there is none. The file is
  // the leading group's.
  Status write(const std::filesystem::path& path, const std::vector<sonar::FrameFiles>& frames,
               FrameGroup lead) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::size_t, std::string> reasons_;
  std::vector<std::pair<std::filesystem::path, std::string>> files_;
};

}  // namespace neritic::tools
