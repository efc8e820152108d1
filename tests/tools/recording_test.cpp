// `neritic recording`, and what a recording says to other programs.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/recording/mcap_copy.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

class Recording : public DivePhysics {
 protected:
  void SetUp() override {
    DivePhysics::SetUp();
    // A vehicle with sensors.
    auto text = read_text(scratch_ / "dive.toml").value();
    const std::string plain = "bluerov2_heavy_dynamics";
    text.replace(text.find(plain), plain.size(), "bluerov2_heavy_survey_dynamics");
    ASSERT_TRUE(write_text(scratch_ / "dive.toml", text).ok());
    ASSERT_EQ(dive("--headless --seconds 4 --record " + file("a.mcap")).status, 0);
  }
  // A copy of a.mcap in chunks of so many messages, one of which is damaged, from 0.
  void damage(const std::string& name, int messages, int chunk) {
    struct Copy final : recording::McapCopy {
      Copy(recording::McapWriter& out, int of) : McapCopy(out), writer(out), most(of) {}
      Status message(const recording::McapMessage& message) override {
        const Status status = McapCopy::message(message);
        if (++count % most == 0) writer.end_chunk();
        return status;
      }
      recording::McapWriter& writer;
      int most, count = 0;
    };
    recording::McapWriter writer("ros2", "test");
    Copy copy(writer, messages);
    const auto source = recording::open_mcap(scratch_ / "a.mcap").value();
    ASSERT_TRUE(recording::read_mcap(*source, "a.mcap", copy).ok());
    writer.finish();
    std::string bytes = writer.take();
    std::size_t at = bytes.find("zstd");
    for (int i = 0; i < chunk; ++i) at = bytes.find("zstd", at + 1);
    bytes.at(at + 20) = static_cast<char>(bytes[at + 20] ^ 1);
    ASSERT_TRUE(write_text(scratch_ / name, bytes).ok());
  }
  // The number before " steps to replay".
  static std::string steps_in(const std::string& words) {
    const std::size_t end = words.find(" steps to replay");
    if (end == std::string::npos) return "none in " + words;
    const std::size_t from = words.rfind(' ', end - 1) + 1;
    return words.substr(from, end - from);
  }
};

TEST_F(Recording, SaysWhatItHoldsAndThatItIsWhole) {
  const auto json = parse_json(neritic("recording info --json " + file("a.mcap")).out).value();
  EXPECT_EQ(json["profile"], "ros2");
  EXPECT_EQ(json["whole"], true);
  EXPECT_EQ(json["run"]["seed"], "1");
  std::map<std::string, nlohmann::json> topics;
  for (const auto& topic : json["topics"]) topics[topic["topic"]] = topic;
  ASSERT_TRUE(topics.contains("/rov/imu")) << json.dump();
  EXPECT_EQ(topics["/rov/imu"]["type"], "sensor_msgs/msg/Imu");
  EXPECT_EQ(topics["/rov/odometry"]["type"], "nav_msgs/msg/Odometry");
  EXPECT_NEAR(topics["/rov/odometry"]["rate_hz"].get<double>(), 60.0, 0.1);
  EXPECT_EQ(topics["/neritic/step"]["messages"], 961);
  EXPECT_EQ(json["attachments"][0]["name"], "scene.toml");
  const Outcome check = neritic("recording check " + file("a.mcap"));
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_NE(check.out.find("whole; "), std::string::npos) << check.out;
  EXPECT_NE(check.out.find("960 steps to replay"), std::string::npos) << check.out;
}

// The scene is in it: it may change or go, and the replay is of what was recorded.
TEST_F(Recording, ReplaysWithoutItsSceneFile) {
  ASSERT_TRUE(write_text(scratch_ / "dive.toml", "[physics]\n").ok());
  const Outcome replay = neritic("dive --headless --replay " + file("a.mcap"));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find("960 of 960 steps, each with the hash"), std::string::npos)
      << replay.out;
}

TEST_F(Recording, ADamagedOneIsFoundAndMended) {
  auto bytes = read_file(scratch_ / "a.mcap").value();
  bytes.resize(bytes.size() - 200);  // its summary is not whole
  ASSERT_TRUE(write_file(scratch_ / "cut.mcap", bytes).ok());
  const Outcome check = neritic("recording check " + file("cut.mcap"));
  EXPECT_EQ(check.status, 1);
  EXPECT_NE(check.err.find("cut off: it has no end; "), std::string::npos) << check.err;
  const Outcome mended =
      neritic("recording repair " + file("cut.mcap") + " --out " + file("new.mcap"));
  EXPECT_EQ(mended.status, 0) << mended.err;
  const Outcome again = neritic("recording check " + file("new.mcap"));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(neritic("recording repair " + file("a.mcap") + " --out " + file("a.mcap")).status, 2);
}

// A repaired file replays the steps before the damage and exports those behind it.
TEST_F(Recording, ARepairedOneReplaysAsFarAsBefore) {
  damage("bad.mcap", 500, 2);
  const Outcome before = neritic("recording check " + file("bad.mcap"));
  EXPECT_EQ(before.status, 1);
  const std::string steps = steps_in(before.err);
  EXPECT_GT(std::atoi(steps.c_str()), 0) << before.err;
  const Outcome mended =
      neritic("recording repair " + file("bad.mcap") + " --out " + file("new.mcap"));
  EXPECT_EQ(mended.status, 0) << mended.err;
  EXPECT_EQ(steps_in(mended.out), steps) << mended.out;
  const Outcome after = neritic("recording check " + file("new.mcap"));
  EXPECT_EQ(after.status, 1);
  EXPECT_EQ(steps_in(after.err), steps);
  EXPECT_NE(after.err.find(" are missing; "), std::string::npos) << after.err;
  const Outcome replay = neritic("dive --headless --replay " + file("new.mcap"));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find(steps + " of " + steps + " steps, each with the hash"),
            std::string::npos)
      << replay.out;
  const Outcome csv = neritic("recording export " + file("new.mcap") + " --out " + file("t") +
                              " --topic /rov/odometry");
  ASSERT_EQ(csv.status, 0) << csv.err;
  const auto times = table("t/rov_odometry.csv").at("time_s");
  EXPECT_LT(times.size(), 241u);
  EXPECT_NEAR(std::stod(times.back()), 4.0, 1e-6);
}

TEST_F(Recording, OneWithoutItsFirstChunkIsRescuedForExport) {
  damage("bad.mcap", 500, 0);
  const Outcome mended =
      neritic("recording repair " + file("bad.mcap") + " --out " + file("new.mcap"));
  EXPECT_EQ(mended.status, 0) << mended.err;
  const Outcome check = neritic("recording check " + file("new.mcap"));
  EXPECT_EQ(check.status, 1);
  EXPECT_NE(check.err.find(" are missing: it cannot be replayed"), std::string::npos) << check.err;
  EXPECT_EQ(std::ranges::count(check.err, '\n'), 1) << check.err;
  ASSERT_EQ(neritic("recording export " + file("new.mcap") + " --out " + file("t")).status, 0);
  EXPECT_NEAR(std::stod(table("t/rov_odometry.csv").at("time_s").back()), 4.0, 1e-6);
}

// Bits of the facts of the run flip: of one copy the other one counts, of both nothing can be
// replayed, but the rest is exported.
TEST_F(Recording, ADamagedFactOfTheRunLeavesItsCopyOrTheTables) {
  const std::string whole = read_text(scratch_ / "a.mcap").value();
  const auto flip = [](std::string& bytes, std::size_t from, std::string_view word) {
    const std::size_t at = bytes.find(word, from);
    bytes.at(at) = static_cast<char>(bytes[at] ^ 1);
    return at + word.size();
  };
  for (const bool both : {false, true})
    for (const char* word : {"first_step", "step_s", "format"}) {
      std::string bytes = whole;
      const std::size_t after = flip(bytes, 0, word);
      if (both) flip(bytes, after, word);
      ASSERT_TRUE(write_text(scratch_ / "bad.mcap", bytes).ok());
      std::filesystem::remove(scratch_ / "new.mcap");
      const Outcome mended =
          neritic("recording repair " + file("bad.mcap") + " --out " + file("new.mcap"));
      EXPECT_EQ(mended.status, 0) << mended.err;
      const Outcome check = neritic("recording check " + file("new.mcap"));
      EXPECT_EQ(check.status, both ? 1 : 0) << check.err;
      if (both) {
        EXPECT_NE(check.err.find(": it cannot be replayed, only exported"), std::string::npos)
            << check.err;
        EXPECT_EQ(std::ranges::count(check.err, '\n'), 1) << check.err;
        EXPECT_NE(mended.out.find(": it cannot be replayed, only exported"), std::string::npos)
            << mended.out;
      } else {
        EXPECT_EQ(steps_in(check.out), "960");
      }
      const Outcome csv = neritic("recording export " + file("new.mcap") + " --out " + file("t") +
                                  " --topic /rov/odometry");
      EXPECT_EQ(csv.status, 0) << csv.err;
    }
}

TEST_F(Recording, RepairMakesNoFileOfNothingAndReplacesNone) {
  ASSERT_EQ(dive("--headless --seconds 0.5 --record " + file("a.mcap")).status, 0);
  damage("bad.mcap", 1'000'000, 0);
  const Outcome none =
      neritic("recording repair " + file("bad.mcap") + " --out " + file("new.mcap"));
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("nothing of it can be rescued"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "new.mcap"));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "new.mcap.part"));
  // A file that is there stays; the recording of a killed run gets its own name.
  const Outcome there =
      neritic("recording repair " + file("bad.mcap") + " --out " + file("a.mcap"));
  EXPECT_EQ(there.status, 2);
  EXPECT_NE(there.err.find("which is there already"), std::string::npos) << there.err;
  std::filesystem::rename(scratch_ / "a.mcap", scratch_ / "killed.mcap.part");
  const auto bytes = read_file(scratch_ / "killed.mcap.part").value();
  const Outcome named =
      neritic("recording repair " + file("killed.mcap.part") + " --out " + file("killed.mcap"));
  EXPECT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(neritic("recording check " + file("killed.mcap")).status, 0);
  EXPECT_EQ(read_file(scratch_ / "killed.mcap.part").value(), bytes);
}

TEST_F(Recording, ExportsTablesAndArrays) {
  const std::string from = "recording export " + file("a.mcap") + " --out " + file("t");
  const Outcome csv = neritic(from + " --topic /rov/odometry");
  ASSERT_EQ(csv.status, 0) << csv.err;
  const auto columns = table("t/rov_odometry.csv");
  ASSERT_TRUE(columns.contains("pose_pose_position_z"));
  EXPECT_EQ(columns.at("time_s").size(), 241u);
  // East, north, up: it begins 6 m deep, and heads north to z = -2, which is y = 2.
  EXPECT_NEAR(std::stod(columns.at("pose_pose_position_z").front()), -6.0, 1e-6);
  EXPECT_GT(std::stod(columns.at("pose_pose_position_y").back()), 0.5);
  // A model that faces -z heads north: a quarter turn to the left from east.
  EXPECT_NEAR(std::abs(std::stod(columns.at("pose_pose_orientation_z").front())), std::sqrt(0.5),
              0.02);
  const Outcome npy = neritic(from + " --format npy --topic /rov/imu");
  ASSERT_EQ(npy.status, 0) << npy.err;
  const auto imu = read_npy(scratch_ / "t/rov_imu.npy").value();
  const auto names = parse_json(read_text(scratch_ / "t/rov_imu.json").value()).value();
  ASSERT_EQ(imu.shape.size(), 2u);
  EXPECT_EQ(imu.shape[1], names["columns"].size());
  // At rest an inertial unit feels the ground's push, upwards.
  const auto up = std::ranges::find(names["columns"], "linear_acceleration_z");
  const auto column = static_cast<std::size_t>(up - names["columns"].begin());
  EXPECT_NEAR(imu.to_doubles()[10 * imu.shape[1] + column], 9.8, 1.0);
  EXPECT_EQ(neritic(from + " --format xdf").status, 0);
  EXPECT_EQ(read_text(scratch_ / "t/recording.xdf").value().substr(0, 4), "XDF:");
  const Outcome none = neritic(from + " --topic /nose");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("--topic: found /nose; accepted: "), std::string::npos) << none.err;
}

// Another program's reader: npm's @mcap/core, where NODE_PATH leads to it.
TEST_F(Recording, TheOfficialReaderReadsItBack) {
  const std::string script = (test::source_dir() / "tests/tools/read_recording.cjs").string();
  const int raw = std::system(fmt::format("node '{}' '{}' > '{}' 2> '{}'", script,
                                          (scratch_ / "a.mcap").string(),
                                          (scratch_ / "out").string(), (scratch_ / "err").string())
                                  .c_str());
  const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  if (status == 127 || status == 77)
    GTEST_SKIP() << "no node with @mcap/core and fzstd (npm install; NODE_PATH)";
  const std::string out = read_text(scratch_ / "out").value();
  ASSERT_EQ(status, 0) << read_text(scratch_ / "err").value();
  EXPECT_NE(out.find("961 /neritic/step"), std::string::npos) << out;
  EXPECT_NE(out.find("241 /rov/odometry"), std::string::npos) << out;
}

}  // namespace
}  // namespace neritic
