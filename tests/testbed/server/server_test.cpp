// A world that is served: clients see what a program in the same process sees, and none of them
// can hurt it. Loopback alone.
#include "testbed/server/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "engine/core/files.hpp"
#include "engine/net/array_ring.hpp"
#include "engine/net/message_pack.hpp"
#include "testbed/server/remote_reply.hpp"
#include "testbed/server/world_server.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

using nlohmann::json;

std::string assets(const char* path) {
  return (test::source_dir() / "assets" / path).string();
}

std::string scene_text() {
  return "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"" +
         assets("vehicles/bluerov2_heavy_survey_dynamics.toml") +
         "\"\nposition_m = [2, -6, -3]\n[[objects]]\nname = \"buoy\"\nshape = \"box\"\n"
         "position_m = [9, -3, 0]\ninputs = { pose = \"live:client\" }\n";
}

class ServerTest : public testing::Test {
 protected:
  std::unique_ptr<World> open(bool real_time = false) const {
    EXPECT_TRUE(write_text(scratch_ / "s.toml", scene_text()).ok());
    auto world = World::open(scratch_ / "s.toml", {.seed = 5, .real_time = real_time});
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
    return std::move(world).value();
  }
  void serve(WorldServerOptions options = {}, std::size_t clients = 64) {
    world_ = open(options.real_time);
    ServerOptions server{
        .socket = {.address = {Transport::kTcp, 0x7f000001, 0}, .clients = clients}};
    auto started = Server::start(facts_of(*world_, options.real_time, "test"), hand_off_, server);
    ASSERT_TRUE(started.ok()) << started.error().message;
    server_ = std::move(*started);
    thread_ = std::thread([this, options] {
      WorldServer served(*world_, hand_off_, options);
      EXPECT_TRUE(served.run([this] { return stop_.load(); }).ok());
    });
  }
  void TearDown() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::unique_ptr<Remote> client(const std::string& name = {}) const {
    auto remote = Remote::connect(
        {.socket = {.address = server_->address()}, .name = name, .patience_s = 20});
    EXPECT_TRUE(remote.ok()) << (remote.ok() ? "" : remote.error().message);
    return std::move(*remote);
  }
  static Remote::Reply done(Remote& remote, json map) {
    auto reply = remote.call(std::move(map), {}, 30.0);
    EXPECT_TRUE(reply.ok()) << (reply.ok() ? "" : reply.error().message);
    return reply.ok() ? std::move(*reply) : Remote::Reply{};
  }
  static std::string refused(Remote& remote, json map) {
    const auto reply = remote.call(std::move(map));
    EXPECT_FALSE(reply.ok());
    return reply.ok() ? "" : reply.error().message;
  }

  const test::ScratchFolder scratch_;
  std::unique_ptr<World> world_;
  HandOff hand_off_;
  std::unique_ptr<Server> server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST_F(ServerTest, AClientSeesWhatAProgramInTheProcessSees) {
  serve();
  const auto remote = client();
  const auto local = open();
  std::vector<Reading> newest(local->streams().size());
  const double there[] = {4, 3, -7, 0.5};
  std::size_t compared = 0;
  for (int turn = 0; turn < 8; ++turn) {
    if (turn == 2) {
      ASSERT_TRUE(local->command("rov", "goto", there, 0.0, "client").ok());
      done(*remote, {{"op", "command"}, {"agent", "rov"}, {"kind", "goto"}, {"values", there}});
    }
    ASSERT_TRUE(local->tick(60).ok());
    const auto reply = done(*remote, {{"op", "tick"}, {"steps", 60}});
    EXPECT_EQ(reply.map.at("hash"), local->hash());
    EXPECT_EQ(reply.map.at("step"), local->step());
    const auto changed = readings_in(reply, "newest");
    ASSERT_TRUE(changed.ok());
    for (const Reading& one : *changed) newest.at(one.stream) = one;
    for (std::size_t i = 0; i < newest.size(); ++i) {
      const Reading& here = local->newest()[i];
      EXPECT_EQ(newest[i].count, here.count) << local->streams()[i].name;
      EXPECT_EQ(newest[i].sequence, here.sequence);
      EXPECT_EQ(newest[i].stamp_ns, here.stamp_ns);
      EXPECT_EQ(newest[i].arrival_ns, here.arrival_ns);
      EXPECT_EQ(newest[i].values, here.values);
      compared += here.count;
    }
    const auto truth = done(*remote, {{"op", "truth"}, {"agent", "rov"}});
    EXPECT_EQ(truth.map.at("values").at(0), local->truth("rov")->position[0]);
  }
  EXPECT_GT(compared, 100u);
}

TEST_F(ServerTest, TellsWhatBecameOfTheSamplesOfEachSource) {
  serve();
  const auto remote = client();
  const json pushes = {10.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < 3; ++i)
    done(*remote,
         {{"op", "inject"}, {"stream", "rov/wrench"}, {"values", pushes}, {"source", "pad"}});
  (void)refused(*remote, {{"op", "inject"},
                          {"stream", "rov/wrench"},
                          {"values", pushes},
                          {"source", "pad"},
                          {"stamp_s", -9.0}});
  // Beside those that the scene names.
  const json sources = done(*remote, {{"op", "sources"}}).map.at("sources");
  const auto pad =
      std::ranges::find_if(sources, [](const json& one) { return one.at("name") == "pad"; });
  ASSERT_NE(pad, sources.end());
  EXPECT_EQ(pad->at("accepted"), 3);
  EXPECT_EQ(pad->at("late"), 1);
  EXPECT_EQ(pad->at("health"), "");
  EXPECT_FALSE(pad->contains("link"));
}

TEST_F(ServerTest, EachReadingOfAKeptStreamComes) {
  serve();
  const auto remote = client();
  const auto local = open();
  ASSERT_TRUE(local->keep(local->stream("rov/imu").value(), true).ok());
  done(*remote, {{"op", "keep"}, {"stream", "rov/imu"}});
  ASSERT_TRUE(local->tick(240).ok());
  const auto reply = done(*remote, {{"op", "tick"}, {"steps", 240}});
  const auto arrived = readings_in(reply, "arrived").value();
  const auto here = local->take_arrived();
  ASSERT_EQ(arrived.size(), here.size());
  ASSERT_GT(here.size(), 50u);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_EQ(arrived[i].values, here[i].values);
}

// A tick of more steps than a client's mail has room for ends early, before it loses one.
TEST_F(ServerTest, ALongTickLosesNoReading) {
  serve();
  const auto remote = client();
  done(*remote, {{"op", "keep"}, {"stream", "rov/imu"}});
  const std::uint64_t steps = 240 * 60;
  std::uint64_t step = 0, next = 0;
  int ticks = 0;
  for (; step < steps && ticks < 100; ++ticks) {
    const auto reply = done(*remote, {{"op", "tick"}, {"steps", steps - step}});
    step = reply.map.at("step");
    EXPECT_FALSE(reply.map.contains("lost_readings"));
    const auto arrived = readings_in(reply, "arrived").value();
    for (const Reading& reading : arrived) {
      if (next == 0) next = reading.sequence;
      ASSERT_EQ(reading.sequence, next++);
    }
  }
  EXPECT_EQ(step, steps);
  EXPECT_GT(next, 8192u);
  EXPECT_GT(ticks, 1);
}

TEST_F(ServerTest, AStateGoesBackToWhereItWas) {
  serve();
  const auto remote = client();
  const auto first = done(*remote, {{"op", "tick"}, {"steps", 50}});
  const auto saved = done(*remote, {{"op", "save"}});
  const auto state = saved.frames.at(saved.map.at("state").at("frame"));
  done(*remote, {{"op", "tick"}, {"steps", 70}});
  const auto back = remote->call({{"op", "restore"}}, {state});
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->map.at("hash"), first.map.at("hash"));
  EXPECT_EQ(back->map.at("step"), 50);
  const std::vector<std::byte> nonsense(1000, std::byte{7});
  EXPECT_FALSE(remote->call({{"op", "restore"}}, {nonsense}).ok());
  EXPECT_EQ(done(*remote, {{"op", "tick"}, {"steps", 1}}).map.at("step"), 51);
}

TEST_F(ServerTest, OneClientHoldsTheClockAndItsEndFreesIt) {
  serve();
  auto holder = client("ada");
  const auto other = client("bob");
  done(*holder, {{"op", "tick"}, {"steps", 5}});
  EXPECT_THAT(refused(*other, {{"op", "tick"}, {"steps", 5}}),
              testing::HasSubstr("tick: found a clock that ada holds"));
  EXPECT_THAT(refused(*client("ada"), {{"op", "tick"}, {"steps", 5}}),
              testing::HasSubstr("tick: found a clock that another client of the name ada holds"));
  EXPECT_EQ(done(*other, {{"op", "observe"}}).map.at("clock"), "ada");
  holder.reset();
  bool ticked = false;
  for (int i = 0; i < 3000 && !ticked; ++i) {
    ticked = other->call({{"op", "tick"}, {"steps", 5}}).ok();
    if (!ticked) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(ticked);
}

TEST_F(ServerTest, InRealTimeItGoesOnByItselfAndATickIsAWait) {
  serve({.real_time = true});
  const auto remote = client();
  const auto first = done(*remote, {{"op", "tick"}, {"steps", 24}});
  const auto second = done(*remote, {{"op", "tick"}, {"steps", 24}});
  EXPECT_GE(second.map.at("step").get<int>(), first.map.at("step").get<int>() + 24);
  EXPECT_THAT(refused(*remote, {{"op", "clock"}}), testing::HasSubstr("in real time"));
  const auto news = done(*remote, {{"op", "observe"}, {"wait_s", 5.0}});
  EXPECT_FALSE(readings_in(news, "newest").value().empty());
}

TEST_F(ServerTest, ObserveWaitsForWhatIsNewAndNotForEver) {
  serve();
  const auto holder = client("ada"), other = client("bob");
  done(*holder, {{"op", "tick"}, {"steps", 10}});
  done(*other, {{"op", "observe"}});
  EXPECT_FALSE(done(*other, {{"op", "observe"}, {"wait_s", 0.05}}).map.contains("newest"));
}

TEST_F(ServerTest, BadRequestsAreRefusedInOneLine) {
  serve();
  const auto remote = client();
  const std::vector<json> bad{
      {{"op", "fly"}},
      {{"op", 7}},
      {{"op", "tick"}},
      {{"op", "tick"}, {"steps", -1}},
      {{"op", "tick"}, {"steps", 1e300}},
      {{"op", "tick"}, {"steps", std::uint64_t{1} << 60}},
      {{"op", "tick"}, {"steps", 1}, {"step", 1}},
      {{"op", "hello"}, {"protocol", 2}},
      {{"op", "command"}, {"agent", "rov"}, {"kind", "goto"}, {"values", {1, 2}}},
      {{"op", "command"}, {"agent", "rov"}, {"kind", "goto"}, {"values", {1, 2, NAN, 0}}},
      {{"op", "command"}, {"agent", "rov"}, {"kind", "jump"}, {"values", json::array()}},
      {{"op", "command"}, {"agent", "fish"}, {"kind", "goto"}, {"values", {1, 2, 3, 4}}},
      {{"op", "inject"}, {"stream", "rov/nothing"}, {"values", {1}}},
      {{"op", "inject"}, {"stream", "rov/fault"}, {"values", {1}}, {"source", ""}},
      {{"op", "inject"}, {"stream", "rov/fault"}, {"values", {1}}, {"source", "two words"}},
      {{"op", "hello"}, {"protocol", 1}, {"name", "simulation"}},
      {{"op", "keep"}, {"stream", "x\n\x1b"}},
      {{"op", "keep"}, {"stream", std::string(5000, 'x')}},
      {{"op", "truth"}, {"agent", json::array({1})}},
      {{"op", "record"}, {"name", "../../etc/passwd"}},
      {{"op", "shared"}, {"token", 1}},
      {{"op", "restore"}},
  };
  for (const json& map : bad) {
    const std::string line = refused(*remote, map);
    EXPECT_EQ(line.find('\n'), line.npos) << line;
    EXPECT_LT(line.size(), 800u) << line;
    EXPECT_NE(line.find("found"), line.npos) << line;
  }
  EXPECT_EQ(done(*remote, {{"op", "tick"}, {"steps", 3}}).map.at("step"), 3);
}

TEST_F(ServerTest, WhoDoesNotGreetIsNotHeard) {
  serve();
  const auto socket = net::ClientSocket::connect({.address = server_->address()}).value();
  socket->send({net::pack({{"op", "tick"}, {"id", 1}, {"steps", 1}})});
  const auto frames = socket->receive(5000);
  ASSERT_TRUE(frames.has_value());
  const json map = net::unpack(frames->front()).value();
  EXPECT_EQ(map.at("ok"), false);
  EXPECT_THAT(map.at("error").get<std::string>(), testing::HasSubstr("hello first"));
}

TEST_F(ServerTest, EachRequestThatIsNoneIsRefusedInAnAnswer) {
  serve();
  const auto remote = client();
  const std::vector<double> many(5000, 1.0);
  EXPECT_THAT(
      refused(*remote, {{"op", "command"}, {"agent", "rov"}, {"kind", "pwm"}, {"values", many}}),
      testing::HasSubstr("found more than 1024 values"));
  EXPECT_THAT(refused(*remote, {{"op", "record"}, {"name", std::string(1 << 17, 'a')}}),
              testing::HasSubstr("bytes; accepted: up to 65536"));
  json deep = json::array();
  for (int i = 0; i < 20; ++i) deep = json::array({deep});
  EXPECT_THAT(refused(*remote, {{"op", "tick"}, {"steps", deep}}),
              testing::HasSubstr("maps and lists in each other"));
  const std::vector<std::byte> more(4);
  EXPECT_FALSE(remote->call({{"op", "save"}}, {more, more}).ok());
  const auto socket = net::ClientSocket::connect({.address = server_->address()}).value();
  const auto answer = [&](std::vector<std::byte> bytes) -> json {
    socket->send({std::move(bytes)});
    const auto frames = socket->receive(5000);
    return frames ? net::unpack(frames->front()).value() : json();
  };
  // Each has one answer, in order: that of a number that can be read has it, any other has 0.
  for (const auto& [bytes, id] : {std::pair(std::vector<std::byte>(7, std::byte{0xc1}), 0),
                                  {{}, 0},
                                  {net::pack({{"op", "hello"}, {"id", "one"}}), 0},
                                  {net::pack({{"op", "hello"}, {"id", -3}}), 0},
                                  {net::pack({{"op", "hello"}, {"id", 8}, {"protocol", many}}), 8},
                                  {net::pack(json::array({1, 2})), 0}}) {
    const json map = answer(bytes);
    ASSERT_TRUE(map.is_object()) << id;
    EXPECT_EQ(map.at("ok"), false);
    EXPECT_EQ(map.at("id"), id);
    EXPECT_FALSE(map.at("error").get<std::string>().empty());
  }
  // A request that wants no answer has none, whether it is refused or not.
  socket->send({net::pack({{"op", "hello"}, {"id", 0}, {"protocol", many}})});
  EXPECT_EQ(answer(net::pack({{"op", "hello"}, {"id", 9}, {"protocol", 1}})).at("id"), 9);
}

TEST_F(ServerTest, AClientWithManyRequestsIsRefusedBeyondABoundAndTheOthersGoOn) {
  serve();
  const auto other = client("bob");
  const auto flood = net::ClientSocket::connect({.address = server_->address()}).value();
  flood->send({net::pack({{"op", "hello"}, {"id", 1}, {"protocol", 1}})});
  // Its first tick goes on, so that what follows waits.
  flood->send({net::pack({{"op", "tick"}, {"id", 2}, {"steps", 3000}})});
  for (int i = 0; i < 500; ++i) flood->send({net::pack({{"op", "save"}, {"id", 3 + i}})});
  EXPECT_GT(done(*other, {{"op", "truth"}, {"agent", "rov"}}).map.at("values").size(), 10u);
  int refusals = 0, answers = 0;
  for (int i = 0; i < 502; ++i) {
    const auto frames = flood->receive(i == 0 ? 20000 : 3000);
    if (!frames) break;  // the rest was lost on the way
    const json map = net::unpack(frames->front()).value();
    (map.at("ok").get<bool>() ? answers : refusals) += 1;
  }
  EXPECT_GE(answers, 60);
  EXPECT_GE(refusals, 300);
  EXPECT_EQ(server_->counts().busy > 0, true);
}

TEST_F(ServerTest, ThousandsOfStrangersLeaveTheDiveAsItIs) {
  serve({}, 8);
  const auto remote = client("ada");
  const auto local = open();
  std::atomic<bool> over{false};
  std::thread strangers([&] {
    std::mt19937 random(3);
    std::vector<std::unique_ptr<net::ClientSocket>> crowd;
    while (!over) {
      if (crowd.size() > 40) crowd.clear();
      crowd.push_back(net::ClientSocket::connect({.address = server_->address()}).value());
      for (int k = 0; k < 20; ++k) {
        std::vector<std::byte> bytes(random() % 300);
        for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
        crowd.back()->send({bytes});
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  for (int turn = 0; turn < 20; ++turn) {
    ASSERT_TRUE(local->tick(24).ok());
    EXPECT_EQ(done(*remote, {{"op", "tick"}, {"steps", 24}}).map.at("hash"), local->hash());
  }
  const auto sent_away = [&] {
    return server_->counts().refused + server_->counts().socket.too_many;
  };
  for (int i = 0; i < 1000 && sent_away() == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  over = true;
  strangers.join();
  EXPECT_GT(sent_away(), 0u);
}

// Not after the minute that a tick may last.
TEST_F(ServerTest, AServersEndIsNoticedAtOnce) {
  serve();
  auto remote = client();
  done(*remote, {{"op", "tick"}, {"steps", 1}});
  // While a request waits for its answer.
  std::thread end([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    server_.reset();
  });
  const TimeNs begun = now_ns();
  const auto reply = remote->call({{"op", "observe"}, {"wait_s", 60.0}}, {}, 60.0);
  end.join();
  ASSERT_FALSE(reply.ok());
  EXPECT_NE(reply.error().message.find("the connection was closed: the server has ended"),
            std::string::npos)
      << reply.error().message;
  // And each one after it.
  EXPECT_NE(refused(*remote, {{"op", "tick"}, {"steps", 1}}).find("the server has ended"),
            std::string::npos);
  EXPECT_LT(1e-9 * static_cast<double>(now_ns() - begun), 5.0);
}

TEST(ArrayRing, GivesBackWhatWasPutUntilItIsOverwritten) {
  const auto ring = net::ArrayRing::create(1 << 16).value();
  const auto reader = net::ArrayRingReader::open(ring->path()).value();
  EXPECT_EQ(reader->token(), ring->token());
  std::vector<std::byte> array(10000), got(10000);
  std::vector<std::uint64_t> places;
  for (int i = 0; i < 20; ++i) {
    std::ranges::fill(array, static_cast<std::byte>(i));
    places.push_back(ring->put(array).value());
    ASSERT_TRUE(reader->read(places.back(), got));
    EXPECT_EQ(got, array);
  }
  EXPECT_FALSE(reader->read(places[10], got));
  EXPECT_FALSE(reader->read(places.back() + (1 << 20), got));
  EXPECT_EQ(ring->put(std::vector<std::byte>(1 << 15)), std::nullopt);
  EXPECT_FALSE(net::ArrayRingReader::open("/dev/null").ok());
}

TEST(ArrayRing, LeavesALentArrayAloneUntilItIsGivenBack) {
  const auto ring = net::ArrayRing::create(1 << 16).value();
  const auto reader = net::ArrayRingReader::open(ring->path()).value();
  const auto other = net::ArrayRingReader::open(ring->path()).value();
  const auto filled = [](int with) {
    return std::vector<std::byte>(10000, static_cast<std::byte>(with));
  };
  const std::uint64_t first = ring->put(filled(1)).value();
  const auto loan = reader->lend(first, 10000);
  ASSERT_TRUE(loan);
  // Only the reader sees its own changes.
  loan->bytes[3] = std::byte{77};
  std::vector<std::byte> got(10000);
  ASSERT_TRUE(other->read(first, got));
  EXPECT_EQ(got, filled(1));
  // A quarter of 65536 bytes is lent to one reader at most.
  EXPECT_FALSE(reader->lend(ring->put(filled(2)).value(), 10000));
  for (int i = 0; i < 50; ++i) {
    const std::uint64_t at = ring->put(filled(i)).value();
    EXPECT_NE(at % (1 << 16), 0u);
    ASSERT_TRUE(other->read(at, got));
    EXPECT_EQ(got, filled(i));
    loan->bytes[3] = std::byte{1};
    EXPECT_TRUE(std::ranges::equal(loan->bytes, filled(1)));
  }
  // Too late for an array that was overwritten, or that lies nowhere.
  EXPECT_FALSE(other->lend(first, 10000));
  EXPECT_FALSE(other->lend(ring->put(filled(3)).value() + 64, 10000));
  reader->give_back(*loan);
  bool again = false;
  for (int i = 0; i < 5; ++i) {
    const std::uint64_t at = ring->put(filled(90 + i)).value();
    if (at % (1 << 16) != 0) continue;
    again = true;
    const auto second = reader->lend(at, 10000);
    ASSERT_TRUE(second);
    EXPECT_TRUE(std::ranges::equal(second->bytes, filled(90 + i)));
    reader->give_back(*second);
  }
  EXPECT_TRUE(again);
}

TEST(ArrayRing, HeldByReadersItTakesNoMoreUntilTheyEnd) {
  const auto ring = net::ArrayRing::create(1 << 16).value();
  const std::vector<std::byte> array(1 << 14);
  std::vector<std::unique_ptr<net::ArrayRingReader>> readers;
  for (int i = 0; i < 4; ++i) {
    readers.push_back(net::ArrayRingReader::open(ring->path()).value());
    const auto loan = readers.back()->lend(ring->put(array).value(), array.size());
    ASSERT_TRUE(loan);
    if (i > 0) continue;
    // A process that this one forked has it, too.
    readers.back()->forking();
    readers.back()->give_back(*loan);
  }
  EXPECT_EQ(ring->put(array), std::nullopt);
  EXPECT_EQ(ring->put(std::vector<std::byte>(1)), std::nullopt);
  readers.erase(readers.begin() + 2);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(ring->put(array).value() % (1 << 16), 1u << 15);
}

}  // namespace
}  // namespace neritic::testbed
