// `neritic dive --headless --realtime --record`: what a device sent and what the scene's own
// sensors read is stamped by one clock, the scene's.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "engine/net/mxtp.hpp"
#include "engine/net/socket.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

class DeviceStamps : public DivePhysics {
 protected:
  // The header's stamps of a topic, s.
  std::vector<double> stamps(const std::string& topic) {
    const auto columns = table("tables/" + topic + ".csv");
    const auto seconds = columns.find("header_stamp_sec"),
               ns = columns.find("header_stamp_nanosec");
    if (seconds == columns.end() || ns == columns.end()) return {};
    std::vector<double> out;
    for (std::size_t i = 0; i < seconds->second.size(); ++i)
      out.push_back(std::stod(seconds->second[i]) + 1e-9 * std::stod(ns->second[i]));
    return out;
  }
};

TEST_F(DeviceStamps, OfARunByTheHostsClockAreTheScenesAsThoseOfReadings) {
  const std::uint16_t port =
      net::UdpReceiver::bind({.transport = Transport::kUdp, .port = 0}).value().port();
  const std::string assets = (test::source_dir() / "assets").string();
  ASSERT_TRUE(write_text(scratch_ / "lab.toml",
                         "include = \"dive.toml\"\n[[objects]]\nname = \"diver\"\nclass = "
                         "\"diver\"\nmodel = \"" +
                             assets + "/models/diver.glb\"\nhuman = \"" + assets +
                             "/divers/recreational.toml\"\nposition_m = [4, -6, 0]\n[sources]\n" +
                             fmt::format("jacket = \"jacket udp {}\"\n", port))
                  .ok());
  std::atomic<bool> stop{false};
  std::thread sending([&] {
    const auto sender =
        net::UdpSender::create({.transport = Transport::kUdp, .port = port}).value();
    const std::vector<std::byte> pressed{std::byte{1}, std::byte{0}, std::byte{0}};
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(10)))
      (void)sender.send(pressed);
  });
  constexpr double kSeconds = 1.0;
  const Outcome outcome =
      dive(fmt::format("--headless --realtime --seconds {} --record {}", kSeconds, file("a.mcap")),
           "lab.toml");
  stop = true;
  sending.join();
  ASSERT_LE(outcome.status, 1) << outcome.err;  // 1: the mission is not finished
  const std::string exported = fmt::format("'{}/tools/neritic' -q recording export {} --out {}",
                                           NERITIC_BINARY_DIR, file("a.mcap"), file("tables"));
  ASSERT_EQ(std::system(exported.c_str()), 0);
  for (const char* topic : {"diver_buttons", "diver_motion"}) {
    const auto all = stamps(topic);
    ASSERT_GE(all.size(), 5u) << topic;
    // A device may have sent half a second before the run began; a busy machine's last step is
    // late.
    const auto [first, last] = std::ranges::minmax(all);
    EXPECT_GE(first, -0.5) << topic;
    EXPECT_LE(last, kSeconds + 1.0) << topic;
  }
}

// A suit that sends but a part of the body moves nobody, and is noted once.
TEST_F(DeviceStamps, ASuitWithoutAWholeBodyIsNotedOnce) {
  const std::uint16_t port =
      net::UdpReceiver::bind({.transport = Transport::kUdp, .port = 0}).value().port();
  const std::string assets = (test::source_dir() / "assets").string();
  ASSERT_TRUE(write_text(scratch_ / "lab.toml",
                         "[physics]\n[[objects]]\nname = \"diver\"\nmodel = \"" + assets +
                             "/models/diver.glb\"\nhuman = \"" + assets +
                             "/divers/recreational.toml\"\nposition_m = [4, -6, 0]\n[sources]\n" +
                             fmt::format("suit = \"mxtp udp {}\"\n", port))
                  .ok());
  std::atomic<bool> stop{false};
  std::thread sending([&] {
    const auto sender =
        net::UdpSender::create({.transport = Transport::kUdp, .port = port}).value();
    std::array<net::MxtpPose, 5> poses;
    for (std::uint32_t i = 0; i < poses.size(); ++i) poses[i].id = i + 1;
    net::MxtpHeader header{.body_segments = 5};
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
      ++header.sample, header.time_ms += 5;
      (void)sender.send(net::encode_mxtp(header, poses));
    }
  });
  const Outcome outcome = dive("--headless --realtime --seconds 3", "lab.toml");
  stop = true;
  sending.join();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string note = "source suit: no frame has all 23 segments of the body\n";
  const std::size_t at = outcome.err.find(note);
  EXPECT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(note, at + 1), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace neritic
