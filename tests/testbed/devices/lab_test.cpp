// A whole dive over real sockets: a person who wears simulated devices, with loss and jitter.
#include "testbed/simulators/lab.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include "engine/net/gaze_wire.hpp"
#include "testbed/record/run_record.hpp"
#include "tests/testbed/devices/lab_scene.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

// Tests run beside each other: each takes ports that nobody has.
std::string sources() {
  std::vector<net::UdpReceiver> taken;  // until all are found, so that they differ
  const auto port = [&] {
    taken.push_back(net::UdpReceiver::bind({.transport = Transport::kUdp, .port = 0}).value());
    return taken.back().port();
  };
  return fmt::format(
      "suit = \"mxtp udp {}\"\nstrap = \"strap udp {}\"\njacket = \"jacket udp {}\"\n"
      "microphone = \"microphone udp {}\"\ngaze = \"gaze udp {}\"\n",
      port(), port(), port(), port(), port());
}

struct Lab {
  explicit Lab(const net::LinkFaults& faults, const std::string& text = sources())
      : dive(dive_of(lab_text(text))) {
    auto opened = Devices::open(dive.scene, *dive.world, dive.simulation->inbox(),
                                DeviceSource::Pace::kPolled);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    devices = std::move(opened).value();
    LabOptions options;
    options.faults = faults;
    auto made = SimulatedLab::create(
        dive.scene, *dive.world, devices.get(),
        [this](std::size_t diver) -> const HumanPhysics& { return dive.state().humans()[diver]; },
        options);
    EXPECT_TRUE(made.ok()) << made.error().message;
    lab = std::move(made).value();
  }
  void run(double seconds) {
    for (const double end = dive.time_s() + seconds - 1e-9; dive.time_s() < end;) {
      ASSERT_TRUE(lab->poll(dive.simulation->inbox(), dive.time_s()).ok());
      dive.simulation->advance(1);
    }
  }
  const GroupState& group(DiverGroup group) const {
    return dive.state().humans()[0].groups[static_cast<std::size_t>(group)];
  }
  TestDive dive;
  std::unique_ptr<Devices> devices;
  std::unique_ptr<SimulatedLab> lab;
};

TEST(SimulatedLab, AWholeDiveWorksOverALossyNetworkAndReplaysToTheSameHashes) {
  Lab lab({.jitter_s = 0.02, .loss = 0.02});
  lab.run(test::kFast ? 75.0 : 5.0);
  for (const DiverGroup group : {DiverGroup::kBody, DiverGroup::kHands, DiverGroup::kButtons,
                                 DiverGroup::kHeart, DiverGroup::kGaze}) {
    EXPECT_EQ(lab.group(group).phase, GroupPhase::kLive) << name_of(group);
    EXPECT_EQ(lab.group(group).losses, 0u) << name_of(group);
  }
  const HumanPhysics& diver = lab.dive.state().humans()[0];
  if (test::kFast) {
    EXPECT_EQ(lab.group(DiverGroup::kBreath).phase, GroupPhase::kLive);
    // He swims north along his line, at its depth.
    EXPECT_GT(diver.human.root.position_ned_m.x, 20.0);
    EXPECT_NEAR(diver.human.root.position_ned_m.y, 0.0, 1.5);
    EXPECT_NEAR(diver.human.root.position_ned_m.z, 12.0, 1.5);
    EXPECT_NEAR(diver.human.life.vitals.heart_bpm, lab.lab->acts(0).heart_bpm, 6.0);
    for (const ClockError& error : lab.lab->clock_errors()) {
      EXPECT_TRUE(error.has_clock) << error.name;
      EXPECT_LT(std::abs(error.now_ms), 1.0) << error.name;
    }
  }
  std::uint64_t received = 0;
  for (const auto& device : lab.devices->all()) received += device->clock_map().estimate().known;
  EXPECT_EQ(received, 5u);
  // He looks around his course, and the tracker follows his eyes.
  const diver::GazeState& gaze = lab.dive.simulation->inputs().humans()[0].gaze.state;
  EXPECT_GT(gaze.fixations, 3u);
  EXPECT_GT(gaze.saccades, 3u);
  EXPECT_GT(gaze.direction.z, -1.01);
  EXPECT_LT(gaze.direction.z, -0.8);
  const SampleLog log = recorded_run(*lab.dive.world, *lab.dive.simulation);
  const auto again = replay_run(*lab.dive.world, log, "lab");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_FALSE(again->first_difference.has_value());
}

TEST(SimulatedLab, TheSameSeedGivesTheSameDiveOverSockets) {
  const auto run = [](std::uint64_t seed) {
    Lab lab({.jitter_s = 0.02, .loss = 0.05, .repeat = 0.02, .corrupt = 0.02, .seed = seed});
    lab.run(3.0);
    return lab.dive.simulation->newest().hash;
  };
  const std::uint64_t first = run(1);
  EXPECT_EQ(first, run(1));
  EXPECT_NE(first, run(2));
}

TEST(SimulatedLab, ASuitByTcpSwimsTheSame) {
  Lab lab({}, "suit = \"mxtp tcp 39767\"\n");
  lab.run(3.0);
  EXPECT_EQ(lab.group(DiverGroup::kBody).phase, GroupPhase::kLive);
  EXPECT_GT(lab.group(DiverGroup::kBody).heard, 600u);
}

// The dive that hears the suit is begun anew meanwhile.
TEST(SimulatedLab, ASuitByTcpConnectsAgainAfterItsStreamBroke) {
  const TestDive dive = dive_of(lab_text("suit = \"mxtp tcp 39772\"\n"));
  const Address& at = dive.scene.sources.at(0).address;
  const auto listen = [&] {
    return net::TcpReceiver::open(at, net::TcpReceiver::Way::kListen).value();
  };
  std::optional<net::TcpReceiver> receiver(listen());
  const auto lab = SimulatedLab::create(dive.scene, *dive.world, nullptr,
                                        [&](std::size_t diver) -> const HumanPhysics& {
                                          return dive.state().humans()[diver];
                                        },
                                        {})
                       .value();
  const auto heard_within = [&](double seconds) {
    bool heard = false;
    const TimeNs begun_ns = now_ns();
    for (double t_s = 0.0; t_s < seconds && !heard;
         t_s = 1e-9 * static_cast<double>(now_ns() - begun_ns)) {
      EXPECT_TRUE(lab->poll(dive.simulation->inbox(), 1e-9 * static_cast<double>(now_ns())).ok());
      receiver->receive([&](net::Bytes bytes, bool) { heard = heard || !bytes.empty(); });
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    return heard;
  };
  ASSERT_TRUE(heard_within(2.0));
  receiver.reset();
  receiver = listen();
  EXPECT_TRUE(heard_within(5.0));
}

TEST(DeviceSource, ASecondSuitAtOnePortOfTcpIsTold) {
  TestDive dive = dive_of(lab_text("suit = \"mxtp tcp 39773\"\n"));
  const auto devices =
      Devices::open(dive.scene, *dive.world, dive.simulation->inbox(), DeviceSource::Pace::kThread)
          .value();
  const Address& at = dive.scene.sources.at(0).address;
  auto first = net::TcpSender::connect(at).value();
  const std::vector<std::byte> bytes(10);
  const auto trouble_becomes = [&](std::string_view wanted) {
    for (int i = 0; i < 500 && devices->health()[0].trouble != wanted; ++i) {
      ASSERT_TRUE(first.send(bytes));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(devices->health()[0].trouble, wanted);
  };
  trouble_becomes("");
  {
    const auto second = net::TcpSender::connect(at).value();
    trouble_becomes(
        "a second sender, at 127.0.0.1, waits until the first one is silent for a second");
  }
  trouble_becomes("");
}

// Gaze has no number of its device. Garbage of a third address chooses no sender.
TEST(DeviceSource, OfTwoAddressesAtOnePortTheFirstIsUsedAndTheOtherIsTold) {
  TestDive dive = dive_of(lab_text("gaze = \"gaze udp 39774\"\n"));
  const auto devices =
      Devices::open(dive.scene, *dive.world, dive.simulation->inbox(), DeviceSource::Pace::kPolled)
          .value();
  const auto from = [](std::uint32_t ipv4) {
    net::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(ipv4);
    EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
    at.sin_addr.s_addr = htonl(0x7f000001);
    at.sin_port = htons(39774);
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
    return socket;
  };
  const net::Descriptor first = from(0x7f000001), second = from(0x7f000002),
                        third = from(0x7f000003);
  double time_s = 10.0;
  const auto run = [&](bool with_first) {
    for (std::uint16_t i = 0; i < 150; ++i) {
      time_s += 0.01;
      const auto stamp_us = static_cast<std::uint64_t>(std::llround(time_s * 1e6));
      const auto number = static_cast<std::uint16_t>(std::lround(time_s * 100.0));
      const auto mine = net::encode_gaze({.sequence = number, .time_us = stamp_us});
      const auto other = net::encode_gaze(
          {.sequence = static_cast<std::uint16_t>(number + 500), .time_us = stamp_us + 77'000'000});
      EXPECT_EQ(::send(third.get(), "garbage", 7, 0), 7);
      if (with_first) {
        EXPECT_EQ(::send(first.get(), mine.data(), mine.size(), 0), std::ssize(mine));
      }
      EXPECT_EQ(::send(second.get(), other.data(), other.size(), 0), std::ssize(other));
      EXPECT_TRUE(devices->all()[0]->poll(dive.simulation->inbox(), time_s).ok());
    }
    return devices->health()[0];
  };
  DeviceHealth health = run(true);
  EXPECT_GT(health.link.used, 90u);
  EXPECT_EQ(health.link.lost + health.link.older + health.link.repeated, 0u);
  EXPECT_GT(health.link.strangers, 180u);
  EXPECT_EQ(health.clock.jumps, 0u);
  EXPECT_TRUE(health.trouble.starts_with("127.0.0.")) << health.trouble;
  EXPECT_TRUE(health.trouble.ends_with(" sends here too and is not used: one sender a port"));
  const std::uint64_t used = health.link.used;
  (void)run(false);
  health = run(false);
  EXPECT_GT(health.link.used, used + 100);
}

TEST(DeviceSource, ASourceThatDiesIsLostAndTheAutopilotSwims) {
  Lab lab({}, "suit = \"mxtp udp 39768\"\n");
  lab.run(1.0);
  EXPECT_EQ(lab.group(DiverGroup::kBody).phase, GroupPhase::kLive);
  lab.dive.run(1.0);
  EXPECT_EQ(lab.group(DiverGroup::kBody).phase, GroupPhase::kLost);
  EXPECT_EQ(acting(lab.group(DiverGroup::kBody)), Authority::kAutopilot);
}

TEST(DeviceSource, APortThatIsTakenIsRefusedInOneLineWithTheSourcesName) {
  TestDive dive = dive_of(lab_text("suit = \"mxtp udp 39769\"\njacket = \"jacket udp 39769\"\n"));
  const auto opened =
      Devices::open(dive.scene, *dive.world, dive.simulation->inbox(), DeviceSource::Pace::kPolled);
  ASSERT_FALSE(opened.ok());
  EXPECT_TRUE(opened.error().message.starts_with("source suit: udp://127.0.0.1:39769: ") ||
              opened.error().message.starts_with("source jacket: udp://127.0.0.1:39769: "))
      << opened.error().message;
}

// With a thread of its own, beside a simulation on another.
TEST(DeviceSource, AThreadDeliversWhileTheSimulationSteps) {
  TestDive dive = dive_of(lab_text("jacket = \"jacket udp 39770\"\n"));
  auto devices =
      Devices::open(dive.scene, *dive.world, dive.simulation->inbox(), DeviceSource::Pace::kThread);
  ASSERT_TRUE(devices.ok()) << devices.error().message;
  const auto sender = net::UdpSender::create({.transport = Transport::kUdp, .port = 39770}).value();
  sim::HostClock clock;
  dive.simulation->start(clock);
  const std::vector<std::byte> pressed{std::byte{1}, std::byte{0}, std::byte{0}};
  bool live = false;
  auto reader = dive.simulation->reader();
  for (int i = 0; i < 500 && !live; ++i) {
    ASSERT_TRUE(sender.send(pressed));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    reader.update();
    live = reader.newest().state.humans()[0].human.held.buttons == diver::kInflate;
  }
  dive.simulation->stop();
  EXPECT_TRUE(live);
  const DeviceHealth health = (*devices)->health()[0];
  EXPECT_GT(health.link.used, 0u);
  EXPECT_NE(health_words(health, now_ns()).find("no clock in its packets"), std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
