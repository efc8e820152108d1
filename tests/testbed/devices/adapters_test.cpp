// Devices' bytes as samples: the wire vectors, loss, order, wraps, floods. Suits, straps and
// microphones have files of their own.
#include "diver/kinematics.hpp"
#include "engine/core/random.hpp"
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
