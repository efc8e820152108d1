// Flags that several subcommands share, and the checks of their values. Any thread.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/refusal.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

using Run = std::function<Result<std::string>()>;

// For commands that print their own results.
Result<std::string> nothing_to_say(const Status& status);

// The checks return an empty text, or what was found and what is accepted.

// An empty name would be the working folder, by chance.
std::string named(const std::string& folder);

// Pictures are written in this form whatever the name says.
std::string png_file(const std::string& file);

// The parser takes the largest number for any that is larger.
std::string seed_number(const std::string& text);

// Numbers from least to most, in the words of every other refusal.
template <class T>
CLI::Validator between(T least, T most) {
  const auto check = [=](const std::string& text) -> std::string {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good =
        error == std::errc() && end == text.data() + text.size() && value >= least && value <= most;
    return good ? ""
                : found_accepted(fmt::format("'{}'", text), fmt::format("{} to {}", least, most));
  };
  return CLI::Validator(check, fmt::format("in [{} - {}]", least, most));
}

void add_quality(CLI::App& command, std::string& quality);

// The flags that say what is shown of a recorded dive.
void add_replay(CLI::App& command, std::string& replay, std::string& shown,
                std::vector<std::string>& added);

}  // namespace neritic::tools
