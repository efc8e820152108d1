// The log of a dive reaches its file while the run goes on.
#include "testbed/record/csv_log.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "testbed/record/file_sinks.hpp"
#include "tests/testbed/csv_text.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

TestDive diver_and_vehicle() {
  return dive_of(std::string(kStillWater) + diver_text("position_m = [0, -12, 0]\n") +
                 rov_text("position_m = [3, -12, 0]\n"));
}

DiveLog log_to(const PhysicsWorld& world, const fs::path& path,
               std::vector<std::string>* told = nullptr) {
  std::vector<std::unique_ptr<RowSink>> rows;
  rows.push_back(std::make_unique<CsvLog>(world, path));
  return DiveLog(world, 0.0, std::move(rows), [told](const std::string& line) {
    if (told) told->push_back(line);
  });
}

TEST(CsvLog, IsTheTableOfTheRowsOnceItIsWhole) {
  TestDive dive = diver_and_vehicle();
  const test::ScratchFolder folder;
  DiveLog log = log_to(*dive.world, folder / "log.csv");
  DiveRecorder recorder(*dive.world, {.rows = true});
  const auto add = [&] {
    recorder.add(dive.simulation->newest());
    ASSERT_TRUE(log.accept(dive.simulation->newest(), {}).ok());
  };
  add();
  dive.run(2.0, add);
  ASSERT_TRUE(log.finish().ok());
  EXPECT_EQ(read_text(folder / "log.csv").value(), csv_of(*dive.world, recorder.rows()));
  EXPECT_FALSE(fs::exists(part_of(folder / "log.csv")));
}

// Its figures and times then tell of what follows, as after --restore.
TEST(CsvLog, ARunThatGoesToASavedStateTellsOfWhatFollowsAndOfAllThatItStepped) {
  TestDive dive = diver_and_vehicle();
  DiveLog log(*dive.world, 0.0, {});
  const auto add = [&] { ASSERT_TRUE(log.accept(dive.simulation->newest(), {}).ok()); };
  add();
  dive.run(1.0, add);
  const SavedState saved = saved_state(*dive.simulation, dive.world->state_format());
  dive.run(2.0, add);
  EXPECT_EQ(log.recorder().from_s(), 0.0);
  const double before_m = log.recorder().figures()[0].path_m;
  for (int i = 0; i < 2; ++i) {  // back, and then to a later state
    restore_state(*dive.simulation, saved);
    add();
    EXPECT_NEAR(log.recorder().from_s(), 1.0, 1e-6);
    EXPECT_EQ(log.recorder().figures()[0].path_m, 0.0);
    dive.run(0.5, add);
    EXPECT_NEAR(log.recorder().stepped_s(), 3.5 + 0.5 * i, 1e-6);
    EXPECT_LT(log.recorder().figures()[0].path_m, before_m);
  }
}

// More rows than may wait, and more than a chunk: a run that is killed then leaves nearly all.
TEST(CsvLog, GrowsWhileTheRunGoesOn) {
  const TestDive dive = diver_and_vehicle();
  const test::ScratchFolder folder;
  DiveLog log = log_to(*dive.world, folder / "log.csv");
  DiveRecorder one(*dive.world, {.rows = true});
  one.add(dive.simulation->newest());
  const std::size_t a_step =
      csv_of(*dive.world, one.rows()).size() - DiveCsv(*dive.world).heading().size();
  const std::size_t steps = 4 * GrowingFile::kChunk_bytes / a_step;
  for (std::size_t i = 0; i < steps; ++i)  // the start: each has all rows
    ASSERT_TRUE(log.accept(dive.simulation->newest(), {}).ok());
  std::string part;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (part.size() < 3 * GrowingFile::kChunk_bytes && std::chrono::steady_clock::now() < until)
    if (const auto text = read_text(part_of(folder / "log.csv")); text.ok()) part = *text;
  EXPECT_GE(part.size(), 3 * GrowingFile::kChunk_bytes);
  EXPECT_FALSE(fs::exists(folder / "log.csv"));
  ASSERT_TRUE(log.finish().ok());
  EXPECT_GE(read_text(folder / "log.csv").value().size(), steps * a_step);
}

TEST(CsvLog, AFullDiskIsToldInOneLineAndTheRunGoesOn) {
  const TestDive dive = diver_and_vehicle();
  std::vector<std::string> told;
  DiveLog log = log_to(*dive.world, "/dev/full", &told);
  for (int i = 0; i < 10'000; ++i) ASSERT_TRUE(log.accept(dive.simulation->newest(), {}).ok());
  EXPECT_TRUE(log.failed());
  const std::string line = "/dev/full: cannot be written whole (disk full?)";
  EXPECT_EQ(told, std::vector{line});
  EXPECT_EQ(log.finish().error().message, line);
}

// The limit of a file's size stands for a disk that fills.
TEST(CsvLog, AFullDiskKeepsTheRowsThatFit) {
  const TestDive dive = diver_and_vehicle();
  const test::ScratchFolder folder;
  DiveRecorder one(*dive.world, {.rows = true});
  one.add(dive.simulation->newest());
  const std::string step = csv_of(*dive.world, one.rows());
  const std::size_t head = DiveCsv(*dive.world).heading().size();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  // Within the heading, the first rows, many rows.
  for (const std::size_t most : {head / 2, head + 2 * (step.size() - head) + 10, head + 30'000}) {
    const std::string name = fmt::format("log{}.csv", most);
    const rlimit small{most, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    DiveLog log = log_to(*dive.world, folder / name);
    for (int i = 0; i < 1000; ++i) (void)log.accept(dive.simulation->newest(), {});
    EXPECT_FALSE(log.finish().ok());
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    const std::string part = read_text(part_of(folder / name)).value();
    EXPECT_LE(part.size(), most);
    EXPECT_TRUE(part.empty() || part.back() == '\n') << most;
    // The longest row is a vehicle's.
    if (most > head) {
      EXPECT_GT(part.size() + step.size() - head, most);
    }
    EXPECT_FALSE(fs::exists(folder / name));
  }
  std::signal(SIGXFSZ, handler);
}

}  // namespace
}  // namespace neritic::testbed
