// `neritic_bench`: names that no group has are refused, before any device is made; pictures keep
// their bits.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "engine/core/files.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

TEST(BenchmarkFilter, ANameThatNoGroupHasIsRefusedWithTheGroups) {
  const test::ScratchFolder scratch;
  for (const std::string flags : {"--filter sonar_bining", "--filter sweep",
                                  "--filter start --once", "--filter nothing/at_all"}) {
    const std::string command = NERITIC_BINARY_DIR "/tools/neritic_bench " + flags + " > " +
                                (scratch / "out").string() + " 2> " + (scratch / "err").string();
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status)) << flags;
    EXPECT_EQ(WEXITSTATUS(status), 2) << flags;
    NERITIC_ASSERT_OK(const std::string said, read_text(scratch / "err"));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_NE(said.find("accepted: sonar_binning, sonar_frame, sonar_terms, camera_frame"),
              std::string::npos)
        << said;
    NERITIC_ASSERT_OK(const std::string table, read_text(scratch / "out"));
    EXPECT_EQ(table, "") << flags;
  }
}

TEST(BenchmarkFilter, PicturesKeepTheirBitsWhateverElseIsAskedFor) {
  const test::ScratchFolder scratch;
  const std::string command =
      NERITIC_BINARY_DIR "/tools/neritic_bench --once --filter camera_frame --assets " +
      (test::source_dir() / "assets").string() + " > " + (scratch / "out").string() + " 2>&1";
  const int status = std::system(command.c_str());
  NERITIC_ASSERT_OK(const std::string said, read_text(scratch / "out"));
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(said.find("FAILED"), std::string::npos) << said;
}

}  // namespace
}  // namespace neritic
