// `neritic recording export` of signals that come in packets: each sample at its time, silence
// where packets are missing.
#include <cstring>

#include "engine/recording/cdr.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/recording/ros_types.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

constexpr double kSignal_hz = 1000.0;
constexpr int kSignalPacket = 50;

// Twenty packets of 50 ms; sample i of the signal is i / 1000. Those of `lost` are missing, and the
// stamps of the others are off by up to 4 ms, as clocks are.
std::string recorded_signal(const std::vector<int>& lost) {
  recording::McapWriter writer("ros2", "test");
  const auto schema = writer.add_schema(recording::ros_schema("neritic_msgs/msg/Audio"));
  const auto channel = writer.add_channel({schema, "/mic/sound", "cdr", {}});
  std::uint32_t sequence = 0;
  for (int k = 0; k < 20; ++k) {
    if (std::ranges::find(lost, k) != lost.end()) continue;
    const std::int64_t stamp_ns =
        3'000'000'000 + k * 50'000'000 + (k * 7 % 9 - 4) * 1'000'000 * (k > 0);
    std::string message;
    recording::CdrWriter cdr(message);
    cdr.header(stamp_ns, "mic");
    cdr.number(kSignal_hz);
    cdr.count(kSignalPacket);
    for (int i = 0; i < kSignalPacket; ++i)
      cdr.number(static_cast<float>(1 + k * kSignalPacket + i) / 1000.0F);
    // It comes a second later.
    writer.message({channel, sequence++, static_cast<std::uint64_t>(stamp_ns) + 1'000'000'000,
                    static_cast<std::uint64_t>(stamp_ns), std::as_bytes(std::span(message))});
  }
  writer.finish();
  return writer.take();
}

class SignalExport : public DivePhysics {
 protected:
  std::string exported(const std::string& format, const std::vector<int>& lost) {
    EXPECT_TRUE(write_text(scratch_ / "a.mcap", recorded_signal(lost)).ok());
    const std::string command =
        fmt::format("'{}/tools/neritic' recording export {} --format {} --out {} 2> {}",
                    NERITIC_BINARY_DIR, file("a.mcap"), format, file("out"), file("said"));
    EXPECT_EQ(std::system(command.c_str()), 0);
    const auto text =
        read_text(scratch_ / "out" / (format == "xdf" ? "recording.xdf" : "mic_sound." + format));
    return text.ok() ? *text : "";
  }
};

TEST_F(SignalExport, LostPacketsAreSilenceInASound) {
  const std::string wav = exported("wav", {4, 5, 11});
  const std::size_t begin = wav.find("data") + 8;
  std::vector<float> samples((wav.size() - begin) / sizeof(float));
  std::memcpy(samples.data(), wav.data() + begin, samples.size() * sizeof(float));
  ASSERT_NEAR(static_cast<double>(samples.size()), 1000.0, 5.0);  // as the last stamp says
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] == 0.0F) continue;
    EXPECT_NEAR(samples[i] * 1000.0F, static_cast<float>(i + 1), 5.0F) << i;
  }
  EXPECT_NEAR(static_cast<double>(std::ranges::count(samples, 0.0F)), 150.0, 10.0);
  const std::string said = read_text(scratch_ / "said").value();
  EXPECT_NE(said.find("/mic/sound: 2 gaps of lost packets, 0.1"), std::string::npos) << said;
}

TEST_F(SignalExport, TablesHaveARowASample) {
  const std::string csv = exported("csv", {4});
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "captured_s,sample");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 19 * kSignalPacket);
  EXPECT_NE(csv.find("\n3.000000000,0.001\n3.001000000,0.002\n"), std::string::npos);
  const std::string npy = exported("npy", {4});
  EXPECT_NE(npy.find("(950, 2)"), std::string::npos) << npy.substr(0, 120);
}

TEST_F(SignalExport, AnXdfHasEachSampleAtItsRate) {
  const std::string xdf = exported("xdf", {});
  EXPECT_NE(xdf.find("<name>/mic/sound</name>"), std::string::npos);
  EXPECT_NE(xdf.find("<nominal_srate>1000</nominal_srate>"), std::string::npos)
      << xdf.substr(0, 600);
  EXPECT_NE(xdf.find("<sample_count>1000</sample_count>"), std::string::npos);
}

// A lab that repeats a line keeps the trial before.
TEST_F(SignalExport, ARecordingOfTheSameNameIsKept) {
  for (int i = 0; i < 3; ++i)
    ASSERT_LE(
        dive(fmt::format("--headless --seconds {} --record {}", i + 1, file("b.mcap")), "dive.toml")
            .status,
        1);
  const auto seconds = [&](const std::string& name) {
    const std::string command = fmt::format("'{}/tools/neritic' recording info {} --json > {}",
                                            NERITIC_BINARY_DIR, file(name), file("info"));
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
    const std::string json = read_text(scratch_ / "info").value();
    const std::size_t at = json.find("\"seconds\": ");
    return at == std::string::npos ? -1.0 : std::stod(json.substr(at + 11));
  };
  EXPECT_NEAR(seconds("b_old1.mcap"), 1.0, 1e-6);
  EXPECT_NEAR(seconds("b_old2.mcap"), 2.0, 1e-6);
  EXPECT_NEAR(seconds("b.mcap"), 3.0, 1e-6);
  // One that begins later is no longer for that.
  ASSERT_LE(dive("--headless --seconds 5 --save " + file("b.state"), "dive.toml").status, 1);
  ASSERT_LE(
      dive("--headless --seconds 2 --restore " + file("b.state") + " --record " + file("c.mcap"),
           "dive.toml")
          .status,
      1);
  EXPECT_NEAR(seconds("c.mcap"), 2.0, 0.02);
}

}  // namespace
}  // namespace neritic
