// A TOML file of parameters (a vehicle's, a diver's), and what it includes, as a tree whose getters
// check what they read. Any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/case_file.hpp"

namespace neritic {

// `include = "other.toml"` at the top: that file's keys come first and this one's win, tables key
// by key; up to 8 files deep. folder: what paths are relative to, those of the top-level keys named
// in paths among them. Errors: file:line, what is no TOML.
Result<CaseFile> parse_case_toml(std::string_view text, const std::string& name,
                                 const std::filesystem::path& folder,
                                 std::span<const std::string_view> paths = {});

}  // namespace neritic
