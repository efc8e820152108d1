// `neritic` as a process of its own, on the fake OpenXR runtime.
#pragma once

#include <sys/wait.h>

#include <fstream>
#include <sstream>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {

class HeadsetProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
  static std::string scene() {
    return (test::source_dir() / "tests/scenes/over_sand.toml").string();
  }
  std::string path(const char* name) const { return (scratch_ / name).string(); }
  // The runtime's behaviour in runs from now on; it writes its complaints to "report".
  void script(const std::string& lines) const {
    std::ofstream(scratch_ / "script") << lines << "report " << path("report") << '\n';
  }
  std::string command(const std::string& arguments, const char* said) const {
    return fmt::format(
        "XR_RUNTIME_JSON='{}' NERITIC_FAKE_XR='{}' '{}/tools/neritic' {} > '{}' 2>&1",
        fake_.manifest(), path("script"), NERITIC_BINARY_DIR, arguments, path(said));
  }
  // The exit status.
  int run(const std::string& arguments, const char* said = "said") const {
    const int status = std::system(command(arguments, said).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text(const char* name) const {
    std::ifstream file(scratch_ / name);
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
  }
  std::string said() const { return text("said"); }

  test::ScratchFolder scratch_;
  fakes::FakeHeadset fake_;  // for its manifest
};

}  // namespace neritic::testbed
