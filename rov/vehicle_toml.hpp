// A vehicle's TOML file, and what it includes, as a tree whose getters check what they read. Any
// thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/case_file.hpp"

namespace neritic::rov {

// `include = "other.toml"` at the top: that file's keys come first and this one's win, tables key
// by key; up to 8 files deep. folder: what paths are relative to. Errors: file:line, what is no
// TOML.
Result<CaseFile> parse_vehicle_toml(std::string_view text, const std::string& name,
                                    const std::filesystem::path& folder);

}  // namespace neritic::rov
