#include "tools/common/picture.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/log.hpp"
#include "tools/common/shipped.hpp"

extern char** environ;

namespace neritic::tools {
namespace fs = std::filesystem;
namespace {

// tools/plot/__main__.py ends with this where matplotlib is missing.
constexpr int kNoMatplotlib = 3;
struct Finished {
  int status = 0;    // of the program; 127 where it could not be started
  std::string said;  // on standard output and error
};

// Runs a program with these arguments, without a shell. Nothing: the system has no room for it.
std::optional<Finished> run_program(const std::vector<std::string>& arguments) {
  constexpr std::size_t kMostSaid = 1 << 16;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int fault = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  Finished out;
  if (fault != 0) {
    ::close(ends[0]);
    if (fault == EAGAIN || fault == ENOMEM) return std::nullopt;
    return Finished{127, {}};
  }
  std::array<char, 4096> piece;
  for (;;) {
    const ssize_t size = ::read(ends[0], piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    if (out.said.size() < kMostSaid) out.said.append(piece.data(), static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  int raw = 0;
  while (::waitpid(child, &raw, 0) < 0 && errno == EINTR) {
  }
  out.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return out;
}

// The line that names the fault: Python's last one.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t before = text.rfind('\n');
  return before == text.npos ? text : text.substr(before + 1);
}

void say_not_drawn(const fs::path& picture, const fs::path& data, const std::string& why) {
  // Said at -q too: what was asked for is not there.
  log_line(LogLevel::kQuiet, fmt::format("neritic: {}: not drawn: {}; its data is in {}",
                                         picture.string(), why, data.string()));
}

}  // namespace

fs::path find_python_module(const std::string& name) {
  return find_shipped({fs::path("tools") / name / "__main__.py",
                       fs::path("share/neritic") / name / "__main__.py"})
      .parent_path();
}

fs::path picture_data_path(const fs::path& picture) {
  return fs::path(picture).replace_extension(".plot.json");
}

Result<bool> draw_picture(const fs::path& data, const fs::path& picture) {
  const fs::path module = find_python_module("plot");
  if (module.empty()) {
    say_not_drawn(picture, data, "no tools/plot or share/neritic/plot above the program's folder");
    return false;
  }
  for (const char* python : kPythons) {
    // -B: the module's folder stays as it is.
    const auto done =
        run_program({python, "-B", module.string(), data.string(), "--out", picture.string()});
    if (!done) return failure(ErrorCode::kIo, "{}: no process to draw it", picture.string());
    if (done->status == 0) return true;
    if (done->status == 127 || done->status == kNoMatplotlib) continue;
    return failure(ErrorCode::kIo, "{}: not drawn: {}", picture.string(), last_line(done->said));
  }
  say_not_drawn(picture, data,
                fmt::format("no python3 here has matplotlib; {}", kHowToGetMatplotlib));
  return false;
}

Result<bool> write_picture(const fs::path& picture, const nlohmann::json& data) {
  const fs::path path = picture_data_path(picture);
  NERITIC_TRY_STATUS(write_text(path, json_text(data, -1) + "\n"));
  return draw_picture(path, picture);
}

std::string matplotlib_here() {
  for (const char* python : kPythons) {
    const auto done =
        run_program({python, "-c", "import matplotlib; print(matplotlib.__version__)"});
    if (done && done->status == 0) return last_line(done->said) + " of " + python;
  }
  return {};
}

double six_digits(double value) {
  if (!std::isfinite(value)) return value;
  char text[32];
  const auto written = std::to_chars(text, std::end(text), value, std::chars_format::general, 6);
  double out = value;
  std::from_chars(text, written.ptr, out);
  return out;
}

}  // namespace neritic::tools
