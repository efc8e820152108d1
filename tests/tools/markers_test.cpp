// `neritic dive --markers`: lines that come while a dive runs are in its recording, when they came.
#include <atomic>
#include <chrono>
#include <thread>

#include "engine/net/socket.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

constexpr std::uint16_t kPort = 47131;

class DiveMarkers : public DivePhysics {
 protected:
  // The lines go out one after the other, again and again, every 50 ms while the dive runs.
  Outcome marked(const std::string& flags, const std::vector<std::string>& lines,
                 const std::string& under = kNoDevice) {
    std::atomic<bool> stop{false};
    std::thread sending([&] {
      const auto sender =
          net::UdpSender::create({.transport = Transport::kUdp, .port = kPort}).value();
      for (std::size_t i = 0; !stop; ++i) {
        const std::string& line = lines[i % lines.size()];
        (void)sender.send(std::as_bytes(std::span(line)));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
    const Outcome outcome =
        dive(fmt::format("--headless --realtime --seconds 1 --markers {} {}", kPort, flags),
             "dive.toml", under);
    stop = true;
    sending.join();
    return outcome;
  }
};

TEST_F(DiveMarkers, LinesThatComeAreInTheRecordingInTheirOrder) {
  const std::string with_lsl =
      fmt::format("env LD_LIBRARY_PATH={}/tests/fakes/lsl", NERITIC_BINARY_DIR);
  const Outcome outcome =
      marked("--record " + file("a.mcap"),
             {"trial begins", R"({"marker": "seen, \"here\""})", "", std::string(1025, 'x'),
              "bad \x01\xff bytes", "one of two\r\n\ntwo of two\n"},
             with_lsl);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(fmt::format("markers at udp://127.0.0.1:{}: to the recording and Lab "
                                         "Streaming Layer\n",
                                         kPort)),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.err.find("found 1025 bytes; accepted: 1 to 1024"), std::string::npos);
  const std::string exported =
      fmt::format("'{}/tools/neritic' -q recording export {} --topic /markers --out {}",
                  NERITIC_BINARY_DIR, file("a.mcap"), file("tables"));
  ASSERT_EQ(std::system(exported.c_str()), 0);
  const std::string rows = read_text(scratch_ / "tables/markers.csv").value();
  const auto first = rows.find("trial begins"), second = rows.find("seen, "),
             third = rows.find("bytes");
  EXPECT_TRUE(first != rows.npos && second != rows.npos && third != rows.npos) << rows;
  EXPECT_EQ(rows.find("xxx"), rows.npos);
  // A line each, without its end, as `echo` and `printf` send them.
  for (const char* line : {",one of two\n", ",two of two\n"})
    EXPECT_NE(rows.find(line), rows.npos) << rows;
  // The recording replays: markers move nothing.
  EXPECT_EQ(dive("--headless --replay " + file("a.mcap")).status, 0);
}

TEST_F(DiveMarkers, WhatCannotBeIsRefusedInOneLine) {
  const auto refused = [&](const std::string& flags) {
    const Outcome outcome = dive("--headless --seconds 1 " + flags);
    EXPECT_EQ(outcome.status, 2) << flags << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(refused("--realtime --record " + file("a.mcap") + " --markers 0"),
            "neritic: --markers: found '0'; accepted: a port, 1 to 65535, or udp://ADDRESS:PORT\n");
  EXPECT_EQ(refused("--markers 47149"),
            "neritic: --markers: found a run in simulated time; accepted: --realtime, or a "
            "window\n");
  EXPECT_NE(refused("--realtime --markers 47149").find("--markers: found no --record, and no Lab "),
            std::string::npos);
}

}  // namespace
}  // namespace neritic
