// The recording of a run reaches its file while the run goes on.
#include <gtest/gtest.h>

#include <chrono>

#include "testbed/record/file_sinks.hpp"
#include "tests/testbed/simulation/devices.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

// A suit at 240 Hz, which is opened after the first second; it leaves a chunk after two more.
TEST(RecordingFile, AKilledRunReplaysUpToNearlyItsEnd) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "run.log";
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  RecordingFile file(*dive.world, dive.simulation->inbox(), path);
  const auto accept = [&](const auto& step) { ASSERT_TRUE(file.accept(step, {}).ok()); };
  accept(dive.simulation->newest());
  dive.simulation->observe(accept, [&](const Sample& sample) { (void)file.use(sample); });
  dive.run(1.0);
  Device suit(dive, "suit", "diver/joints");
  for (int i = 0; i < 900; ++i) {
    suit.say(empty_payload(PayloadKind::kBodyJoints));
    dive.simulation->advance(1);
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  std::error_code none_yet;
  while (!(fs::file_size(part_of(path), none_yet) >= GrowingFile::kChunk_bytes && !none_yet) &&
         std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(fs::exists(path));
  const auto part = read_sample_log(part_of(path));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_FALSE(part->whole);
  EXPECT_GT(part->steps(), 300u);
  EXPECT_LT(part->steps(), 1140u);
  const auto replayed = replay_run(*dive.world, *part, "run.log.part").value();
  EXPECT_FALSE(replayed.first_difference.has_value());
  EXPECT_EQ(replayed.steps, part->steps());

  ASSERT_TRUE(file.finish().ok());
  EXPECT_FALSE(fs::exists(part_of(path)));
  const auto log = read_sample_log(path);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_TRUE(log->whole);
  const SampleLog kept = recorded_run(*dive.world, *dive.simulation);
  EXPECT_EQ(log->hashes, kept.hashes);
  EXPECT_EQ(log->sources, kept.sources);
  EXPECT_EQ(log->entries.size(), 900u);
}

}  // namespace
}  // namespace neritic::testbed
