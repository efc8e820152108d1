// `neritic simulate flood`: packets leave at the rate that is asked for, also a slow one.
#include "engine/core/json.hpp"
#include "engine/net/socket.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

class SimulateFlood : public DivePhysics {};

TEST_F(SimulateFlood, SendsTheRateThatIsAsked) {
  const std::uint16_t port =
      net::UdpReceiver::bind({.transport = Transport::kUdp, .port = 0}).value().port();
  const std::string assets = (test::source_dir() / "assets").string();
  ASSERT_TRUE(write_text(scratch_ / "lab.toml",
                         "[physics]\n[[objects]]\nname = \"diver\"\nmodel = \"" + assets +
                             "/models/diver.glb\"\nhuman = \"" + assets +
                             "/divers/recreational.toml\"\nposition_m = [4, -6, 0]\n[sources]\n" +
                             fmt::format("jacket = \"jacket udp {}\"\n", port))
                  .ok());
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

}  // namespace
}  // namespace neritic
