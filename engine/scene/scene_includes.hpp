// A scene file with its includes merged into one tree. Any thread; reads files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/core/toml.hpp"

namespace neritic::scene {

// Limits: a chain of includes, includes in all, bytes of one file.
inline constexpr int kMaxIncludeDepth = 8;
inline constexpr int kMaxIncludes = 1000;
inline constexpr std::uintmax_t kMaxSceneBytes = std::uintmax_t{4} << 20;

struct SceneSource {
  TomlValue root;
  std::vector<std::string> files;  // as TomlWhere::file counts; 0 is the scene's own

  std::string place(const TomlWhere& where) const {
    return files[static_cast<std::size_t>(where.file)] + ":" + std::to_string(where.line);
  }
  // A path written in a file is relative to that file.
  std::filesystem::path resolve(const TomlWhere& where, const std::string& written) const;
};

// Merging: the included table is the base; keys of the including table win; tables merge key by
// key; arrays of tables are joined, entries of the same name merged.
// text: stands for the file's. added: files that are merged over it.
Result<SceneSource> read_scene_source(const std::filesystem::path& path,
                                      const std::optional<std::string>& text = {},
                                      const std::vector<std::filesystem::path>& added = {});

}  // namespace neritic::scene
