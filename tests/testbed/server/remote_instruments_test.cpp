// Instruments far away: the numbers are the state's, a server that goes away is told, and one that
// comes back is read again.
#include "testbed/server/remote_instruments.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <limits>
#include <thread>

#include "hud/hud.hpp"
#include "testbed/instruments/instrument_numbers.hpp"
#include "testbed/server/server.hpp"
#include "testbed/server/world_server.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

// A dive that is served until this ends.
class ServedWorld {
 public:
  // said: by the rov's modem to all before it is served.
  explicit ServedWorld(std::uint16_t port, std::uint64_t steps = 480,
                       const std::filesystem::path& scene = "ascent.toml",
                       std::string_view said = {}) {
    auto world = World::open(test::source_dir() / "assets/scenes" / scene, {});
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
    world_ = std::move(*world);
    if (!said.empty()) {
      std::vector<double> bytes{0.0};
      for (const char c : said) bytes.push_back(static_cast<unsigned char>(c));
      const Status sent = world_->command("rov", "send", bytes);
      EXPECT_TRUE(sent.ok()) << (sent.ok() ? "" : sent.error().message);
    }
    EXPECT_TRUE(world_->tick(steps).ok());
    wanted_ = world_->instruments("diver").value();
    auto started = Server::start(facts_of(*world_, false, "test"), hand_off_,
                                 {.socket = {.address = {Transport::kTcp, 0x7f000001, port}}});
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error().message);
    server_ = std::move(*started);
    thread_ = std::thread([this] {
      WorldServer served(*world_, hand_off_, {});
      EXPECT_TRUE(served.run([this] { return stop_.load(); }).ok());
    });
  }
  ~ServedWorld() {
    stop_ = true;
    thread_.join();
  }
  Address address() const { return server_->address(); }
  const Instruments& wanted() const { return wanted_; }

 private:
  std::unique_ptr<World> world_;
  Instruments wanted_;
  HandOff hand_off_;
  std::unique_ptr<Server> server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

RemoteInstrumentsOptions quick(const Address& address) {
  return {.remote = {.socket = {.address = address}, .name = "hud", .patience_s = 30.0},
          .rate_hz = 50.0,
          .lost_after_s = 0.5};
}

bool comes(const std::function<bool()>& is) {
  for (int i = 0; i < 1500; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(20)))
    if (is()) return true;
  return false;
}

// Instruments, here and far away, show the words that the diver's modem receives, and no bytes that
// are for a program.
TEST(RemoteInstrumentsTest, TheDiverReadsWhatTheModemReceives) {
  const test::ScratchFolder folder;
  const std::filesystem::path scene = folder / "loud.toml";  // nothing is lost
  std::ofstream(scene) << fmt::format(
      "include = \"{}\"\n[[objects]]\nname = \"diver\"\nmodem = {{ fading = false }}\n"
      "[[vehicles]]\nname = \"rov\"\nmodem = {{ fading = false, source_level_db = 180 }}\n",
      (test::source_dir() / "assets/scenes/talk.toml").string());
  const ServedWorld server(0, 720, scene, "FOLLOW ME, \u03b1 42\u00b0");
  EXPECT_EQ(server.wanted().message, "FOLLOW ME, \u03b1 42\u00b0");
  EXPECT_EQ(server.wanted().message_from, "rov");
  auto connected = RemoteInstruments::connect(quick(server.address()));
  ASSERT_TRUE(connected.ok()) << connected.error().message;
  InstrumentNews near;
  ASSERT_TRUE(comes([&] {
    near = (*connected)->read();
    return near.data.time_s > 0.0 && !near.data.link_lost;
  }));
  EXPECT_EQ(near.data.message.view(), server.wanted().message);
  EXPECT_EQ(near.data.message_from.view(), "rov");
  // 3 s after it was sent, less the time that 18 bytes take.
  EXPECT_GT(near.data.message_age_s, 1.5);
  EXPECT_LT(near.data.message_age_s, 2.8);
  for (const std::string_view bytes : {"\x01\x02\x03", "\xff\xfe"})
    EXPECT_EQ(ServedWorld(0, 720, scene, bytes).wanted().message, "");
}

TEST(RemoteInstrumentsTest, NumbersAreTheStatesAndAServerThatComesBackIsReadAgain) {
  auto server = std::make_unique<ServedWorld>(0);
  const Address address = server->address();
  auto connected = RemoteInstruments::connect(quick(address));
  ASSERT_TRUE(connected.ok()) << connected.error().message;
  RemoteInstruments& remote = **connected;
  // A busy machine may hold the reader up for longer than lost_after_s.
  InstrumentNews near;
  ASSERT_TRUE(comes([&] {
    near = remote.read();
    return near.data.time_s > 0.0 && !near.data.link_lost;
  }));
  EXPECT_EQ(near.data.time_s, server->wanted().time_s);
  const NamedNumbers numbers = numbers_of(near.data);
  ASSERT_EQ(numbers.size(), server->wanted().numbers.size());
  std::size_t known = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto& [name, wanted] = server->wanted().numbers[i];
    EXPECT_EQ(numbers[i].first, name);
    if (std::isnan(wanted)) continue;
    EXPECT_EQ(numbers[i].second, wanted) << name;
    ++known;
  }
  EXPECT_GT(known, 45u);
  EXPECT_FALSE(near.data.link_lost);
  EXPECT_EQ(near.streams.front().health, hud::Health::kGood);

  server.reset();
  InstrumentNews lost;
  ASSERT_TRUE(comes([&] {
    lost = remote.read();
    return remote.lost() && lost.data.link_lost && lost.data.time_s > near.data.time_s;
  }));
  EXPECT_TRUE(lost.data.link_lost);
  EXPECT_TRUE(std::isnan(lost.data.depth_m));
  EXPECT_GT(lost.data.time_s, near.data.time_s);
  EXPECT_EQ(lost.streams.front().health, hud::Health::kLost);
  EXPECT_TRUE(hud::step_alarms({}, lost.data, lost.data.time_s).on(hud::Alarm::kLink));

  server = std::make_unique<ServedWorld>(address.port, 960);
  ASSERT_TRUE(comes([&] { return remote.read().data.time_s == server->wanted().time_s; }));
  EXPECT_GE(remote.connections(), 2u);
}

TEST(RemoteInstrumentsTest, ADiverWhoIsNotThereIsRefusedInOneLine) {
  const ServedWorld server(0, 1);
  auto options = quick(server.address());
  options.diver = "nobody";
  const auto refused = RemoteInstruments::connect(options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(refused.error().message.find("--diver: found 'nobody'; accepted: "), 0u)
      << refused.error().message;
}

TEST(RemoteInstrumentsTest, WithoutAServerItSaysSoInTime) {
  auto options = quick({Transport::kTcp, 0x7f000001, 9});
  options.remote.patience_s = 0.3;
  const auto refused = RemoteInstruments::connect(options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_EQ(refused.error().message.find("tcp://127.0.0.1:9: no answer"), 0u);
}

TEST(InstrumentNumbers, WhatCannotBeIsNotKnown) {
  hud::DiveData data;
  for (const auto& [name, value] : numbers_of(data)) {
    (void)value;
    for (const double strange : {1e300, -1e300, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(), 5e-324, -1.0})
      EXPECT_TRUE(set_number(data, name, strange)) << name;
  }
  EXPECT_FALSE(set_number(data, "depth", 3.0));
  EXPECT_GT(data.surface_bar, 0.0);
  EXPECT_TRUE(diver::is_mix(data.gas));
  for (const hud::Layout& layout : hud::layouts()) {
    hud::Hud hud(layout.kind, hud::Units::kMetric, layout.height_px / 4);
    EXPECT_TRUE(hud.update(data, data.time_s)) << layout.name;
  }
}

}  // namespace
}  // namespace neritic::testbed
