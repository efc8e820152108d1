#include "tools/neritic/command_line/shared_flags.hpp"

#include "engine/core/text.hpp"

namespace neritic::tools {

Result<std::string> nothing_to_say(const Status& status) {
  if (!status.ok()) return status.error();
  return std::string();
}

std::string named(const std::string& folder) {
  return folder.empty() ? found_accepted("''", "a folder's name") : "";
}

std::string png_file(const std::string& file) {
  const std::string kind = lower_case(std::filesystem::path(file).extension().string());
  return kind == ".png" ? "" : found_accepted(fmt::format("'{}'", file), "a .png");
}

std::string seed_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? ""
               : found_accepted(fmt::format("'{}'", text),
                                "a whole number from 0 to 18446744073709551615");
}

void add_quality(CLI::App& command, std::string& quality) {
  command
      .add_option(
          "--quality", quality,
          "how finely sonars are sampled: with less than 5, 2 or 1 % of error (sonar/TRADE.md)")
      ->check(CLI::IsMember({"draft", "standard", "reference"}));
}

void add_replay(CLI::App& command, std::string& replay, std::string& shown,
                std::vector<std::string>& added) {
  command.add_option("--replay", replay,
                     "repeats the motion of a recorded dive (.mcap) and compares each state's "
                     "hash; without SCENE in the recorded scene");
  command.add_option(
      "--scene", shown,
      "with --replay: shows the motion in this scene, by its objects of the same names");
  command
      .add_option("--add", added,
                  "merges a .toml over the shown scene, as if it included that: other cameras, "
                  "sonars, lights; may be repeated")
      ->expected(1)
      ->take_all();
}

}  // namespace neritic::tools
