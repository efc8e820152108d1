// `neritic simulate flood`: packets leave at the rate that is asked for, also a slow one, and the
// diver's breath is heard among them.
#include "engine/core/json.hpp"
#include "engine/net/socket.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

class SimulateFlood : public DivePhysics {
 protected:
  // A scene of a diver with these lines of [sources].
  void write_lab(const std::string& sources) {
    const std::string assets = (test::source_dir() / "assets").string();
    ASSERT_TRUE(write_text(scratch_ / "lab.toml",
                           "[physics]\n[[objects]]\nname = \"diver\"\nmodel = \"" + assets +
                               "/models/diver.glb\"\nhuman = \"" + assets +
                               "/divers/recreational.toml\"\nposition_m = [4, -6, 0]\n[sources]\n" +
                               sources)
                    .ok());
  }
  static std::uint16_t free_port() {
    return net::UdpReceiver::bind({.transport = Transport::kUdp, .port = 0}).value().port();
  }
};

TEST_F(SimulateFlood, SendsTheRateThatIsAsked) {
  write_lab(fmt::format("jacket = \"jacket udp {}\"\n", free_port()));
  constexpr double kSeconds = 3.0;
  for (const double rate_hz : {5.0, 50.0, 2000.0}) {
    SCOPED_TRACE(rate_hz);
    // 1: a machine that is busy drops steps, which is told; packets are counted all the same.
    const Outcome outcome =
        neritic(fmt::format("simulate flood --scene {} --rate {} --seconds {} --json",
                            file("lab.toml"), rate_hz, kSeconds));
    ASSERT_LE(outcome.status, 1) << outcome.err;
    const auto told = parse_json(outcome.out).value();
    const double asked = rate_hz * told["seconds"].get<double>();
    const auto sent = told["sent"].get<double>();
    EXPECT_GE(told["seconds"].get<double>(), kSeconds);
    EXPECT_LE(sent, asked + 3.0);  // the first goes at once; a millisecond's at a time
    EXPECT_GE(sent, 0.9 * asked - 1.0);
    EXPECT_EQ(told["received"].get<double>() + told["overflowed"].get<double>(), sent);
    EXPECT_TRUE(told["counts_add_up"].get<bool>());
  }
}

// A microphone gets a twentieth of the packets, more than 2000 a second, and sends 16 000 samples a
// second in them. The flood's person breathes 15 times a minute.
TEST_F(SimulateFlood, BreathIsHeardAmongThePackets) {
  write_lab(fmt::format("jacket = \"jacket udp {}\"\nmicrophone = \"microphone udp {}\"\n",
                        free_port(), free_port()));
  const Outcome outcome = neritic(
      fmt::format("simulate flood --scene {} --rate 48000 --seconds 13 --json", file("lab.toml")));
  ASSERT_LE(outcome.status, 1) << outcome.err;  // 1: a busy machine drops steps
  const auto told = parse_json(outcome.out).value();
  EXPECT_TRUE(told["counts_add_up"].get<bool>());
  const auto& link = told["links"]["microphone"];
  EXPECT_GT(link["used"].get<double>(), 0.8 * link["datagrams"].get<double>()) << outcome.out;
  EXPECT_EQ(link["unused"].get<int>(), 0) << "the rate was refused";
  EXPECT_EQ(link["malformed"].get<int>(), 0);
  EXPECT_GE(told["breath"]["with_rate"].get<int>(), 1) << outcome.out;
  EXPECT_NEAR(told["breath"]["rate_bpm"].get<double>(), 15.0, 1.0);
}

}  // namespace
}  // namespace neritic
