#include "engine/net/socket.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "engine/core/clock.hpp"

namespace neritic::net {
namespace {

std::vector<std::byte> packet(std::size_t size, int value) {
  return std::vector<std::byte>(size, static_cast<std::byte>(value));
}

TEST(Address, GoodOnesComeBackAndOthersAreRefusedInOneLine) {
  for (const char* text : {"udp://127.0.0.1:9763", "tcp://192.168.1.20:1", "udp://0.0.0.0:65535"})
    EXPECT_EQ(to_text(parse_address(text).value()), text);
  EXPECT_TRUE(parse_address("udp://localhost:9763")->loopback());
  EXPECT_FALSE(parse_address("udp://0.0.0.0:9763")->loopback());
  for (const char* text :
       {"", "udp", "udp://", "127.0.0.1:9763", "udp://127.0.0.1", "udp://127.0.0.1:",
        "udp://127.0.0.1:0", "udp://127.0.0.1:65536", "udp://127.0.0.1:-1", "udp://127.0.0.256:1",
        "udp://1.2.3:4", "udp://1.2.3.4.5:6", "http://127.0.0.1:1", "udp://127.0.0.1:9763 ",
        "udp://example.org:1", "udp://:1", "udp://127.0.0.1:99999999999999999999"}) {
    const auto address = parse_address(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_EQ(address.error().message.find('\n'), std::string::npos);
    EXPECT_NE(address.error().message.find("accepted: udp://"), std::string::npos);
  }
}

// A receiver on a port that the system chooses, and a sender to it.
struct Pair {
  UdpReceiver receiver = UdpReceiver::bind({.port = 0}).value();
  UdpSender sender = UdpSender::create({.port = receiver.port()}).value();
};

TEST(Udp, ADatagramSaysHowLongItWaitedInTheKernel) {
  Pair pair;
  // The kernel begins to stamp a moment after the first socket that asks for it.
  TimeNs stamped_ns = 0;
  for (int i = 0; i < 1000 && stamped_ns < 1'000'000; ++i) {
    ASSERT_TRUE(pair.sender.send(packet(10, 0)));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    pair.receiver.receive([&](Bytes, bool) { stamped_ns = pair.receiver.waited_ns(); }, 100);
  }
  const TimeNs sent_ns = now_ns();
  ASSERT_TRUE(pair.sender.send(packet(10, 1)));
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  ASSERT_TRUE(pair.sender.send(packet(10, 2)));
  std::vector<TimeNs> waited_ns;
  const TimeNs reading_ns = now_ns();
  EXPECT_EQ(pair.receiver.receive(
                [&](Bytes, bool) { waited_ns.push_back(pair.receiver.waited_ns()); }, 100),
            2u);
  const TimeNs since_ns = now_ns() - sent_ns, reading_took_ns = now_ns() - reading_ns;
  EXPECT_GE(waited_ns[0], 40'000'000);
  EXPECT_LE(waited_ns[0], since_ns + 1'000'000);
  // The second waits on while the first is read.
  EXPECT_LE(waited_ns[1], waited_ns[0] - 40'000'000 + reading_took_ns + 1'000'000);
}

TEST(Udp, DatagramsArriveInOrderAndNoneIsANumberOfNone) {
  Pair pair;
  const auto nothing = [](Bytes, bool) { ADD_FAILURE(); };
  EXPECT_EQ(pair.receiver.receive(nothing, 100), 0u);
  for (int i = 0; i < 200; ++i)
    ASSERT_TRUE(pair.sender.send(packet(static_cast<std::size_t>(i), i)));
  int next = 0;
  const auto check = [&](Bytes bytes, bool cut) {
    EXPECT_FALSE(cut);
    EXPECT_EQ(bytes.size(), static_cast<std::size_t>(next));
    if (!bytes.empty()) {
      EXPECT_EQ(bytes.back(), static_cast<std::byte>(next));
    }
    ++next;
  };
  EXPECT_EQ(pair.receiver.receive(check, 150), 150u);
  EXPECT_EQ(pair.receiver.receive(check, 1000), 50u);
}

TEST(Udp, WhatIsLongerThanAnyPacketIsTold) {
  Pair pair;
  ASSERT_TRUE(pair.sender.send(packet(kMostDatagram + 1, 1)));
  bool told = false;
  pair.receiver.receive([&](Bytes, bool cut) { told = cut; }, 1);
  EXPECT_TRUE(told);
}

TEST(Udp, AFullQueueDropsAndCounts) {
  Pair pair;
  constexpr std::uint64_t kSent = 20'000;
  for (std::uint64_t i = 0; i < kSent; ++i) (void)pair.sender.send(packet(1000, 1));
  std::uint64_t got = pair.receiver.receive([](Bytes, bool) {}, kSent);
  EXPECT_LT(got, kSent);
  // The next datagram tells of those before it.
  ASSERT_TRUE(pair.sender.send(packet(1, 1)));
  got += pair.receiver.receive([](Bytes, bool) {}, 1);
  EXPECT_EQ(got + pair.receiver.overflowed(), kSent + 1);
}

TEST(Udp, ATakenPortIsOneLine) {
  const UdpReceiver first = UdpReceiver::bind({.port = 0}).value();
  const auto second = UdpReceiver::bind({.port = first.port()});
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(fmt::format("127.0.0.1:{}: cannot listen", first.port())),
            std::string::npos)
      << second.error().message;
}

// A port of this machine that nobody has.
// Below the ports that the system gives to connections of its own choice, of which other tests make
// many; another one for each call and process.
Address free_tcp() {
  static int calls = 0;
  for (int i = 0; i < 100; ++i) {
    const auto port = static_cast<std::uint16_t>(10'000 + (37 * ::getpid() + 7 * calls++) % 20'000);
    const Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(0x7f000001);
    at.sin_port = htons(port);
    if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0)
      return {Transport::kTcp, 0x7f000001, port};
  }
  ADD_FAILURE() << "no free port";
  return {Transport::kTcp, 0x7f000001, 0};
}

// Polls the receiver; true: done before `ms` went by.
template <class Done>
bool receive_until(TcpReceiver& receiver, const Received& take, int ms, Done done) {
  for (const TimeNs end_ns = now_ns() + TimeNs{ms} * 1'000'000; now_ns() < end_ns;) {
    if (done()) return true;
    receiver.receive(take);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

TEST(Tcp, ASenderThatStallsGivesWayToTheNextOne) {
  const Address address = free_tcp();
  auto receiver = TcpReceiver::open(address, TcpReceiver::Way::kListen).value();
  std::vector<int> got;
  int ends = 0;
  const auto take = [&](Bytes bytes, bool end) {
    for (const std::byte byte : bytes) got.push_back(std::to_integer<int>(byte));
    ends += end;
  };
  auto first = TcpSender::connect(address).value();
  const TimeNs before_ns = now_ns();
  ASSERT_TRUE(first.send(packet(1, 1)));
  ASSERT_TRUE(receive_until(receiver, take, 1000, [&] { return got.size() == 1; }));
  const TimeNs after_ns = now_ns();
  auto next = TcpSender::connect(address).value();
  int sent = 1;
  const bool heard = receive_until(receiver, take, 5000, [&] {
    EXPECT_TRUE(next.send(packet(1, ++sent)));
    return got.size() > 1;
  });
  ASSERT_TRUE(heard);
  // It fell silent between the two.
  const TimeNs heard_ns = now_ns();
  EXPECT_GE(1e-9 * static_cast<double>(heard_ns - before_ns), 1.0);
  EXPECT_LT(1e-9 * static_cast<double>(heard_ns - after_ns), 1.5);
  EXPECT_EQ(ends, 1);
  // What it sent while it waited is not kept.
  EXPECT_GT(got[1], 20);
  EXPECT_EQ(receiver.waiting(), "");
  // The first one is closed.
  bool closed = false;
  for (int i = 0; i < 100 && !closed; ++i) closed = !first.send(packet(1, 1));
  EXPECT_TRUE(closed);
}

TEST(Tcp, ASenderThatSendsIsNotReplacedAndTheOneThatWaitsIsTold) {
  const Address address = free_tcp();
  auto receiver = TcpReceiver::open(address, TcpReceiver::Way::kListen).value();
  std::vector<int> got;
  const auto take = [&](Bytes bytes, bool) {
    for (const std::byte byte : bytes) got.push_back(std::to_integer<int>(byte));
  };
  auto first = std::make_unique<TcpSender>(TcpSender::connect(address).value());
  ASSERT_TRUE(first->send(packet(1, 1)));
  ASSERT_TRUE(receive_until(receiver, take, 1000, [&] { return !got.empty(); }));
  auto older = TcpSender::connect(address).value();
  auto newer = TcpSender::connect(address).value();
  ASSERT_TRUE(
      receive_until(receiver, take, 1000, [&] { return receiver.waiting() == "127.0.0.1"; }));
  for (int i = 0; i < 60; ++i) {
    EXPECT_TRUE(first->send(packet(1, 1)));
    (void)older.send(packet(1, 2));
    EXPECT_TRUE(newer.send(packet(1, 3)));
    (void)receive_until(receiver, take, 25, [] { return false; });
  }
  EXPECT_EQ(std::ranges::count(got, 1), std::ssize(got));
  EXPECT_FALSE(older.send(packet(1, 2)));  // the newest waits
  EXPECT_EQ(receiver.waiting(), "127.0.0.1");
  // No second is waited for where the first one ends.
  first.reset();
  EXPECT_TRUE(receive_until(receiver, take, 500, [&] {
    EXPECT_TRUE(newer.send(packet(1, 3)));
    return got.back() == 3;
  }));
}

// A server whose stream stands still, its socket open.
TEST(Tcp, AServerThatStallsIsConnectedToAgain) {
  const Address address = free_tcp();
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(address.ipv4);
  at.sin_port = htons(address.port);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  ASSERT_EQ(::listen(listener, 4), 0);
  const Descriptor keeps(listener);
  auto receiver = TcpReceiver::open(address, TcpReceiver::Way::kConnect).value();
  int heard = 0, ends = 0;
  const auto take = [&](Bytes bytes, bool end) {
    heard += static_cast<int>(bytes.size());
    ends += end;
  };
  receiver.receive(take);
  const Descriptor first(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
  ASSERT_EQ(::send(first.get(), "a", 1, 0), 1);
  ASSERT_TRUE(receive_until(receiver, take, 1000, [&] { return heard == 1; }));
  const TimeNs last_ns = now_ns();
  Descriptor second;
  ASSERT_TRUE(receive_until(receiver, take, 6000, [&] {
    if (ends == 0) return false;
    second = Descriptor(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
    return second.open();
  }));
  EXPECT_NEAR(1e-9 * static_cast<double>(now_ns() - last_ns), 3.0, 0.5);
  ASSERT_EQ(::send(second.get(), "b", 1, 0), 1);
  EXPECT_TRUE(receive_until(receiver, take, 1000, [&] { return heard == 2; }));
  EXPECT_EQ(ends, 1);
}

TEST(Tcp, AStreamArrivesWholeAndItsEndIsTold) {
  // A free port.
  const std::uint16_t port = UdpReceiver::bind({.port = 0})->port();
  const Address address{Transport::kTcp, 0x7f000001, port};
  auto receiver = TcpReceiver::open(address, TcpReceiver::Way::kListen).value();
  std::vector<std::byte> got;
  int ends = 0;
  const auto take = [&](Bytes bytes, bool end) {
    got.insert(got.end(), bytes.begin(), bytes.end());
    ends += end ? 1 : 0;
  };
  receiver.receive(take);
  for (int round = 1; round <= 2; ++round) {
    auto sender = std::make_unique<TcpSender>(TcpSender::connect(address).value());
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(sender->send(packet(1000, i)));
    for (int i = 0; i < 1000 && got.size() < 10'000; ++i) receiver.receive(take);
    EXPECT_EQ(got.size(), 10'000u);
    sender.reset();
    for (int i = 0; i < 1000 && ends < round; ++i) receiver.receive(take);
    EXPECT_EQ(ends, round);
    got.clear();
  }
}

}  // namespace
}  // namespace neritic::net
