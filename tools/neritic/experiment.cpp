// `neritic experiment NAME` and `neritic study`: become the Python module tools/experiment, which
// runs scenarios and studies and reports them. Ctrl-C goes straight to it.
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "engine/core/refusal.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

namespace {

// Becomes Python with these words after the module's path; returns only if that cannot be.
Status become(const char* what, const std::filesystem::path& module,
              std::vector<std::string> words) {
  words.insert(words.begin(), {"", "-B", module.string()});
  // Python else orders the words of a set anew at each start, and a controller that goes through
  // one would act otherwise.
  ::setenv("PYTHONHASHSEED", "0", 1);
  // A signal that comes while Python starts would end it with a traceback. It waits until the
  // module has its handlers (tools/experiment/endings.py), which lets it through.
  sigset_t late{}, before{};
  sigemptyset(&late);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&late, signal);
  sigprocmask(SIG_BLOCK, &late, &before);
  for (const char* python : kPythons) {
    words.front() = python;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execvp(python, argv.data());
  }
  const int error = errno;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  return failure(ErrorCode::kIo, "{}: no Python here: {}", what, std::strerror(error));
}

Result<std::filesystem::path> module_of(const char* what) {
  std::filesystem::path module = find_python_module("experiment");
  if (module.empty())
    return failure(ErrorCode::kIo,
                   "{}: no tools/experiment or share/neritic/experiment above the program's folder",
                   what);
  return module;
}

std::string this_program() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).string();
}

}  // namespace

Status run_experiment(const ExperimentFlags& flags) {
  NERITIC_TRY(const std::filesystem::path module, module_of("experiment"));
  std::vector<std::string> words{flags.name, "--out", flags.out, "--program", this_program()};
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
  if (flags.quick) words.push_back("--quick");
  return become("experiment", module, std::move(words));
}

Status run_study(const std::vector<std::string>& words) {
  NERITIC_TRY(const std::filesystem::path module, module_of("study"));
  std::vector<std::string> all{"--program", this_program()};
  all.insert(all.end(), words.begin(), words.end());
  return become("study", module / "study.py", std::move(all));
}

}  // namespace neritic::tools
