// The recording of a run reaches its file while the run goes on.
#include "testbed/record/recording_file.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/testbed/simulation/devices.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

// A suit at 240 Hz, which is opened after the first second.
TEST(RecordingFile, AKilledRunReplaysUpToItsLastSecond) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "run.mcap";
  TestDive dive = dive_of(hover_text("body = \"suit\""));
  RecordingFile file(*dive.world, *dive.simulation, path, {});
  OutputSamples outputs(*dive.world, file.streams());
  const auto accept = [&](const auto& step) {
    ASSERT_TRUE(file.accept(step, outputs.of(step)).ok());
  };
  accept(dive.simulation->newest());
  dive.simulation->observe(accept, [&](const Sample& sample) { (void)file.use(sample); });
  dive.run(1.0);
  Device suit(dive, "suit", "diver/joints");
  for (int i = 0; i < 900; ++i) {
    suit.say(empty_payload(PayloadKind::kBodyJoints));
    dive.simulation->advance(1);
  }
  // Nothing more comes: within a second all of it is in the file.
  std::this_thread::sleep_for(std::chrono::milliseconds(900));
  auto part = read_sample_log(part_of(path));
  // A busy machine may hold the writing thread up.
  for (int look = 0; look < 100 && (!part.ok() || part->steps() < 1140); ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    part = read_sample_log(part_of(path));
  }
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_FALSE(part->whole);
  EXPECT_EQ(part->steps(), 1140u);
  const auto replayed = replay_run(*dive.world, *part, "run.mcap.part").value();
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
