// A microphone that is a file: real breaths, in every form that recorders write.
#include <bit>
#include <cmath>

#include "diver/physio_wav.hpp"
#include "engine/core/files.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

std::string number(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
  return out;
}

std::string chunk(const std::string& tag, const std::string& data) {
  return tag + number(data.size(), 4) + data + std::string(data.size() & 1, '\0');
}

// 24-bit extensible, 32-bit float, two channels of which the first is the sound; with chunks of odd
// length before and after, as editors leave them.
std::string rewritten(const diver::Recording& sound, int bits, bool floats, int channels) {
  const auto rate = static_cast<std::uint64_t>(sound.rate_hz);
  const auto frame = static_cast<std::uint64_t>(channels * bits / 8);
  std::string format = number(floats ? 3 : 0xFFFE, 2) + number(channels, 2) + number(rate, 4) +
                       number(rate * frame, 4) + number(frame, 2) + number(bits, 2);
  if (!floats)
    format += number(22, 2) + number(bits, 2) + number(4, 4) + number(1, 2) +
              std::string("\0\0\0\0\x10\0\x80\0\0\xAA\0\x38\x9B\x71", 14);
  std::string data;
  for (const double sample : sound.samples)
    for (int channel = 0; channel < channels; ++channel) {
      const double value = channel == 0 ? sample : 0.0;
      if (floats)
        data += number(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
      else
        data += number(static_cast<std::uint64_t>(std::llround(value * std::pow(2.0, bits - 1))),
                       static_cast<std::size_t>(bits / 8));
    }
  const std::string body = "WAVE" + chunk("LIST", "INFOISFT\x05\0\0\0Lavf") +
                           chunk("bext", std::string(603, 'x')) + chunk("fmt ", format) +
                           chunk("fact", number(sound.samples.size(), 4)) + chunk("data", data) +
                           chunk("id3 ", "odd");
  return "RIFF" + number(body.size(), 4) + body;
}

// A minute of a dive in simulated time that hears the file: the rates of breath that it finds.
std::vector<double> heard(const std::filesystem::path& file, double rate_hz) {
  TestDive dive = dive_of(lab_text(fmt::format(
      "mic = {{ device = \"microphone wav {}\", rate_hz = {:g} }}\n", file.string(), rate_hz)));
  auto source = DeviceSource::open(dive.scene.sources.at(0), *dive.world, dive.simulation->inbox(),
                                   DeviceSource::Pace::kPolled);
  EXPECT_TRUE(source.ok()) << source.error().message;
  std::vector<double> rates_bpm;
  for (int i = 0; source.ok() && i < 600; ++i) {
    EXPECT_TRUE((*source)->poll(dive.simulation->inbox(), 0.1 * i).ok());
    for (const Sample& sample : dive.simulation->inbox().drain())
      rates_bpm.push_back(std::get<Breath>(sample.payload).monitor.estimate.rate_bpm);
  }
  return rates_bpm;
}

TEST(MicrophoneFile, ARealBreathIsFoundInEveryFormOfItsFile) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto recordings = shared / "data/recordings/breath_paced";
  const test::ScratchFolder scratch;
  const auto original = recordings / "RRinervasO_18bpm_2023021713052.wav";
  const auto sound = diver::parse_wav(read_file(original).value(), "it", 0).value();
  const std::vector<double> rates_bpm = heard(original, sound.rate_hz);
  ASSERT_GE(rates_bpm.size(), 5u);
  // Where the analysis is not sure it says none: 0.
  std::size_t sure = 0;
  for (const double rate_bpm : rates_bpm) {
    if (rate_bpm == 0.0) continue;
    ++sure;
    EXPECT_NEAR(rate_bpm, 18.0, 1.5);
  }
  EXPECT_GE(sure, 4u);
  struct Form {
    int bits;
    bool floats;
    int channels;
  };
  for (const Form form : {Form{24, false, 2}, Form{32, true, 1}}) {
    ASSERT_TRUE(
        write_text(scratch / "it.wav", rewritten(sound, form.bits, form.floats, form.channels))
            .ok());
    const std::vector<double> again = heard(scratch / "it.wav", sound.rate_hz);
    ASSERT_EQ(again.size(), rates_bpm.size()) << form.bits;
    for (std::size_t i = 0; i < again.size(); ++i)
      EXPECT_NEAR(again[i], rates_bpm[i], 1e-3) << form.bits << " " << i;
  }
}

TEST(MicrophoneFile, AnotherRateAndNoSoundAreRefused) {
  const test::ScratchFolder scratch;
  const auto refusal_of = [&](const std::string& text) {
    EXPECT_TRUE(write_text(scratch / "it.wav", text).ok());
    TestDive dive = dive_of(
        lab_text(fmt::format("mic = \"microphone wav {}\"\n", (scratch / "it.wav").string())));
    const auto source = DeviceSource::open(dive.scene.sources.at(0), *dive.world,
                                           dive.simulation->inbox(), DeviceSource::Pace::kPolled);
    return source.ok() ? std::string() : source.error().message;
  };
  const diver::Recording slow{.rate_hz = 8000.0, .samples = std::vector<double>(100, 0.1)};
  EXPECT_TRUE(refusal_of(rewritten(slow, 24, false, 1))
                  .ends_with("found 8000 samples a second; accepted: 16000, the source's rate_hz"));
  EXPECT_NE(refusal_of(rewritten({.rate_hz = 16000.0}, 24, false, 1)).find("found no samples"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
