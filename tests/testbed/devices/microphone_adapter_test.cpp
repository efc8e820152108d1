// A microphone's packets as breath: loss, other rates and forms, two senders.
#include "testbed/devices/microphone_adapter.hpp"

#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

TEST(MicrophoneAdapter, OfTwoAtOnePortTheFirstIsHeardAndTheOtherIsTold) {
  Bench bench("mic = \"microphone udp\"\n");
  MicrophoneAdapter microphone(16'000.0);
  SignalQueue heard;
  microphone.give_signal_to(&heard);
  heard.want(true);
  const auto run = [&](std::uint32_t from, std::initializer_list<std::uint32_t> senders) {
    for (std::uint32_t i = from; i < from + 200; ++i)
      for (const std::uint32_t sender : senders)
        microphone.take(
            net::encode_rtp({96, static_cast<std::uint16_t>(i + 100 * sender),
                             320 * i + 1'000'000 * sender, sender,
                             std::vector<float>(320, 0.1F * static_cast<float>(sender))}),
            false, i * 20 * kMillisecond_ns, bench.out);
    std::vector<float> levels;
    for (const SignalPacket& packet : heard.take()) levels.push_back(packet.samples.at(0));
    return levels;
  };
  for (const float level : run(0, {1, 2})) EXPECT_NEAR(level, 0.1F, 1e-4F);
  EXPECT_EQ(microphone.counts().unused, 200u);
  EXPECT_EQ(microphone.counts().lost + microphone.counts().older, 0u);
  EXPECT_EQ(microphone.trouble(), "a second microphone sends here too and is not used: one a port");
  const auto levels = run(200, {2});
  ASSERT_EQ(levels.size(), 151u);
  for (const float level : levels) EXPECT_NEAR(level, 0.2F, 1e-4F);
  EXPECT_EQ(microphone.counts().restarts, 1u);
  expect_adds_up(microphone.counts());
}

TEST(MicrophoneAdapter, BreathIsFoundOverALossyLink) {
  Bench bench("mic = \"microphone udp\"\n");
  MicrophoneAdapter microphone(16'000.0);
  SimulatedDeviceOptions options;
  options.clock.offset_ns = 10 * kSecond_ns;
  const auto samples = run_device("microphone", {.breath_bpm = 15.0}, 61.0,
                                  {.jitter_s = 0.02, .loss = 0.02}, microphone, bench, options);
  ASSERT_GE(samples.size(), 5u);
  const Breath& breath = std::get<Breath>(samples.back().payload);
  EXPECT_NEAR(breath.monitor.estimate.rate_bpm, 15.0, 1.0);
  EXPECT_NEAR(microphone.clock().offset_s, -10.0, 1e-3);
  expect_adds_up(microphone.counts());
}

// A breath of 48 kHz, taken as one of 16 kHz, would be three times as slow. The other way round the
// first ten seconds of sound take 30.
TEST(MicrophoneAdapter, SoundOfAnotherRateIsToldAndGivesNoBreath) {
  for (const auto& [sent_hz, expected_hz] : {std::pair(48'000.0, 16'000.0),
                                             {44'100.0, 48'000.0},
                                             {22'050.0, 16'000.0},
                                             {16'000.0, 48'000.0},
                                             {192'000.0, 8'000.0}}) {
    SCOPED_TRACE(fmt::format("{} as {}", sent_hz, expected_hz));
    Bench bench("mic = \"microphone udp\"\n");
    MicrophoneAdapter microphone(expected_hz);
    SimulatedDeviceOptions options;
    options.rate_hz = sent_hz;
    const auto samples = run_device("microphone", {.breath_bpm = 15.0}, 41.0,
                                    {.jitter_s = 0.02, .loss = 0.02}, microphone, bench, options);
    EXPECT_TRUE(samples.empty());
    EXPECT_EQ(microphone.trouble(),
              fmt::format("it sends {:g} samples a second, not {:g}, the source's rate_hz", sent_hz,
                          expected_hz));
    EXPECT_GT(microphone.counts().unused, microphone.counts().used);
    expect_adds_up(microphone.counts());
  }
}

// A link that stands still for a second, twice a minute, and whose packets come late together.
TEST(MicrophoneAdapter, AStalledLinkIsNotAnotherRate) {
  Bench bench("mic = \"microphone udp\"\n");
  MicrophoneAdapter microphone(16'000.0);
  const auto device = simulated_device("microphone", {});
  std::vector<std::vector<std::byte>> held;
  std::uint64_t breaths = 0;
  for (TimeNs now = 4 * kMillisecond_ns; now < 300 * kSecond_ns; now += 4 * kMillisecond_ns) {
    device->run({.breath_bpm = 15.0}, now,
                [&](std::vector<std::byte> bytes, TimeNs) { held.push_back(std::move(bytes)); });
    if (now % (31 * kSecond_ns) > 30 * kSecond_ns) continue;
    for (const auto& bytes : held) microphone.take(bytes, false, now, bench.out);
    held.clear();
    microphone.tick(now, bench.out);
    breaths += bench.samples().size();
    ASSERT_EQ(microphone.trouble(), "") << now;
  }
  EXPECT_GE(breaths, 29u);
  EXPECT_EQ(microphone.counts().unused, 0u);
}

TEST(MicrophoneAdapter, SoundOfOtherFormsIsToldAndGivesNoBreath) {
  // Two channels, 24 bits, 8 bits under a payload type that is assigned.
  for (const auto& [ratio, words] : {std::pair(2.0, "2.0"), {1.5, "1.5"}, {0.5, "0.5"}}) {
    Bench bench("mic = \"microphone udp\"\n");
    MicrophoneAdapter microphone(16'000.0);
    for (std::uint32_t i = 0; i < 1500; ++i) {
      net::RtpPacket packet{.sequence = static_cast<std::uint16_t>(i), .timestamp = 320 * i};
      packet.samples.assign(static_cast<std::size_t>(320 * ratio), 0.1F);
      microphone.take(net::encode_rtp(packet), false, i * 20 * kMillisecond_ns, bench.out);
    }
    EXPECT_EQ(microphone.trouble(),
              fmt::format("its packets have {} times the samples that their timestamps count; "
                          "used: 16 bits in one channel",
                          words));
    EXPECT_TRUE(bench.samples().empty());
  }
  // Payload types; the reason disappears with the next packet of a known kind.
  struct Case {
    std::uint8_t type;
    double rate_hz;
    const char* trouble;
  };
  for (const Case& one :
       {Case{0, 8'000.0,
             "RTP: found payload type 0; accepted: 11 and 96 to 127, 16 bits in one "
             "channel"},
        {11, 16'000.0,
         "payload type 11 has 44100 samples a second, not 16000, the source's "
         "rate_hz"},
        {11, 44'100.0, ""},
        {96, 16'000.0, ""}}) {
    Bench bench("mic = \"microphone udp\"\n");
    MicrophoneAdapter microphone(one.rate_hz);
    for (std::uint32_t i = 0; i < 100; ++i)
      microphone.take(net::encode_rtp({one.type, static_cast<std::uint16_t>(i), 160 * i, 1,
                                       std::vector<float>(160, 0.1F)}),
                      false, i * 20 * kMillisecond_ns, bench.out);
    EXPECT_EQ(microphone.trouble(), one.trouble);
    EXPECT_EQ(microphone.counts().unused, *one.trouble ? 100u : 0u);
    expect_adds_up(microphone.counts());
  }
}

}  // namespace
}  // namespace neritic::testbed
