// `neritic experiment NAME`: becomes the Python module tools/experiment, which runs scenarios and
// reports them. Ctrl-C goes straight to it.
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "engine/core/refusal.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

Status run_experiment(const ExperimentFlags& flags) {
  const std::filesystem::path module = find_python_module("experiment");
  if (module.empty())
    return failure(
        ErrorCode::kIo,
        "experiment: no tools/experiment or share/neritic/experiment above the program's folder");
  std::error_code none;
  std::vector<std::string> words{"",
                                 "-B",
                                 module.string(),
                                 flags.name,
                                 "--out",
                                 flags.out,
                                 "--program",
                                 std::filesystem::read_symlink("/proc/self/exe", none).string()};
  const auto add = [&](const char* flag, const auto& value) {
    if (value) words.insert(words.end(), {flag, std::to_string(*value)});
  };
  add("--runs", flags.runs);
  add("--seed", flags.seed);
  add("--workers", flags.workers > 0 ? std::optional(flags.workers) : std::nullopt);
  for (const std::string& text : flags.set) words.push_back("--set=" + text);
  if (flags.resume) words.push_back("--resume");
  if (flags.json) words.push_back("--json");
  if (flags.quiet) words.push_back("--quiet");
  for (const char* python : kPythons) {
    words.front() = python;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execvp(python, argv.data());
  }
  return failure(ErrorCode::kIo, "experiment: no Python here: {}", std::strerror(errno));
}

}  // namespace neritic::tools
