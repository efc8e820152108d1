// `neritic dive --record` of a scene with a microphone: its sound comes back as a .wav, sample for
// sample.
#include <cstring>

#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

constexpr int kRate_hz = 16'000, kTurn = 16'000;

// A ramp that repeats each second, in 16 bits.
std::string ramp() {
  std::string data;
  for (int i = 0; i < kTurn; ++i) {
    const auto value = static_cast<std::int16_t>(i - kTurn / 2);
    data.append(reinterpret_cast<const char*>(&value), 2);
  }
  std::string out = "RIFF";
  const auto put = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(36 + data.size()));
  out += "WAVEfmt ";
  put(std::uint32_t{16}), put(std::uint16_t{1}), put(std::uint16_t{1});
  put(std::uint32_t{kRate_hz}), put(std::uint32_t{2 * kRate_hz});
  put(std::uint16_t{2}), put(std::uint16_t{16});
  out += "data";
  put(static_cast<std::uint32_t>(data.size()));
  return out + data;
}

TEST_F(DivePhysics, AMicrophonesSoundIsInTheRecordingSampleForSample) {
  const std::string assets = (test::source_dir() / "assets").string();
  ASSERT_TRUE(write_text(scratch_ / "ramp.wav", ramp()).ok());
  ASSERT_TRUE(write_text(scratch_ / "lab.toml",
                         "include = \"dive.toml\"\n[[objects]]\nname = \"diver\"\nclass = "
                         "\"diver\"\nmodel = \"" +
                             assets + "/models/diver.glb\"\nhuman = \"" + assets +
                             "/divers/recreational.toml\"\nposition_m = [4, -6, 0]\n[sources]\n"
                             "mic = \"microphone wav " +
                             (scratch_ / "ramp.wav").string() + "\"\n")
                  .ok());
  const Outcome outcome =
      dive("--headless --realtime --seconds 2 --record " + file("a.mcap"), "lab.toml");
  ASSERT_LE(outcome.status, 1) << outcome.err;  // 1: the mission is not finished
  const std::string exported =
      fmt::format("'{}/tools/neritic' -q recording export {} --format wav --out {}",
                  NERITIC_BINARY_DIR, file("a.mcap"), file("sounds"));
  ASSERT_EQ(std::system(exported.c_str()), 0);
  const std::string sound = read_text(scratch_ / "sounds/mic_sound.wav").value();
  const std::size_t begin = sound.find("data") + 8;
  std::vector<float> samples((sound.size() - begin) / sizeof(float));
  std::memcpy(samples.data(), sound.data() + begin, samples.size() * sizeof(float));
  ASSERT_GT(samples.size(), 16'000u);
  const int first = static_cast<int>(samples[0] * 32768.0F) + kTurn / 2;
  for (std::size_t i = 0; i < samples.size(); ++i)
    ASSERT_EQ(samples[i] * 32768.0F,
              static_cast<float>((first + static_cast<int>(i)) % kTurn - kTurn / 2))
        << i;
  // The recording replays: sound moves nothing.
  const Outcome replay = dive("--headless --replay " + file("a.mcap"), "lab.toml");
  EXPECT_EQ(replay.status, 0) << replay.err;
}

}  // namespace
}  // namespace neritic
