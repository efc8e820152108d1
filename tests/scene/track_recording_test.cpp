// A participant of a recorded dive as a track: its way in this scene's axes, from a time on, and
// files and names that are wrong.
#include "engine/scene/track_recording.hpp"

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/core/ros_frames.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/recording/ros_types.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

const Quat kTurned = from_yaw_pitch_roll(0.5, -0.2, 0.1);

// "diver" at (t, -5, -2 t) for three seconds from 10 s on.
std::string recording_bytes() {
  recording::McapWriter writer("ros2", "test");
  const auto schema = writer.add_schema(recording::ros_schema("nav_msgs/msg/Odometry"));
  const auto channel =
      writer.add_channel({schema, "/diver/odometry", "cdr", {{"stream", "diver/odometry"}}});
  for (std::uint32_t i = 0; i <= 3; ++i) {
    const std::int64_t ns = 10'000'000'000 + i * std::int64_t{1'000'000'000};
    std::string bytes;
    recording::CdrWriter cdr(bytes);
    cdr.header(ns, "map");
    cdr.text("diver/base_link");
    cdr.vector(ros::enu_from_world({double(i), -5.0, -2.0 * i}));
    cdr.quaternion(ros::enu_from_body(kTurned));
    for (int k = 0; k < 36 + 6 + 36; ++k) cdr.number(0.0);
    writer.message({channel, i, static_cast<std::uint64_t>(ns), static_cast<std::uint64_t>(ns),
                    std::as_bytes(std::span(bytes))});
    writer.end_chunk();
  }
  writer.finish();
  return writer.take();
}

struct Scratch {
  Scratch() { EXPECT_TRUE(write_text(folder / "dive.mcap", recording_bytes()).ok()); }
  Result<Scene> load(const std::string& track) const {
    EXPECT_TRUE(write_text(folder / "s.toml",
                           "[[objects]]\nname = \"ghost\"\nshape = \"box\"\n"
                           "pitch_deg = -90\ntrack = { " +
                               track + " }\n")
                    .ok());
    return load_scene(folder / "s.toml");
  }
  test::ScratchFolder folder;
};

TEST(RecordedTrack, AParticipantMovesAsItDidWithItsAttitude) {
  const Scratch scratch;
  const auto scene = scratch.load("recording = \"dive.mcap\", participant = \"diver\"");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const Pose pose = scene->world_from(scene->objects[0].mount, 11.5);
  EXPECT_NEAR(glm::length(pose.position_m - Vec3(1.5, -5.0, -3.0)), 0.0, 1e-9);
  const Quat wanted = kTurned * from_yaw_pitch_roll(0.0, radians(-90.0), 0.0);
  EXPECT_NEAR(std::abs(glm::dot(pose.rotation, wanted)), 1.0, 1e-9);
}

TEST(RecordedTrack, ItBeginsWhenTheSceneSays) {
  const Scratch scratch;
  const auto scene =
      scratch.load("recording = \"dive.mcap\", participant = \"diver\", start_s = 2");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_NEAR(scene->world_from(scene->objects[0].mount, 3.5).position_m.x, 1.5, 1e-9);
}

TEST(RecordedTrack, AFileThatWasCutOffIsReadUpToThere) {
  const std::string bytes = recording_bytes();
  const test::ScratchFolder folder;
  // Without its summary and its last chunk, within a chunk, and so on.
  for (std::size_t size = bytes.size(); size > 8; size -= std::min<std::size_t>(size, 97)) {
    ASSERT_TRUE(write_text(folder / "cut.mcap", bytes.substr(0, size)).ok());
    const auto track = read_recorded_track(folder / "cut.mcap", "diver");
    EXPECT_TRUE(!track.ok() || track->places.size() >= 2u);
  }
}

TEST(RecordedTrack, WrongNamesAndFilesAreRefusedInOneLine) {
  const Scratch scratch;
  const auto refused = [&](const std::string& track) {
    const auto scene = scratch.load(track);
    EXPECT_FALSE(scene.ok());
    return scene.ok() ? std::string() : scene.error().message;
  };
  EXPECT_NE(refused("recording = \"dive.mcap\", participant = \"eve\"")
                .find("found 0 places of 'eve'; accepted: diver"),
            std::string::npos);
  EXPECT_NE(refused("recording = \"dive.mcap\"").find("participant"), std::string::npos);
  EXPECT_NE(refused("waypoints_m = [[0,0,0],[1,0,0]], speed_m_s = 1, participant = \"diver\"")
                .find("no such key without recording"),
            std::string::npos);
  EXPECT_NE(refused("recording = \"s.toml\", participant = \"diver\"").find("recording"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::scene
