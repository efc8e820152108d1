// A recording survives what ends its program or its disk: it reads up to its last second, and the
// dive goes on without it. NERITIC_KILLS=200 kills that often (default 4).
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "engine/core/random.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// The time at which a recording says that it began.
class Begun final : public recording::McapVisitor {
 public:
  Status metadata(const recording::McapMetadata& metadata) override {
    const auto at = metadata.words.find("recorded_at_ns");
    if (at != metadata.words.end()) at_ns = std::stoll(at->second);
    return {};
  }
  std::int64_t at_ns = 0;
};

TEST_F(DivePhysics, AKilledRunLeavesARecordingUpToItsLastSecond) {
  const char* asked = std::getenv("NERITIC_KILLS");
  const int kills = asked ? std::atoi(asked) : 4;
  const auto part = scratch_ / "a.mcap.part";
  std::vector<double> lost_s;
  int read = 0;
  for (int i = 0; i < kills; ++i) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    const pid_t program = ::fork();
    if (program == 0) {
      std::freopen("/dev/null", "w", stdout);
      std::freopen("/dev/null", "w", stderr);
      ::execl(fmt::format("{}/tools/neritic", NERITIC_BINARY_DIR).c_str(), "neritic", "dive",
              (scratch_ / "dive.toml").c_str(), "--headless", "--realtime", "--seconds", "600",
              "--record", (scratch_ / "a.mcap").c_str(), nullptr);
      ::_exit(127);
    }
    const double wait_s = 0.05 + 2.0 * std::fmod(0.618034 * (i + 1), 1.0);
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    ::kill(program, SIGKILL);
    const std::int64_t killed_ns = wall_ns();
    int raw = 0;
    ASSERT_EQ(::waitpid(program, &raw, 0), program);
    ASSERT_TRUE(WIFSIGNALED(raw)) << raw;
    if (!std::filesystem::exists(part)) continue;  // before its first half second
    const auto source = recording::open_mcap(part);
    ASSERT_TRUE(source.ok()) << source.error().message;
    Begun begun;
    const auto report = recording::read_mcap(**source, "a.mcap.part", begun);
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_EQ(report->damages, 0u);
    const double ran_s = static_cast<double>(killed_ns - begun.at_ns) * 1e-9;
    const auto log = testbed::read_sample_log(part);
    // A file may end before its first chunk, within the first second.
    const double kept_s = log.ok() ? static_cast<double>(log->steps()) * log->step_s : 0.0;
    lost_s.push_back(ran_s - kept_s);
    if (!log.ok()) continue;
    ++read;
    EXPECT_FALSE(log->whole);
  }
  EXPECT_GE(read, kills / 4);
  ASSERT_FALSE(lost_s.empty());
  std::ranges::sort(lost_s);
  // With its start. Other work of the machine may hold up a third of the runs.
  const double lost_of_most_s = lost_s[(lost_s.size() - 1) * 2 / 3];
  EXPECT_LT(lost_of_most_s, 1.2);
  fmt::print("{} kills, {} with steps; at most {:.3f} s lost\n", kills, read, lost_s.back());
  ASSERT_TRUE(std::filesystem::exists(part));
  const Outcome replay = dive("--headless --replay " + file("a.mcap.part"));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.err.find("its run was cut off"), std::string::npos) << replay.err;
}

// A limit of the file's size stands for a full disk.
TEST_F(DivePhysics, AFullDiskEndsTheRecordingInOneLineAndTheDiveGoesOn) {
  const std::string limited = std::string(kNoDevice) +
                              " bash -c 'trap \"\" XFSZ; ulimit -f 16; "
                              "exec \"$@\"' bash";
  const Outcome outcome = dive("--headless --realtime --seconds 2.5 --record " + file("full.mcap"),
                               "dive.toml", limited);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("the run goes on without a recording"), std::string::npos)
      << outcome.err;
  // Its summary is that of the whole dive.
  EXPECT_NE(outcome.out.find("2.5 s in 600 steps"), std::string::npos) << outcome.out;
  const auto log = testbed::read_sample_log(scratch_ / "full.mcap.part");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_FALSE(log->whole);
}

TEST_F(DivePhysics, AFullDiskEndsTheLogInOneLineAndTheDiveGoesOn) {
  const std::string limited = std::string(kNoDevice) +
                              " bash -c 'trap \"\" XFSZ; ulimit -f 16; "
                              "exec \"$@\"' bash";
  for (const char* pace : {"--realtime ", ""}) {
    const Outcome outcome =
        dive(std::string("--headless --seconds 2.5 ") + pace + "--log " + file("full.csv"),
             "dive.toml", limited);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("cannot be written whole (disk full?)"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.out.find("2.5 s in 600 steps"), std::string::npos) << outcome.out;
    // The rows that fit, and none of those that do not.
    const std::string part = read_text(scratch_ / "full.csv.part").value();
    EXPECT_GT(part.size(), 15'000u);
    EXPECT_EQ(part.back(), '\n');
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "full.csv"));
  }
}

}  // namespace
}  // namespace neritic
