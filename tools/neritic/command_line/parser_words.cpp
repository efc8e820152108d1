#include "tools/neritic/command_line/parser_words.hpp"

#include <algorithm>
#include <optional>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::tools {
namespace {

using Words = std::vector<std::string>;

// The parts of said at each {} of pattern, or nothing. The last {} takes the longest text.
std::optional<Words> parts_of(std::string_view said, std::string_view pattern) {
  Words parts;
  const auto next_hole = [&] { return std::min(pattern.find("{}"), pattern.size()); };
  std::size_t hole = next_hole();
  if (!said.starts_with(pattern.substr(0, hole))) return {};
  said.remove_prefix(hole);
  while (hole < pattern.size()) {
    pattern.remove_prefix(hole + 2);
    hole = next_hole();
    const std::string_view after = pattern.substr(0, hole);
    const bool last = hole == pattern.size();
    if (last && !said.ends_with(after)) return {};
    const std::size_t end = last ? said.size() - after.size() : said.find(after);
    if (end == said.npos) return {};
    parts.emplace_back(said.substr(0, end));
    said.remove_prefix(end + after.size());
  }
  return said.empty() ? std::optional(parts) : std::nullopt;
}

// "a,b,c" as "a, b, c".
std::string spaced(const std::string& list) {
  std::string out;
  for (const char c : list) out += c == ',' ? std::string(", ") : std::string(1, c);
  return out;
}

std::string quoted(const std::string& word) {
  return fmt::format("'{}'", printable(word));
}

// The names of a command's words that are no flags: "SCENE", "NAME".
std::string words_of(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) names += (names.empty() ? "" : ", ") + option->get_name();
  return names;
}

std::string subcommands_of(const CLI::App& command) {
  std::string names;
  for (const CLI::App* one : command.get_subcommands(nullptr))
    names += (names.empty() ? "" : ", ") + one->get_name();
  return names;
}

// A word or a flag that the command does not have.
std::string of_extras(const CLI::App& app, const CLI::App& command, const Words& arguments,
                      const std::string& extras) {
  Words names;
  for (const CLI::App* of : {&command, &app})
    for (const CLI::Option* option : of->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || name == "--" || std::ranges::find(names, name) != names.end())
      continue;
    const std::vector<std::string_view> known(names.begin(), names.end());
    return refusal(printable(name), "no such flag",
                   fmt::format("the flags of --help (nearest: {})", nearest(name, known)))
        .message;
  }
  const std::string words = words_of(command);
  return refusal(command.get_name(), quoted(extras) + " besides",
                 words.empty() ? "flags alone" : fmt::format("{} and flags", words))
      .message;
}

}  // namespace

std::string parser_words(const CLI::App& app, const CLI::App& command, const Words& arguments,
                         const CLI::ParseError& error) {
  const std::string said = error.what();
  const auto said_so = [&](std::string_view pattern) { return parts_of(said, pattern); };
  const auto line = [](const std::string& where, const std::string& found,
                       const std::string& accepted) {
    return refusal(where, found, accepted).message;
  };
  const auto wants = [&](const std::string& name) {
    const CLI::Option* option = command.get_option_no_throw(name);
    if (!option) option = app.get_option_no_throw(name);
    return option && !option->get_description().empty() ? option->get_description()
                                                        : std::string("what --help says");
  };
  // The checks of this program have the form; those of the parser's lists and limits do not.
  if (said.find("found ") != said.npos && said.find("; accepted: ") != said.npos) return said;
  for (const char* extras : {"The following argument was not expected: {}",
                             "The following arguments were not expected: {}"})
    if (const auto p = said_so(extras)) return of_extras(app, command, arguments, p->at(0));
  if (const auto p = said_so("Could not convert: {} = {}"))
    return line(p->at(0), quoted(p->at(1)), "a number: " + wants(p->at(0)));
  if (const auto p = said_so("{}: {} not in {{}}"))
    return line(p->at(0), quoted(p->at(1)), spaced(p->at(2)));
  if (const auto p = said_so("{}: At least {} required but received {}"))
    return line(p->at(0), p->at(2) + " of " + p->at(1) + " values", wants(p->at(0)));
  if (const auto p = said_so("{}: At Most {} required but received {}"))
    return line(p->at(0), p->at(2) + " values", "up to " + p->at(1) + ": " + wants(p->at(0)));
  if (const auto p = said_so("{}: {} required {} missing"))
    return line(p->at(0), "nothing", wants(p->at(0)));
  for (const char* flag : {"{}: too many inputs for a flag", "{}: Should be true/false or a number",
                           "{} was given a disallowed flag override"})
    if (const auto p = said_so(flag)) return line(p->at(0), "a value", "the flag alone");
  if (said_so("A subcommand is required")) {
    const std::string& name = command.get_name();
    return line(&command == &app ? "" : name, "no command", subcommands_of(command));
  }
  if (const auto p = said_so("Exactly 1 option from [{}] is required and {} were given"))
    return line(command.get_name(), p->at(1) + " of " + spaced(p->at(0)), "one of them");
  for (const char* none :
       {"Exactly 1 option from [{}] is required", "At least 1 option from [{}] is required"})
    if (const auto p = said_so(none))
      return line(command.get_name(), "none of " + spaced(p->at(0)), "one of them");
  if (const auto p = said_so("Requires at most 1 options be given from [{}]"))
    return line(command.get_name(), "more than one of " + spaced(p->at(0)), "one of them");
  if (const auto p = said_so("{} is required")) return line(p->at(0), "nothing", wants(p->at(0)));
  if (const auto p = said_so("{} requires {}"))
    return line(p->at(0), "no " + p->at(1) + " beside it", "both");
  if (const auto p = said_so("{} excludes {}"))
    return line(p->at(0), p->at(1) + " beside it", "one of them");
  return line(command.get_name(), "words that the parser refuses: " + said, "what --help says");
}

}  // namespace neritic::tools
