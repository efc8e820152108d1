// Devices' bytes as samples: the wire vectors, loss, order, wraps, floods. Suits:
// suit_adapter_test.cpp.
#include "diver/kinematics.hpp"
#include "engine/core/random.hpp"
#include "engine/net/heart_strap.hpp"
#include "engine/net/rough_link.hpp"
#include "testbed/devices/gaze_adapter.hpp"
#include "testbed/devices/jacket_adapter.hpp"
#include "testbed/devices/microphone_adapter.hpp"
#include "testbed/devices/strap_adapter.hpp"
#include "testbed/devices/suit_adapter.hpp"
#include "testbed/simulators/simulated_device.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

using net::bytes_of;

TEST(SceneSources, ALineEachIsReadAndGivesTheGroupsThatNothingElseHas) {
  const TestDive dive =
      dive_of(lab_text("suit = \"mxtp udp 9763\"\nstrap = \"strap bluetooth Polar H10\"\n"
                       "mic = { device = \"microphone udp 0.0.0.0:5004\", rate_hz = 44100 "
                       "}\njacket = \"jacket udp\"\n"));
  ASSERT_EQ(dive.scene.sources.size(), 4u);
  for (const scene::DeviceSource& source : dive.scene.sources) {
    EXPECT_EQ(source.diver, "diver");
    if (source.name == "suit") {
      EXPECT_EQ(to_text(source.address), "udp://127.0.0.1:9763");
    }
    if (source.name == "strap") {
      EXPECT_EQ(source.port, "Polar H10");
    }
    if (source.name == "mic") {
      EXPECT_EQ(to_text(source.address), "udp://0.0.0.0:5004");
      EXPECT_EQ(source.rate_hz, 44100.0);
    }
    if (source.name == "jacket") {
      EXPECT_EQ(source.address.port, net::kJacketPort);
    }
  }
  const DiverInputs& inputs = dive.world->start_inputs().humans()[0];
  for (const DiverGroup group : {DiverGroup::kBody, DiverGroup::kHands, DiverGroup::kButtons,
                                 DiverGroup::kBreath, DiverGroup::kHeart})
    EXPECT_EQ(inputs.of(group).authority, Authority::kLive) << name_of(group);
  EXPECT_EQ(inputs.of(DiverGroup::kGaze).authority, Authority::kAutopilot);
}

TEST(SceneSources, WhatIsNoSourceIsRefusedWithItsLine) {
  for (const char* line :
       {"suit = \"xsens udp 9763\"", "suit = \"mxtp bluetooth x\"", "suit = \"mxtp udp 0\"",
        "suit = \"mxtp udp host:1\"", "suit = \"\"", "suit = 3", "strap = \"strap bluetooth\"",
        "suit = { device = \"mxtp udp\", diver = \"nobody\" }", "autopilot = \"mxtp udp\"",
        "suit = { device = \"mxtp udp\", rate_hz = 8000 }", "suit = { character = 1 }",
        "suit = { device = \"mxtp udp\", characters = 1 }"}) {
    const auto scene = load_text(lab_text(std::string(line) + "\n"));
    ASSERT_FALSE(scene.ok()) << line;
    const std::string& message = scene.error().message;
    EXPECT_TRUE(message.find("accepted: ") != message.npos ||
                message.find("nearest known key: ") != message.npos)
        << message;
    EXPECT_NE(scene.error().message.find("dive.toml:"), std::string::npos)
        << line << scene.error().message;
  }
  EXPECT_FALSE(load_text("[sources]\nsuit = \"mxtp udp\"\n").ok());
  EXPECT_FALSE(load_text("[physics]\n[sources]\nsuit = \"mxtp udp\"\n").ok());
}

// Each number of a packet, by hand from engine/net/README.md.
TEST(GazeAdapter, APacketsBytesAreADirectionAndBadOnesAreCounted) {
  const auto bytes =
      bytes_of(std::string("55475a440101070040420f00000000009a99193f00000000cdcc4cbf4af2"));
  const auto packet = net::decode_gaze(bytes);
  ASSERT_TRUE(packet.ok()) << packet.error().message;
  EXPECT_TRUE(packet->valid);
  EXPECT_EQ(packet->sequence, 7u);
  EXPECT_EQ(packet->time_us, 1'000'000u);
  EXPECT_EQ(packet->direction, Vec3f(0.6F, 0.0F, -0.8F));
  EXPECT_EQ(net::encode_gaze(*packet), bytes);
  Bench bench("gaze = \"gaze udp\"\n");
  GazeAdapter adapter;
  adapter.take(bytes, false, kSecond_ns, bench.out);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto wrong = bytes;
    wrong[i] ^= std::byte{1};
    adapter.take(wrong, false, kSecond_ns, bench.out);
    adapter.take(net::Bytes(bytes).first(i), false, kSecond_ns, bench.out);
  }
  adapter.take(bytes, true, kSecond_ns, bench.out);
  adapter.take(bytes, false, kSecond_ns, bench.out);
  const net::LinkCounts& counts = adapter.counts();
  EXPECT_EQ(counts.used, 1u);
  EXPECT_EQ(counts.repeated, 1u);
  EXPECT_EQ(counts.malformed, 2 * bytes.size() + 1);
  expect_adds_up(counts);
  const auto samples = bench.samples();
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_LT(glm::distance(std::get<Gaze>(samples[0].payload).state.direction, Vec3(0.6, 0.0, -0.8)),
            1e-6);
}

// Numbers wrap, packets are lost, come twice, late and in another order; the capture times are the
// tracker's, on the host's clock.
TEST(GazeAdapter, SamplesKeepTheirOrderAndTheirTimesThroughLossAndJitter) {
  Bench bench("gaze = \"gaze udp\"\n");
  GazeAdapter adapter;
  net::RoughLink link({.jitter_s = 0.004, .loss = 0.05, .repeat = 0.05, .seed = 3});
  constexpr TimeNs kOffset_ns = -7'000'000'000, kStart_ns = 100 * kSecond_ns;
  constexpr int kCount = 70'000;
  std::uint64_t sent = 0;
  TimeNs last_ns = 0;
  double worst_ms = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const TimeNs now = kStart_ns + i * 8 * kMillisecond_ns;
    link.send(now,
              net::encode_gaze({.sequence = static_cast<std::uint16_t>(i),
                                .time_us = static_cast<std::uint64_t>((now + kOffset_ns) / 1000)}));
    ++sent;
    while (!link.empty() && link.next().due_ns <= now) {
      const auto packet = link.take_next();
      adapter.take(packet.bytes, false, packet.due_ns, bench.out);
    }
    for (const Sample& sample : bench.samples()) {
      const TimeNs captured_ns = sample.header.captured_ns;
      EXPECT_GE(captured_ns, last_ns);
      last_ns = captured_ns;
      const TimeNs off_ns =
          (captured_ns - kStart_ns + 4 * kMillisecond_ns) % (8 * kMillisecond_ns) -
          4 * kMillisecond_ns;
      if (i > kCount / 2)
        worst_ms = std::max(worst_ms, std::abs(1e-6 * static_cast<double>(off_ns)));
    }
  }
  const net::LinkCounts& counts = adapter.counts();
  expect_adds_up(counts);
  EXPECT_EQ(counts.malformed, 0u);
  EXPECT_EQ(counts.older, 0u);
  EXPECT_NEAR(static_cast<double>(counts.lost) / static_cast<double>(sent), 0.05, 0.01);
  EXPECT_NEAR(static_cast<double>(counts.repeated) / static_cast<double>(sent), 0.05, 0.01);
  EXPECT_LT(worst_ms, 1.0);
}

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

// A simulator's packets over a link, at 60 bpm and more; the newest sample.
template <class Adapter>
std::vector<Sample> run_device(const char* kind, const PersonActs& acts, double seconds,
                               const net::LinkFaults& faults, Adapter& adapter, Bench& bench,
                               const SimulatedDeviceOptions& options = {}) {
  const auto device = simulated_device(kind, options);
  net::RoughLink link(faults);
  std::vector<Sample> out;
  for (TimeNs now = 4 * kMillisecond_ns; now < static_cast<TimeNs>(seconds * 1e9);
       now += 4 * kMillisecond_ns) {
    device->run(acts, now,
                [&](std::vector<std::byte> bytes, TimeNs at) { link.send(at, std::move(bytes)); });
    while (!link.empty() && link.next().due_ns <= now) {
      const auto packet = link.take_next();
      adapter.take(packet.bytes, false, packet.due_ns, bench.out);
    }
    adapter.tick(now, bench.out);
    for (const Sample& sample : bench.samples()) out.push_back(sample);
  }
  return out;
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

TEST(JacketAdapter, AllFormsPress) {
  Bench bench("jacket = \"jacket udp\"\n");
  JacketAdapter jacket;
  const auto all = net::wire_vectors();
  std::vector<std::uint64_t> pressed;
  TimeNs now = kSecond_ns;
  for (const auto& vector : all["jacket"]["compat_vectors"]) {
    jacket.take(bytes_of(vector), false, now += kMillisecond_ns, bench.out);
    for (const Sample& sample : bench.samples())
      pressed.push_back(std::get<JacketButtons>(sample.payload).pressed);
  }
  EXPECT_EQ(pressed, (std::vector<std::uint64_t>{1, 5, 1}));
  EXPECT_EQ(jacket.counts().malformed, 1u);
  jacket.take(bytes_of(all["jacket"]["vectors"][0]), false, now += kMillisecond_ns, bench.out);
  EXPECT_EQ(std::get<JacketButtons>(bench.samples().at(0).payload).pressed, diver::kInflate);
}

TEST(JacketAdapter, LossAndJitterChangeNoGas) {
  for (const double loss : {0.0, 0.02, 0.5}) {
    Bench bench("jacket = \"jacket udp\"\n");
    JacketAdapter jacket;
    const auto device = simulated_device("jacket", {});
    net::RoughLink link({.jitter_s = 0.02, .loss = loss, .seed = 3});
    PersonActs acts;
    TimeNs pressed_ns = 0, given_ns = 0;
    std::uint64_t given = 0;
    constexpr TimeNs kTick = 2 * kMillisecond_ns;
    for (TimeNs now = kTick; now < 60 * kSecond_ns; now += kTick) {
      // Presses of 60 ms to 0.46 s, one a second.
      const TimeNs second = now / kSecond_ns, within = now % kSecond_ns;
      acts.buttons =
          second % 2 == 0 && second < 58 && within < (60 + 10 * (second % 40)) * kMillisecond_ns
              ? diver::kInflate
              : 0;
      if (acts.buttons != 0) pressed_ns += kTick;
      device->run(acts, now, [&](std::vector<std::byte> bytes, TimeNs at) {
        link.send(at, std::move(bytes));
      });
      while (!link.empty() && link.next().due_ns <= now)
        jacket.take(link.take_next().bytes, false, now, bench.out);
      jacket.tick(now, bench.out);
      for (const Sample& sample : bench.samples())
        given = std::get<JacketButtons>(sample.payload).pressed;
      if (given != 0) given_ns += kTick;
    }
    EXPECT_NEAR(to_ms(given_ns), to_ms(pressed_ns), 0.03 * to_ms(pressed_ns)) << loss;
    expect_adds_up(jacket.counts());
  }
}

// Counters that leap by more than the time that went by press nothing: neither those of a packet
// whose bits are wrong, nor those of a jacket that was started again.
TEST(JacketAdapter, CountersThatLeapPressNothing) {
  Bench bench("jacket = \"jacket udp\"\n");
  JacketAdapter jacket;
  std::uint64_t pressed = 0;
  TimeNs now = kSecond_ns;
  std::uint16_t sequence = 0;
  const auto run = [&](int packets, std::uint16_t inflate_ms, TimeNs device_ns = 0) {
    TimeNs given_ns = 0;
    for (int i = 0; i < packets; ++i) {
      now += 20 * kMillisecond_ns;
      net::UbcdCounters counters{.sequence = sequence++,
                                 .time_us = static_cast<std::uint64_t>((now + device_ns) / 1000)};
      counters.pressed_ms = {inflate_ms, 0, 0};
      jacket.take(net::encode_jacket({{}, counters}), false, now, bench.out);
      for (int ms = 0; ms < 20; ++ms) {
        jacket.tick(now + ms * kMillisecond_ns, bench.out);
        for (const Sample& sample : bench.samples())
          pressed = std::get<JacketButtons>(sample.payload).pressed;
        if (pressed != 0) given_ns += kMillisecond_ns;
      }
    }
    return to_ms(given_ns);
  };
  EXPECT_EQ(run(50, 65'500), 0.0);
  EXPECT_EQ(run(50, 59'964), 0.0);  // 60 s in 20 ms, for good
  EXPECT_EQ(jacket.counts().malformed, 1u);
  EXPECT_EQ(run(1, 400), 0.0);  // a packet with a wrong counter
  EXPECT_EQ(run(50, 59'964), 0.0);
  EXPECT_EQ(run(50, 60'264), 0.0);  // 300 ms in 20 ms
  EXPECT_EQ(run(50, 65'530), 0.0);
  EXPECT_EQ(run(50, 4, -now), 0.0);  // its clock, too, begins again
  EXPECT_EQ(jacket.counts().malformed, 4u);
  // A press over a wrap whose packets were lost is made up for.
  (void)run(2, 65'530);
  sequence = static_cast<std::uint16_t>(sequence + 10);
  now += 200 * kMillisecond_ns;
  EXPECT_NEAR(run(50, 144), 150.0, 10.0);
  expect_adds_up(jacket.counts());
}

// Two jackets at one port, whose numbers and counters have nothing to do with each other: the first
// one presses, the other is told. When the first falls silent, the other one presses.
TEST(JacketAdapter, OfTwoAtOnePortTheFirstPressesAndTheOtherIsTold) {
  Bench bench("jacket = \"jacket udp\"\n");
  JacketAdapter jacket;
  TimeNs now = kSecond_ns;
  std::uint16_t sequence = 0;
  std::vector<std::uint64_t> pressed;
  const auto run = [&](int packets, std::initializer_list<std::uint8_t> devices) {
    for (int i = 0; i < packets; ++i, now += 20 * kMillisecond_ns, ++sequence)
      for (const std::uint8_t device : devices) {
        net::UbcdCounters counters{
            .device = device,
            .sequence = static_cast<std::uint16_t>(sequence + 300 * device),
            .time_us = static_cast<std::uint64_t>(now / 1000) + 1'000'000 * device};
        const auto ms = static_cast<std::uint16_t>(7000 * device + 20 * sequence);
        counters.pressed_ms = {static_cast<std::uint16_t>(device == 1 ? ms : 0), 0,
                               static_cast<std::uint16_t>(device == 2 ? ms : 0)};
        jacket.take(net::encode_jacket({{device == 1, false, device == 2}, counters}), false, now,
                    bench.out);
        for (const Sample& sample : bench.samples())
          pressed.push_back(std::get<JacketButtons>(sample.payload).pressed);
      }
  };
  run(100, {1, 2});
  EXPECT_EQ(pressed, std::vector<std::uint64_t>(100, diver::kInflate));
  EXPECT_EQ(jacket.counts().unused, 100u);
  EXPECT_EQ(jacket.counts().malformed + jacket.counts().older + jacket.counts().lost, 0u);
  EXPECT_EQ(jacket.trouble(), "jacket 2 sends here too and is not used: one jacket a port");
  run(60, {1});  // the other one went
  EXPECT_EQ(jacket.trouble(), "");
  pressed.clear();
  run(100, {2});
  EXPECT_EQ(pressed, std::vector<std::uint64_t>(51, diver::kDump));
  EXPECT_EQ(jacket.trouble(), "");
  EXPECT_EQ(jacket.counts().restarts, 1u);
  EXPECT_EQ(jacket.counts().malformed + jacket.counts().lost, 0u);
  expect_adds_up(jacket.counts());
}

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

// Packets of each device, out of order, repeated, cut, with wrong bits, and random ones: all are
// counted once, and what comes out is what the inbox takes. A million and a half where the test is
// thorough.
TEST(Adapters, BadPacketsWithoutNumberCrashNothingAndCountsAddUp) {
  for (const auto& [kind, by] : {std::pair<std::string, std::string>("mxtp", "udp"),
                                 {"mxtp", "tcp"},
                                 {"strap", "udp"},
                                 {"jacket", "udp"},
                                 {"microphone", "udp"},
                                 {"gaze", "udp"}}) {
    SCOPED_TRACE(kind + " " + by);
    Bench bench(fmt::format("it = \"{} {}\"\n", kind, by));
    std::unique_ptr<DeviceAdapter> adapter;
    if (kind == "mxtp") adapter = std::make_unique<SuitAdapter>(0, by == "tcp");
    if (kind == "strap") adapter = std::make_unique<StrapAdapter>();
    if (kind == "gaze") adapter = std::make_unique<GazeAdapter>();
    if (kind == "jacket") adapter = std::make_unique<JacketAdapter>();
    if (kind == "microphone") adapter = std::make_unique<MicrophoneAdapter>(16'000.0);
    SimulatedDeviceOptions options;
    options.rate_hz = kind == "mxtp" ? 1000.0 : 0.0;
    const auto device = simulated_device(kind, options);
    std::vector<std::vector<std::byte>> good;
    for (TimeNs now = kMillisecond_ns; good.size() < 500; now += kMillisecond_ns)
      device->run({}, now,
                  [&](std::vector<std::byte> bytes, TimeNs) { good.push_back(std::move(bytes)); });
    const std::uint64_t count = !test::kFast ? 5'000 : test::is_thorough() ? 250'000 : 50'000;
    for (std::uint64_t i = 0; i < count; ++i) {
      const RandomKey key{7, 1, i};
      std::vector<std::byte> bytes = good[random_bits(key, 0) % good.size()];
      const double kindness = random_uniform(key, 1);
      if (kindness < 0.2) bytes.resize(random_bits(key, 2) % (bytes.size() + 1));
      if (kindness > 0.5)
        for (std::uint64_t k = 0; k < 1 + random_bits(key, 3) % 4 && !bytes.empty(); ++k)
          bytes[random_bits(key, 4 + k) % bytes.size()] =
              static_cast<std::byte>(random_bits(key, 9 + k));
      const auto now = static_cast<TimeNs>(i) * 10'000;
      adapter->take(bytes, random_uniform(key, 20) < 0.01, now, bench.out);
      adapter->tick(now, bench.out);
      if (i % 1000 != 0) continue;
      for (const Sample& sample : bench.samples()) {
        ASSERT_TRUE(all_finite(sample.payload) && plausible(sample.payload));
      }
    }
    if (by == "udp") {
      EXPECT_EQ(adapter->counts().datagrams, count);
    }
    expect_adds_up(adapter->counts());
    EXPECT_GT(adapter->counts().malformed, 0u);
    EXPECT_GT(adapter->counts().used, 0u);
    EXPECT_EQ(bench.out.sent(),
              bench.out.accepted() + bench.dive.simulation->inbox().counts(bench.source).refused());
  }
}

}  // namespace
}  // namespace neritic::testbed
