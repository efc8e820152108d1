// The refusals of the command line's parser, each as a line of the one form
// (engine/core/refusal.hpp). Any thread.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace neritic::tools {

// "--depth: found '30ft'; accepted: a number: depth of the bottom, metres". command: the subcommand
// that was chosen, or app itself. arguments: in the order in which they were given.
std::string parser_words(const CLI::App& app, const CLI::App& command,
                         const std::vector<std::string>& arguments, const CLI::ParseError& error);

}  // namespace neritic::tools
