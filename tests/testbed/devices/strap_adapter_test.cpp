// A heart strap's bytes as samples: rates, intervals, ECG, loss.
#include "testbed/devices/strap_adapter.hpp"

#include <random>

#include "engine/core/random.hpp"
#include "engine/net/heart_strap.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

using net::bytes_of;

TEST(StrapAdapter, IntervalsThatEndGiveWayToTheRate) {
  Bench bench("strap = \"strap udp\"\n");
  StrapAdapter strap;
  TimeNs now = kSecond_ns;
  const auto heart = [&](const char* hex) {
    now += kSecond_ns;
    strap.take(bytes_of(std::string(hex)), false, now, bench.out);
    return std::get<Heart>(bench.samples().back().payload).state;
  };
  for (int i = 0; i < 12; ++i) (void)heart("103C0004");
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(heart("0096").rate_bpm, 60.0, 1e-9) << i;
  const double before_s = heart("0096").time_s;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(heart("0097").rate_bpm, 151.0) << i;
  const diver::HeartState after = heart("0096");
  EXPECT_EQ(after.quality, diver::SignalQuality::kGood);
  EXPECT_NEAR(after.time_s, before_s + 21.0, 1e-6);
  // Intervals again: no beat is counted across the gap.
  diver::HeartState again;
  for (int i = 0; i < 12; ++i) again = heart("103C0004");
  EXPECT_NEAR(again.rate_bpm, 60.0, 1e-9);
  EXPECT_NEAR(again.time_s, after.time_s + 12.0, 1.1);
  EXPECT_EQ(again.gaps, 1u);
}

// One of three packets is lost, each by itself, and the others come up to 60 ms early or late.
TEST(StrapAdapter, EachLostPacketIsCountedAndIsAGapOfTheBeats) {
  Bench bench("strap = \"strap udp\"\n");
  StrapAdapter strap;
  std::uint64_t lost = 0;
  diver::HeartState last;
  for (int i = 0; i < 300; ++i) {
    if (i % 3 == 1) {
      ++lost;
      continue;
    }
    const double off_s = 0.12 * (random_uniform({5, 6, static_cast<std::uint64_t>(i)}, 0) - 0.5);
    strap.take(bytes_of(std::string("103C0004")), false,
               static_cast<TimeNs>(1e9 * (10.0 + i + off_s)), bench.out);
    for (const Sample& sample : bench.samples()) last = std::get<Heart>(sample.payload).state;
  }
  EXPECT_EQ(strap.counts().lost, lost);
  EXPECT_EQ(last.gaps, lost);
  EXPECT_NEAR(last.time_s, 300.0, 3.0);
  expect_adds_up(strap.counts());
}

TEST(StrapAdapter, RatesOfNoHeartAreMalformed) {
  Bench bench("strap = \"strap udp\"\n");
  StrapAdapter strap;
  TimeNs now = kSecond_ns;
  for (const char* hex : {"01FFFF", "012D01", "0013", "0001", "11FFFF0004"})
    strap.take(bytes_of(std::string(hex)), false, now += kSecond_ns, bench.out);
  EXPECT_EQ(strap.counts().malformed, 5u);
  EXPECT_TRUE(bench.samples().empty());
  for (const char* hex : {"012C01", "0014", "0000"})
    strap.take(bytes_of(std::string(hex)), false, now += kSecond_ns, bench.out);
  EXPECT_EQ(bench.samples().size(), 3u);
  expect_adds_up(strap.counts());
}

TEST(StrapAdapter, VectorsGiveRatesAndAStrapThatIsOffIsAGapNotASlowHeart) {
  Bench bench("strap = \"strap udp\"\n");
  StrapAdapter strap;
  TimeNs now = kSecond_ns;
  const auto rate = [&](const char* hex) {
    now += kSecond_ns;
    strap.take(bytes_of(std::string(hex)), false, now, bench.out);
    const auto samples = bench.samples();
    return samples.empty() ? -1.0 : std::get<Heart>(samples.back().payload).state.rate_bpm;
  };
  EXPECT_EQ(rate("003C"), 60.0);  // the rate alone
  EXPECT_EQ(rate("104800"), -1.0);
  for (int i = 0; i < 12; ++i) (void)rate("10480004");  // intervals of 1 s
  EXPECT_NEAR(rate("10480004"), 60.0, 1e-9);
  EXPECT_EQ(rate("0400"), 0.0);
  EXPECT_EQ(strap.counts().malformed, 1u);
  strap.take(bytes_of(std::string("0400")), false, now + kSecond_ns / 10, bench.out);
  EXPECT_EQ(strap.counts().repeated, 1u);
  now += 9 * kSecond_ns;
  (void)rate("10480004");
  EXPECT_EQ(strap.counts().lost, 10u);  // one in place of the malformed one
  expect_adds_up(strap.counts());
}

TEST(StrapAdapter, AnEcgOverALossyLinkGivesTheHeartsRate) {
  for (const double bpm : {52.0, 80.0, 140.0}) {
    Bench bench("strap = \"strap udp\"\n");
    StrapAdapter strap;
    const auto samples = run_device("strap", {.heart_bpm = bpm}, 40.0,
                                    {.jitter_s = 0.02, .loss = 0.02}, strap, bench);
    ASSERT_FALSE(samples.empty());
    EXPECT_NEAR(std::get<Heart>(samples.back().payload).state.rate_bpm, bpm, 0.04 * bpm);
    EXPECT_GT(strap.counts().unused, 20u);  // its own rate, while there is an ECG
    expect_adds_up(strap.counts());
  }
}

// Each packet as it came, at its first sample's time: together the whole signal but for what was
// lost.
TEST(StrapAdapter, ItsEcgIsGivenToWhoeverRecordsIt) {
  Bench bench("strap = \"strap udp\"\n");
  StrapAdapter strap;
  SignalQueue queue;
  strap.give_signal_to(&queue);
  queue.want(true);
  (void)run_device("strap", {.heart_bpm = 70.0}, 20.0, {.jitter_s = 0.02}, strap, bench);
  const auto packets = queue.take();
  ASSERT_GT(packets.size(), 30u);
  std::size_t samples = 0;
  float largest_uv = 0.0F;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const SignalPacket& packet = packets[i];
    EXPECT_NEAR(packet.rate_hz, net::kEcg_hz, 0.5);
    // The next begins a sample after this one ends, as well as the clock is known.
    if (i > packets.size() / 2 && i + 1 < packets.size()) {
      EXPECT_NEAR(1e-9 * static_cast<double>(packets[i + 1].captured_ns - packet.captured_ns),
                  static_cast<double>(packet.samples.size()) / packet.rate_hz, 0.01);
    }
    samples += packet.samples.size();
    for (const float value : packet.samples) largest_uv = std::max(largest_uv, value);
  }
  EXPECT_NEAR(static_cast<double>(samples) / net::kEcg_hz, 20.0, 1.5);
  EXPECT_GT(largest_uv, 300.0F);  // an R wave
}

// A heart that beats each 0.8 s, at a strap whose samples come at a rate of its own: frames of 73,
// the time of each that of its last sample, which jitters where a computer says it. Samples by the
// nominal rate would be off by 0.12 % and more. Some frames are lost.
TEST(StrapAdapter, AnEcgKeepsTheTimeOfItsStrap) {
  constexpr std::size_t kFrame = 73;
  constexpr double kBeat_s = 0.8;
  for (const auto& [rate_hz, jitter_s, loss] : {std::tuple(130.16, 0.0, 0.0),
                                                {130.16, 0.0, 0.05},
                                                {127.0, 0.0, 0.05},
                                                {130.3, 2e-3, 0.0}}) {
    Bench bench("strap = \"strap udp\"\n");
    StrapAdapter strap;
    net::EcgFrame frame;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    double worst_bpm = 0.0, worst_s = 0.0, first_off_s = 0.0;
    std::size_t lost = 0, heard = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(180.0 * rate_hz); ++i) {
      const double t_s = static_cast<double>(i) / rate_hz;
      const double to_beat_s = std::remainder(t_s - 0.4, kBeat_s);
      frame.samples_uv.push_back(static_cast<std::int32_t>(
          1000.0 * std::exp(-0.5 * std::pow(to_beat_s / 0.015, 2)) + 10.0 * any(random)));
      if (frame.samples_uv.size() < kFrame) continue;
      frame.time_ns = static_cast<std::uint64_t>(
          std::llround(1e9 * (1000.0 + t_s + jitter_s * (any(random) - 0.5))));
      if (any(random) >= loss)
        strap.take(net::encode_ecg(frame), false, static_cast<TimeNs>(1e9 * (2000.0 + t_s)),
                   bench.out);
      else
        ++lost;
      frame.samples_uv.clear();
      for (const Sample& sample : bench.samples()) {
        const diver::HeartState& heart = std::get<Heart>(sample.payload).state;
        const double off_s = heart.time_s - t_s;
        if (t_s < 60.0) {
          first_off_s = off_s;
          continue;
        }
        worst_s = std::max(worst_s, std::abs(off_s - first_off_s));
        if (heart.rate_bpm == 0.0) continue;  // after a gap
        ++heard;
        worst_bpm = std::max(worst_bpm, std::abs(heart.rate_bpm - 60.0 / kBeat_s));
      }
    }
    EXPECT_GT(heard, 150u) << rate_hz;
    EXPECT_LT(worst_bpm, jitter_s > 0.0 || rate_hz < 128.0 ? 0.1 : 0.04)
        << rate_hz << " Hz, loss " << loss;
    EXPECT_LT(worst_s, 0.005) << rate_hz << " Hz, loss " << loss;
    EXPECT_EQ(strap.counts().lost > 0, lost > 0);
  }
}

}  // namespace
}  // namespace neritic::testbed
