// A dive in a window of a virtual X server, driven by keys (press_keys.py).
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/support.hpp"

namespace neritic::test {

struct WindowRun {
  int status = -1;  // of the dive; 99: a step did not come
  std::string out, err;
};

inline bool can_drive_windows() {
  return std::system("command -v xvfb-run > /dev/null && command -v python3 > /dev/null") == 0;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Runs `neritic dive ARGUMENTS --display window` in the folder; the steps are press_keys.py's.
// server: more arguments of the X server.
inline WindowRun drive_window(const std::filesystem::path& folder, const std::string& arguments,
                              const std::vector<std::string>& steps,
                              const std::string& server = "") {
  const std::filesystem::path script = folder / "run.sh";
  std::string quoted;
  for (const std::string& step : steps) quoted += " '" + step + "'";
  std::ofstream(script) << fmt::format(
      "cd '{}'\nXDG_STATE_HOME=$PWD/state_home '{}/tools/neritic' dive {} --display window > out "
      "2> "
      "err &\nexport DIVE=$!\n"
      "python3 '{}/tests/testbed/view/press_keys.py' Neritic{} 2> driver || {{ kill $DIVE; cat "
      "driver >> err; exit 99; }}\nwait $DIVE\n",
      folder.string(), NERITIC_BINARY_DIR, arguments, source_dir().string(), quoted);
  const int status = std::system(
      fmt::format("xvfb-run -a -s '-screen 0 1920x1080x24 {}' bash '{}'", server, script.string())
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder / "out"),
          text_of(folder / "err")};
}

}  // namespace neritic::test
