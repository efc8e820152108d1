// Dives that a signal ends: what was flown until then is there.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <thread>

#include "engine/scene/image_file.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

// Whether the process has a handler for the signal: it is past its start then.
bool catches(pid_t process, int signal) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  return false;
}

TEST_F(DivePhysics, AReplayCanBeInterrupted) {
  ASSERT_EQ(dive("--headless --seconds 60 --record " + file("a.mcap")).status, 0);
  const pid_t program = ::fork();
  if (program == 0) {
    (void)!::nice(19);  // so that the signal comes before its end on a busy machine, too
    std::freopen((scratch_ / "out").c_str(), "w", stdout);
    std::freopen((scratch_ / "err").c_str(), "w", stderr);
    ::execl(fmt::format("{}/tools/neritic", NERITIC_BINARY_DIR).c_str(), "neritic", "dive",
            (scratch_ / "dive.toml").c_str(), "--headless", "--replay",
            (scratch_ / "a.mcap").c_str(), nullptr);
    ::_exit(127);
  }
  while (!catches(program, SIGINT)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(program, SIGINT);
  int raw = 0;
  ASSERT_EQ(::waitpid(program, &raw, 0), program);
  const std::string err = read_text(scratch_ / "err").value();
  ASSERT_TRUE(WIFEXITED(raw));
  EXPECT_EQ(WEXITSTATUS(raw), 130) << err;
  EXPECT_EQ(err.rfind("neritic: interrupted after ", 0), 0u) << err;
  EXPECT_NE(err.find(" s of 60\n"), std::string::npos) << err;
}

// Ctrl-C, what `kill` sends, and a terminal that is closed: what was flown until then is written,
// and replays.
TEST_F(DivePhysics, InterruptedItWritesWhatItHas) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::filesystem::remove(scratch_ / "a.mcap");  // else that is kept, which a line says
    const pid_t program = ::fork();
    if (program == 0) {
      std::freopen((scratch_ / "out").c_str(), "w", stdout);
      std::freopen((scratch_ / "err").c_str(), "w", stderr);
      ::execl(fmt::format("{}/tools/neritic", NERITIC_BINARY_DIR).c_str(), "neritic", "dive",
              (scratch_ / "dive.toml").c_str(), "--headless", "--realtime", "--seconds", "600",
              "--log", (scratch_ / "a.csv").c_str(), "--record", (scratch_ / "a.mcap").c_str(),
              "--plot", (scratch_ / "a.png").c_str(), nullptr);
      ::_exit(127);
    }
    while (!catches(program, signal)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    ::kill(program, signal);
    ::kill(program, signal);  // as `timeout` does
    int raw = 0;
    ASSERT_EQ(::waitpid(program, &raw, 0), program);
    const std::string out = read_text(scratch_ / "out").value();
    const std::string err = read_text(scratch_ / "err").value();
    EXPECT_TRUE(WIFEXITED(raw));
    EXPECT_EQ(WEXITSTATUS(raw), 130) << err;
    const std::string before = "neritic: interrupted after ";
    ASSERT_EQ(err.rfind(before, 0), 0u) << err;
    EXPECT_NE(err.find(" s of 600; everything up to then is written\n"), std::string::npos) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_NE(out.find("hash "), std::string::npos) << out;
    // Every control period until then has its row.
    const double until_s = std::stod(err.substr(before.size()));
    const auto columns = table("a.csv");
    const auto& times = columns.at("time_s");
    EXPECT_NEAR(std::stod(times.back()), until_s, 0.0205);
    EXPECT_NEAR(static_cast<double>(times.size()), 1.0 + 50.0 * until_s, 1.1);
    EXPECT_TRUE(scene::read_image8(scratch_ / "a.png", 3).ok());
    EXPECT_EQ(dive("--headless --replay " + file("a.mcap")).status, 0);
  }
}

}  // namespace
}  // namespace neritic
