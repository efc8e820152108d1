#include "sonar/offline_frames.hpp"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::sonar {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_separator(char c) {
  return c == '/' || c == '_' || c == '-' || c == '.' || c == ' ';
}

bool ends_so(const fs::path& path, std::span<const char* const> extensions) {
  const std::string extension = lower_case(path.extension().string());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const char* e) { return extension == std::string(".") + e; });
}

// Adds a plain file to out, and what cannot be followed to unusable.
void sort_in(const fs::path& path, Paths& out, std::vector<UnusableFile>& unusable) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status))
    out.push_back(path);
  else if (status.type() == fs::file_type::not_found)
    unusable.push_back({path, "a link that leads nowhere"});
  else if (status.type() == fs::file_type::none)
    unusable.push_back({path, error.message()});
}

Result<Paths> files_in(const fs::path& folder, std::span<const char* const> extensions,
                       std::vector<UnusableFile>& unusable) {
  Paths out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (ends_so(at->path(), extensions) && at->path().filename().string().front() != '.')
      sort_in(at->path(), out, unusable);
  if (error) return bad_input("{}: cannot be listed: {}", folder.string(), error.message());
  return out;
}

Result<Paths> files_like(const std::string& pattern, std::vector<UnusableFile>& unusable) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), 0, nullptr, &found);
  Paths out;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i)
    sort_in(found.gl_pathv[i], out, unusable);
  ::globfree(&found);
  if (status != 0 && status != GLOB_NOMATCH)
    return bad_input("{}: the files it matches cannot be listed", pattern);
  return out;
}

std::string reversed(const std::string& text) {
  return {text.rbegin(), text.rend()};
}

// How many characters the stems share at their beginning, up to a place where a name may begin.
// At most limit.
std::size_t shared_beginning(std::span<const std::string> stems, std::size_t limit) {
  std::size_t length = limit;
  for (const std::string& stem : stems) {
    const auto differs =
        std::mismatch(stem.begin(), stem.begin() + std::ptrdiff_t(length), stems[0].begin());
    length = static_cast<std::size_t>(differs.first - stem.begin());
  }
  const auto may_end = [&](std::size_t at) {
    const char before = stems[0][at - 1];
    if (is_separator(before)) return true;
    return !is_digit(before) && std::all_of(stems.begin(), stems.end(), [&](const auto& stem) {
      return at < stem.size() && is_digit(stem[at]);
    });
  };
  while (length > 0 && !may_end(length)) --length;
  return length;
}

std::string longest_number(const std::string& stem) {
  std::string longest, here;
  for (const char c : stem) {
    here = is_digit(c) ? here + c : "";
    if (here.size() > longest.size()) longest = here;
  }
  return longest.empty() ? stem : longest;
}

std::vector<std::string> stems_of(std::span<const fs::path> files) {
  std::vector<std::string> stems;
  for (const fs::path& file : files) stems.push_back(file.stem().string());
  return stems;
}

bool all_differ(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end();
}

using ByName = std::map<std::string, fs::path>;
Result<ByName> by_name(const Paths& files, const std::vector<std::string>& names) {
  ByName out;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (const auto [at, added] = out.emplace(names[i], files[i]); !added)
      return refusal(fmt::format("{} and {}", at->second.string(), files[i].string()),
                     fmt::format("two files of frame '{}'", names[i]), "one");
  return out;
}

}  // namespace

bool names_many(const std::string& pattern) {
  std::error_code error;
  if (fs::is_directory(pattern, error)) return true;
  return pattern.find_first_of("*?[") != std::string::npos && !fs::exists(pattern, error);
}

Result<Paths> list_files(const std::string& pattern, std::span<const char* const> extensions,
                         std::vector<UnusableFile>& unusable) {
  std::error_code error;
  const bool folder = fs::is_directory(pattern, error);
  NERITIC_TRY(Paths files,
              folder ? files_in(pattern, extensions, unusable) : files_like(pattern, unusable));
  std::sort(files.begin(), files.end());
  std::ranges::sort(unusable, {}, &UnusableFile::path);
  if (!files.empty()) return files;
  if (!folder)
    return refusal(pattern, "no such file", "a file, a folder or a pattern that files match");
  std::string kinds;
  for (const char* e : extensions) kinds += std::string(kinds.empty() ? "." : ", .") + e;
  return refusal(pattern, "no image in that folder", kinds);
}

std::vector<std::string> frame_names(std::span<const fs::path> files) {
  if (files.size() == 1) return {longest_number(files[0].stem().string())};
  std::vector<std::string> paths, backwards;
  for (const fs::path& file : files) {
    paths.push_back((file.parent_path() / file.stem()).generic_string());
    backwards.push_back(reversed(paths.back()));
  }
  if (files.empty()) return paths;
  const auto shorter = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  const std::size_t shortest = std::min_element(paths.begin(), paths.end(), shorter)->size();
  const std::size_t before = shared_beginning(paths, shortest);
  const std::size_t after = shared_beginning(backwards, shortest - before);
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    names.push_back(path.substr(before, path.size() - before - after));
    std::replace(names.back().begin(), names.back().end(), '/', '_');
  }
  // "depth" and "depth_1", or a name that hides a folder.
  const bool whole = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name.empty() || name.front() == '.';
  });
  return whole ? stems_of(files) : names;
}

Result<std::vector<FrameFiles>> pair_frames(std::span<const Paths> files) {
  const Paths& lead = files[0];
  const std::vector<std::string> names = frame_names(lead), stems = stems_of(lead);
  NERITIC_TRY([[maybe_unused]] const ByName unique, by_name(lead, names));
  std::vector<FrameFiles> frames(lead.size());
  for (std::size_t i = 0; i < lead.size(); ++i) frames[i] = {names[i], Paths(files.size())};
  for (std::size_t g = 0; g < files.size(); ++g) {
    const std::vector<std::string> own_stems = stems_of(files[g]);
    const bool by_stem = all_differ(stems) && all_differ(own_stems) &&
                         std::find_first_of(stems.begin(), stems.end(), own_stems.begin(),
                                            own_stems.end()) != stems.end();
    NERITIC_TRY(const ByName from, by_name(files[g], by_stem ? own_stems : frame_names(files[g])));
    for (std::size_t i = 0; i < lead.size(); ++i) {
      const auto at = from.find(by_stem ? stems[i] : names[i]);
      if (at != from.end()) frames[i].paths[g] = at->second;
    }
  }
  return frames;
}

}  // namespace neritic::sonar
