// The log of a dive reaches its file while the run goes on.
#include "testbed/record/csv_log.hpp"

#include <gtest/gtest.h>

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

DiveLog log_to(const PhysicsWorld& world, const fs::path& path) {
  std::vector<std::unique_ptr<RowSink>> rows;
  rows.push_back(std::make_unique<CsvLog>(world, path));
  return DiveLog(world, 0.0, std::move(rows));
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

TEST(CsvLog, AFullDiskEndsTheRunInOneLine) {
  const TestDive dive = diver_and_vehicle();
  DiveLog log = log_to(*dive.world, "/dev/full");
  Status status;
  for (int i = 0; i < 1'000'000 && status.ok(); ++i)
    status = log.accept(dive.simulation->newest(), {});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "/dev/full: cannot be written whole (disk full?)");
  EXPECT_EQ(log.finish().error().message, status.error().message);
}

}  // namespace
}  // namespace neritic::testbed
