// A client in a process of its own: the script comes by a file, the faults go to one.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>

#include "tests/fakes/client.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

// Runs one disabled test of this program in a process of its own; its exit status.
int run_apart(const std::string& test, const std::string& manifest, const std::string& script) {
  const pid_t child = fork();
  if (child == 0) {
    setenv("XR_RUNTIME_JSON", manifest.c_str(), 1);
    setenv("NERITIC_FAKE_XR", script.c_str(), 1);
    const std::string filter = "--gtest_filter=" + test;
    execl("/proc/self/exe", "test_fakes", filter.c_str(), "--gtest_also_run_disabled_tests",
          "--gtest_brief=1", nullptr);
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The client: one frame on the wall's clock, then a wrong call.
TEST(AnotherProcess, DISABLED_Client) {
  Client client;
  client.start();
  const auto before = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) client.frame();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
  EXPECT_GE(took.count(), 0.055) << "xrWaitFrame did not wait";
  EXPECT_LT(xrBeginFrame(client.session, nullptr), 0);
}

TEST(AnotherProcess, GetsItsScriptAndReportsItsFaultsByFiles) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  test::ScratchFolder folder;
  const FakeHeadset headset;  // for its manifest
  std::ofstream(folder / "script")
      << "size 16 16\nperiod 0.02\nreal_time yes\nreport " << (folder / "report").string() << '\n';
  EXPECT_EQ(
      run_apart("AnotherProcess.DISABLED_Client", headset.manifest(), (folder / "script").string()),
      0);
  std::ifstream report(folder / "report");
  const std::string faults{std::istreambuf_iterator<char>(report), {}};
  EXPECT_EQ(faults, "xrBeginFrame: no xrWaitFrame came before it for this frame.\n");
}

}  // namespace
}  // namespace neritic::fakes
