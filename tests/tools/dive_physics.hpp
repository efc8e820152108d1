// `neritic dive --headless` of a scene with physics, as its users run it: without a Vulkan device.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {

// A device name that no driver has.
inline constexpr const char* kNoDevice =
    "env VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent";

class DivePhysics : public testing::Test {
 protected:
  struct Outcome {
    int status = -1;
    std::string out, err;
  };

  void SetUp() override {
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
    ASSERT_TRUE(write_text(scratch_ / "dive.toml", R"(title = "box"
[physics]
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [20, 20]
position_m = [0, -8, 0]
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.57, 0.26, 0.46]
dynamics = ")" + dynamics + R"("
position_m = [0, -6, 0]
mission = { waypoints = [ { position_m = [0, -6, -2] }, { position_m = [1, -7, -2] } ] }
)")
                    .ok());
    ASSERT_TRUE(write_text(scratch_ / "still.toml", "[[objects]]\nshape = \"box\"\n").ok());
  }

  Outcome dive(const std::string& arguments, const std::string& name = "dive.toml",
               const std::string& under = kNoDevice) {
    const int raw =
        std::system(fmt::format("{} '{}/tools/neritic' dive '{}' {} > '{}' 2> '{}'", under,
                                NERITIC_BINARY_DIR, (scratch_ / name).string(), arguments,
                                (scratch_ / "out").string(), (scratch_ / "err").string())
                        .c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, read_text(scratch_ / "out").value(),
            read_text(scratch_ / "err").value()};
  }
  // Any command, with the machine's device.
  Outcome neritic(const std::string& arguments) {
    const int raw =
        std::system(fmt::format("'{}/tools/neritic' {} > '{}' 2> '{}'", NERITIC_BINARY_DIR,
                                arguments, (scratch_ / "out").string(), (scratch_ / "err").string())
                        .c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, read_text(scratch_ / "out").value(),
            read_text(scratch_ / "err").value()};
  }
  std::string file(const std::string& name) const { return "'" + (scratch_ / name).string() + "'"; }

  // Columns by name.
  std::map<std::string, std::vector<std::string>> table(const std::string& name) const {
    std::istringstream text(read_text(scratch_ / name).value());
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> columns;
    for (std::string line; std::getline(text, line);) {
      std::istringstream cells(line);
      std::size_t column = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++column) {
        if (columns.size() < names.size() || names.size() == column)
          names.push_back(cell);
        else
          columns[names[column]].push_back(cell);
      }
      for (const std::string& known : names) columns[known];
    }
    return columns;
  }

  test::ScratchFolder scratch_;
};

}  // namespace neritic
