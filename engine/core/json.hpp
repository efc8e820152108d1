// JSON text in and out. The parser and the writer of nlohmann/json take longer to compile than most
// of our files, so they are instantiated in json.cpp alone; use these and not parse() or dump().
// Any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic {

// Deepest nesting that is read: whatever walks a document must not exhaust the stack.
inline constexpr int kMaxJsonNesting = 128;

// kBadInput says why the text is no JSON, with line and column, or that it is nested too deep.
Result<nlohmann::json> parse_json(std::string_view text);

// The number as a person would write it: what is exactly a float has the fewest digits that give
// that float again (0.1, not 0.10000000149011612), any other at most 15 digits.
double tidy_number(double value);

// The text, with indent < 0 in one line. Numbers are tidy, what is not UTF-8 is replaced, what is
// not finite becomes null.
std::string json_text(const nlohmann::json& value, int indent = 2);

// json_text and a newline as a file (files.hpp). kIo where it can't be written.
Status write_json(const std::filesystem::path& path, const nlohmann::json& value);

}  // namespace neritic
