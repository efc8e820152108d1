#include "tools/neritic/sonar_resume.hpp"

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sonar::FrameFiles;

constexpr const char* kFacts = "sonar.json";

// The result of an earlier run over a folder; null where there is none.
json earlier_result(const fs::path& folder) {
  const auto text = read_text(folder / kFacts);
  if (!text.ok()) return nullptr;
  const auto facts = parse_json(*text);
  const bool ours = facts.ok() && facts->is_object() && facts->contains("settings") &&
                    (*facts)["settings"].is_object();
  return ours ? *facts : json(nullptr);
}

Status same_settings(const json& found, const json& asked, const fs::path& path) {
  if (found == asked) return {};
  const auto in = [](const json& all, const std::string& key) {
    return all.contains(key) ? json_text(all[key], -1) : std::string("none");
  };
  json both = found;
  both.update(asked);
  std::string key;
  for (const auto& [name, value] : both.items())
    if (in(found, name) != in(asked, name)) key = key.empty() ? name : key;
  return bad_input("{}: made with {} {}, {} is asked for; another --out or --overwrite is accepted",
                   path.string(), key, in(found, key), in(asked, key));
}

bool newer_than(const FrameFiles& frame, const fs::path& result) {
  std::error_code error;
  const auto made = fs::last_write_time(result, error);
  for (const fs::path& path : frame.paths)
    if (!path.empty() && fs::last_write_time(path, error) > made) return true;
  return false;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

json file_names(const FrameFiles& frame) {
  json names = json::array();
  for (const fs::path& path : frame.paths) names.push_back(path.filename().string());
  return names;
}

Result<std::vector<std::size_t>> frames_to_do(const SonarJob& job,
                                              const std::vector<FrameFiles>& frames) {
  std::vector<std::size_t> todo;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fs::path folder = job.flags.out / frames[i].name;
    const json facts = job.flags.overwrite ? json(nullptr) : earlier_result(folder);
    if (!facts.is_null())
      NERITIC_TRY_STATUS(same_settings(facts["settings"], job.settings, folder / kFacts));
    const bool made = !facts.is_null() && facts.value("files", json()) == file_names(frames[i]) &&
                      !newer_than(frames[i], folder / kFacts);
    if (!made) todo.push_back(i);
  }
  return todo;
}

Status write_whole(const fs::path& out, const std::string& name,
                   const std::function<Status(const fs::path&)>& write) {
  const fs::path folder = out / name, partial = out / ("." + name + ".partial");
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error) && earlier_result(folder).is_null())
    return bad_input("{}: files of something else found there, another --out is accepted",
                     folder.string());
  fs::remove_all(partial, error);  // of a run that was stopped
  NERITIC_TRY_STATUS(write(partial));
  fs::remove_all(folder, error);
  fs::rename(partial, folder, error);
  if (error)
    return failure(ErrorCode::kIo, "{}: cannot be written: {}", folder.string(), error.message());
  return {};
}

void SkippedFrames::add(std::size_t frame, std::string reason) {
  const std::lock_guard lock(mutex_);
  reasons_.emplace(frame, std::move(reason));
}

std::size_t SkippedFrames::size() const {
  const std::lock_guard lock(mutex_);
  return reasons_.size();
}

std::string SkippedFrames::first() const {
  const std::lock_guard lock(mutex_);
  NERITIC_CHECK(!reasons_.empty(), "no frame was left out");
  return reasons_.begin()->second;
}

Status SkippedFrames::write(const fs::path& path, const std::vector<FrameFiles>& frames,
                            FrameGroup lead) const {
  const std::lock_guard lock(mutex_);
  if (reasons_.empty()) {
    std::error_code error;
    fs::remove(path, error);
    return {};
  }
  std::string text = "file,reason\n";
  for (const auto& [frame, reason] : reasons_)
    text += quoted(frames[frame].paths[lead].string()) + "," + quoted(reason) + "\n";
  return write_text(path, text);
}

}  // namespace neritic::tools
