// The recording of a run reaches its file while the run goes on.
#include "testbed/record/recording_file.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>

#include "engine/recording/mcap_reader.hpp"
#include "testbed/record/recording_switch.hpp"
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
// Messages of a topic.
class TopicCount final : public recording::McapVisitor {
 public:
  Status channel(std::uint16_t id, const recording::McapChannel& channel) override {
    topics_[id] = channel.topic;
    return {};
  }
  Status message(const recording::McapMessage& message) override {
    ++counts[topics_[message.channel]];
    return {};
  }
  std::map<std::string, int> counts;

 private:
  std::map<std::uint16_t, std::string> topics_;
};

// The inertial unit of the shipped survey vehicle reads at 200 Hz, here beside steps of 60 Hz.
TEST(RecordingFile, HasEachReadingOfASensorThatIsFasterThanTheSteps) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "run.mcap";
  TestDive dive =
      dive_of("[physics]\nrate_hz = 60\n" +
              rov_text("position_m = [0, -6, 0]\n", "rov", "bluerov2_heavy_survey_dynamics.toml"));
  RecordingFile file(*dive.world, *dive.simulation, path, {});
  OutputSamples outputs(*dive.world, file.streams());
  const auto accept = [&](const auto& step) {
    ASSERT_TRUE(file.accept(step, outputs.of(step)).ok());
  };
  accept(dive.simulation->newest());
  dive.simulation->observe(accept, [&](const Sample& sample) { (void)file.use(sample); });
  dive.run(5.0);
  ASSERT_TRUE(file.finish().ok());
  TopicCount count;
  ASSERT_TRUE(recording::read_mcap(*recording::open_mcap(path).value(), "run", count).ok());
  EXPECT_EQ(count.counts["/rov/imu"], 1001);
  const auto log = read_sample_log(path);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_FALSE(replay_run(*dive.world, *log, "run.mcap").value().first_difference);
}

TEST(RecordingFile, ARecordingByKeyHasTheSoundFromItsBeginningToItsEnd) {
  const test::ScratchFolder folder;
  TestDive dive = dive_of(hover_text(""));
  SignalQueue heard;
  const auto hear = [&](int packets) {
    for (int i = 0; i < packets; ++i)
      heard.push(20'000'000 * i, 16'000.0, std::vector<float>(320, 0.25F));
  };
  RecordingSwitch key(*dive.world);
  for (const char* name : {"a", "b"}) {
    hear(5);  // nobody records it
    RecordingOptions options;
    options.signals = {{"mic", "sound", &heard}};
    key.begin(*dive.simulation, folder / name, std::move(options));
    hear(3);
    dive.simulation->advance(1);
    ASSERT_TRUE(key.accept(dive.simulation->newest(), {}).ok());
    ASSERT_TRUE(key.end()->finish().ok());
    hear(7);  // nobody any more
    EXPECT_TRUE(heard.take().empty());
    const auto source = recording::open_mcap(folder / (std::string(name) + ".mcap")).value();
    TopicCount topics;
    ASSERT_TRUE(recording::read_mcap(*source, name, topics).ok());
    EXPECT_EQ(topics.counts["/mic/sound"], 3) << name;
  }
}

}  // namespace
}  // namespace neritic::testbed
