#include "tools/neritic/sonar_resume.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "sonar/write_sonar.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sonar::FrameFiles;

constexpr const char* kFacts = "sonar.json";

// Whether a file of that name may be part of a result.
bool is_result_file(const std::string& name) {
  return std::ranges::find(sonar::kSonarFiles, name) != std::end(sonar::kSonarFiles);
}

json facts_in(const fs::path& folder) {
  const auto text = read_text(folder / kFacts);
  if (!text.ok()) return nullptr;
  const auto facts = parse_json(*text);
  return facts.ok() ? *facts : json(nullptr);
}

bool is_result(const json& facts) {
  return facts.is_object() && facts.contains("settings") && facts["settings"].is_object();
}

// The facts of a whole result of an earlier run over a folder, each of its files there and as large
// as it was written; null where there is none.
json earlier_result(const fs::path& folder) {
  json facts = facts_in(folder);
  const bool whole = is_result(facts) && facts.contains("bytes") && facts["bytes"].is_object() &&
                     facts["bytes"] == sonar::sonar_file_sizes(folder);
  return whole ? facts : json(nullptr);
}

// Whether the folder holds nothing, a result, or what is left of one: facts that cannot be read,
// and files of a result's names alone.
bool may_replace(const fs::path& folder) {
  const json facts = facts_in(folder);
  if (!facts.is_null()) return is_result(facts);
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (!is_result_file(at->path().filename().string())) return false;
  }
  return true;
}

Status check_replaceable(const fs::path& folder) {
  if (may_replace(folder)) return {};
  return refusal(folder.string(), "files that are no results of neritic sonar", "another --out");
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
  return refusal(
      path.string(),
      fmt::format("results with {} {} instead of {}", key, in(found, key), in(asked, key)),
      "another --out, or --overwrite");
}

json stamp_of(const fs::path& path) {
  if (path.empty()) return nullptr;
  std::error_code error;
  fs::path whole = fs::canonical(path, error);
  if (error) whole = fs::absolute(path, error);
  const auto bytes = fs::file_size(path, error);
  const auto changed = std::chrono::file_clock::to_sys(fs::last_write_time(path, error));
  // As text: however a file writes numbers, these come back as they are.
  return {{"path", whole.string()},
          {"bytes", fmt::format("{}", bytes)},
          {"changed_unix_ns", fmt::format("{}", changed.time_since_epoch().count())}};
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

json file_stamps(const FrameFiles& frame) {
  json stamps = json::array();
  for (const fs::path& path : frame.paths) stamps.push_back(stamp_of(path));
  return stamps;
}

Result<std::vector<std::size_t>> frames_to_do(const SonarJob& job,
                                              const std::vector<FrameFiles>& frames,
                                              FrameList& silent) {
  std::vector<std::size_t> todo;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fs::path folder = job.flags.out / frames[i].name;
    NERITIC_TRY_STATUS(check_replaceable(folder));
    const json facts = job.flags.overwrite ? json(nullptr) : earlier_result(folder);
    if (!facts.is_null())
      NERITIC_TRY_STATUS(same_settings(facts["settings"], job.settings, folder / kFacts));
    const bool made = !facts.is_null() && facts.value("files", json()) == file_stamps(frames[i]);
    if (!made)
      todo.push_back(i);
    else if (const auto why = facts.find("silent"); why != facts.end() && why->is_string())
      silent.add(i, *why);
  }
  return todo;
}

Status write_whole(const fs::path& out, const std::string& name,
                   const std::function<Status(const fs::path&)>& write) {
  const fs::path folder = out / name, partial = out / ("." + name + ".partial");
  NERITIC_TRY_STATUS(check_replaceable(folder));
  std::error_code error;
  fs::remove_all(partial, error);  // of a run that was stopped
  NERITIC_TRY_STATUS(write(partial));
  fs::remove_all(folder, error);
  fs::rename(partial, folder, error);
  if (error)
    return failure(ErrorCode::kIo, "{}: cannot be written: {}", folder.string(), error.message());
  return {};
}

Status drop_result(const fs::path& out, const std::string& name) {
  const fs::path folder = out / name;
  if (!may_replace(folder)) return {};
  std::error_code error;
  fs::remove_all(folder, error);
  if (error)
    return failure(ErrorCode::kIo, "{}: cannot be removed: {}", folder.string(), error.message());
  return {};
}

std::vector<std::string> result_files(const fs::path& folder) {
  std::vector<std::string> all(std::begin(sonar::kSonarFiles), std::end(sonar::kSonarFiles));
  std::rotate(all.begin(), all.begin() + 1, all.end());  // the .json, which is written last, last
  std::vector<std::string> out;
  std::error_code error;
  for (const std::string& name : all)
    if (fs::exists(folder / name, error)) out.push_back(name);
  return out;
}

void FrameList::add(std::size_t frame, std::string reason) {
  const std::lock_guard lock(mutex_);
  reasons_.emplace(frame, std::move(reason));
}

void FrameList::add_file(const fs::path& path, std::string reason) {
  const std::lock_guard lock(mutex_);
  files_.emplace_back(path, std::move(reason));
}

std::size_t FrameList::size() const {
  const std::lock_guard lock(mutex_);
  return reasons_.size();
}

std::size_t FrameList::files() const {
  const std::lock_guard lock(mutex_);
  return files_.size();
}

std::string FrameList::first() const {
  const std::lock_guard lock(mutex_);
  NERITIC_CHECK(!reasons_.empty(), "no frame is in the list");
  return reasons_.begin()->second;
}

Status FrameList::write(const fs::path& path, const std::vector<FrameFiles>& frames,
                        FrameGroup lead) const {
  const std::lock_guard lock(mutex_);
  if (reasons_.empty() && files_.empty()) {
    std::error_code error;
    fs::remove(path, error);
    return {};
  }
  std::string text = "file,reason\n";
  for (const auto& [frame, reason] : reasons_)
    text += quoted(frames[frame].paths[lead].string()) + "," + quoted(reason) + "\n";
  for (const auto& [file, reason] : files_)
    text += quoted(file.string()) + "," + quoted(reason) + "\n";
  return write_text(path, text);
}

}  // namespace neritic::tools
