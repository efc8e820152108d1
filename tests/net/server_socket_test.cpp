// A server's socket: messages both ways, keys, and what strangers do to it. Loopback alone.
#include "engine/net/server_socket.hpp"

#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "engine/core/memory.hpp"
#include "engine/net/client_socket.hpp"
#include "tests/support/support.hpp"

namespace neritic::net {
namespace {

using namespace std::chrono_literals;

Bytes frame_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
std::string text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A server that answers each message with its frames, on the caller's thread.
struct Echo {
  explicit Echo(ServerSocketOptions options = {}) {
    options.address.port = 0;
    auto made = ServerSocket::bind(options);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    socket = std::move(*made);
  }
  void serve(int wait_ms = 20) {
    socket->serve(wait_ms, {[&](const ClientMessage& message) {
                              names.emplace_back(message.name);
                              last = message.client;
                              if (answers) socket->send(message.client, message.frames);
                            },
                            [&](ClientId) { ++gone; }});
  }
  std::unique_ptr<ClientSocket> client(std::optional<KeyPair> keys = {},
                                       const std::string& server = {}) {
    return std::move(ClientSocket::connect({socket->address(), keys, server}).value());
  }
  // The answer to a text, or nothing within that time.
  std::optional<std::string> ask(ClientSocket& client, std::string_view text,
                                 std::chrono::milliseconds within = 5s) {
    client.send({frame_of(text)});
    const auto end = std::chrono::steady_clock::now() + within;
    while (std::chrono::steady_clock::now() < end) {
      serve();
      if (const auto frames = client.receive(1)) return text_of(frames->front());
    }
    return {};
  }
  // Serves until it is true, at most some seconds.
  bool until(const std::function<bool()>& done) {
    for (int i = 0; i < 300 && !done(); ++i) serve(10);
    return done();
  }

  std::unique_ptr<ServerSocket> socket;
  std::vector<std::string> names;
  ClientId last = 0;
  int gone = 0;
  bool answers = true;
};

// A plain TCP connection.
Descriptor stranger(const Address& to, int kind = 0) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | kind, 0));
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(to.port);
  where.sin_addr.s_addr = htonl(to.ipv4);
  const int done = connect(socket.get(), reinterpret_cast<sockaddr*>(&where), sizeof where);
  EXPECT_TRUE(done == 0 || errno == EINPROGRESS) << errno;
  return socket;
}
// Whether the other side closed it.
bool ended(const Descriptor& socket) {
  char bytes[256];
  for (;;) {
    const ssize_t n = recv(socket.get(), bytes, sizeof bytes, MSG_DONTWAIT);
    if (n > 0) continue;
    return n == 0 || errno != EAGAIN;
  }
}
// ZMTP 3.1 without keys, as a DEALER says it.
std::string greeting() {
  std::string text("\xff\0\0\0\0\0\0\0\x01\x7f\x03\x01NULL", 16);
  text.resize(64, '\0');
  const std::string ready(
      "\x05READY\x0bSocket-Type\0\0\0\x06"
      "DEALER",
      28);
  return text + std::string("\x04", 1) + static_cast<char>(ready.size()) + ready;
}
// A stranger who has gone through the handshake.
void greet(const Descriptor& socket) {
  const std::string hello = greeting();
  EXPECT_EQ(send(socket.get(), hello.data(), hello.size(), 0), static_cast<ssize_t>(hello.size()));
  std::size_t got = 0;  // its greeting, and its word that it is ready
  for (char bytes[256]; got < 64 + 30;) {
    const ssize_t n = recv(socket.get(), bytes, sizeof bytes, 0);
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  EXPECT_GE(got, 64u + 30u);
}
Descriptor greeted(const Address& to) {
  Descriptor socket = stranger(to);
  greet(socket);
  return socket;
}
std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(ServerSocket, MessagesGoBothWaysAndAnEndIsTold) {
  Echo echo;
  auto client = echo.client();
  EXPECT_EQ(echo.ask(*client, "hello"), "hello");
  EXPECT_EQ(echo.ask(*client, std::string(3 << 20, 'x')), std::string(3 << 20, 'x'));
  EXPECT_EQ(echo.socket->clients(), 1u);
  client.reset();
  EXPECT_TRUE(echo.until([&] { return echo.gone == 1; }));
  EXPECT_EQ(echo.socket->clients(), 0u);
}

TEST(ServerSocket, ListensBeyondThisMachineWithKeysAlone) {
  const auto open = ServerSocket::bind({.address = {Transport::kTcp, 0, 0}});
  ASSERT_FALSE(open.ok());
  EXPECT_EQ(open.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(open.error().message, testing::HasSubstr("without keys"));
}

TEST(ServerSocket, HearsAClientWhoseKeyIsKnownAndNoOther) {
  const auto server = make_key_pair().value(), known = make_key_pair().value();
  ServerSocketOptions options{.keys = ServerKeys{server, {{known.public_z85, "ada"}}}};
  Echo echo(options);
  auto ada = echo.client(known, server.public_z85);
  EXPECT_EQ(echo.ask(*ada, "hello"), "hello");
  EXPECT_EQ(echo.names, std::vector<std::string>{"ada"});
  auto nobody = echo.client(make_key_pair().value(), server.public_z85);
  EXPECT_EQ(echo.ask(*nobody, "hello", 200ms), std::nullopt);
  auto open = echo.client();
  EXPECT_EQ(echo.ask(*open, "hello", 200ms), std::nullopt);
  auto misled = echo.client(known, make_key_pair()->public_z85);
  EXPECT_EQ(echo.ask(*misled, "hello", 200ms), std::nullopt);
  const auto counts = echo.socket->counts();
  EXPECT_GE(counts.not_known, 1u);
  EXPECT_GE(counts.no_greeting, 2u);
  EXPECT_EQ(echo.ask(*ada, "still here"), "still here");
}

TEST(ServerSocket, AFrameOfTwoGigabytesEndsItsConnection) {
  Echo echo;
  const std::size_t before = resident_bytes();
  const Descriptor socket = greeted(echo.socket->address());
  const std::string bytes("\x02\0\0\0\0\x80\0\0\0", 9);
  ASSERT_EQ(send(socket.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  EXPECT_TRUE(echo.until([&] { return ended(socket); }));
  EXPECT_LT(resident_bytes(), before + (32u << 20));
  auto client = echo.client();
  EXPECT_EQ(echo.ask(*client, "hello"), "hello");
}

TEST(ServerSocket, RandomBytesEndTheirConnectionsAlone) {
  Echo echo({.handshake_ms = 500});
  auto client = echo.client();
  ASSERT_EQ(echo.ask(*client, "before"), "before");
  std::mt19937 random(7);
  std::vector<Descriptor> sockets;
  for (int i = 0; i < 50; ++i) {
    sockets.push_back(stranger(echo.socket->address()));
    // Some begin as ZMTP does.
    std::string bytes = greeting().substr(0, i % 2 == 0 ? 0 : random() % 100);
    for (int k = 0; k < 4096; ++k) bytes += static_cast<char>(random());
    (void)send(sockets.back().get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  EXPECT_EQ(echo.ask(*client, "after"), "after");
  EXPECT_TRUE(echo.until([&] { return std::ranges::all_of(sockets, ended); }));
}

TEST(ServerSocket, TenThousandConnectionsThatSayNothingCrowdEachOtherOut) {
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
  const std::size_t many = std::min<std::size_t>(10000, files.rlim_cur / 2);
  Echo echo;
  auto client = echo.client();
  ASSERT_EQ(echo.ask(*client, "before"), "before");
  [[maybe_unused]] const std::size_t before = resident_bytes();
  std::vector<Descriptor> sockets;
  std::size_t most = 0;
  for (std::size_t i = 0; i < many; ++i) {
    sockets.push_back(stranger(echo.socket->address(), SOCK_NONBLOCK));
    if (i % 16 == 0) echo.serve(0);
    most = std::max(most, resident_bytes());
  }
  auto late = echo.client();
  EXPECT_EQ(echo.ask(*late, "late", 20s), "late");
  EXPECT_EQ(echo.ask(*client, "after"), "after");
  EXPECT_GT(echo.socket->counts().connections.crowded_out, 100u);
#ifndef __SANITIZE_ADDRESS__  // it keeps what was freed
  EXPECT_LT(most, before + (64u << 20));
#endif
  EXPECT_EQ(echo.socket->clients(), 2u);
}

// A client whose greeting came, and whose first message comes later, outlives a crowd that says
// nothing; and one that is about to greet outlives a crowd of those that greeted.
TEST(ServerSocket, ACrowdDoesNotCutAClientBetweenItsGreetingAndItsFirstMessage) {
  for (const bool greets : {false, true}) {
    SCOPED_TRACE(greets);
    Echo echo;
    const Descriptor first =
        greets ? stranger(echo.socket->address()) : greeted(echo.socket->address());
    if (greets) {
      ASSERT_TRUE(echo.until([&] { return echo.socket->counts().connections.accepted == 1; }));
    }
    std::vector<Descriptor> crowd;
    for (std::uint64_t i = 1; i <= 500; ++i) {
      crowd.push_back(greets ? greeted(echo.socket->address()) : stranger(echo.socket->address()));
      ASSERT_TRUE(echo.until([&] { return echo.socket->counts().connections.accepted == i + 1; }));
    }
    EXPECT_GT(echo.socket->counts().connections.crowded_out, 400u);
    if (greets)
      greet(first);
    else
      EXPECT_FALSE(ended(first));
    const std::string hello("\0\x01x", 3);
    ASSERT_EQ(send(first.get(), hello.data(), hello.size(), 0), static_cast<ssize_t>(hello.size()));
    EXPECT_TRUE(echo.until([&] { return echo.socket->clients() == 1; }));
  }
}

TEST(ServerSocket, AMessageWithoutAnEndIsCut) {
  ServerSocketOptions options;
  options.guard.unfinished_bytes = 2 << 20;
  Echo echo(options);
  const std::size_t before = resident_bytes();
  const Descriptor socket = greeted(echo.socket->address());
  // Frames of 64 KiB with more to come.
  std::string frame("\x03\0\0\0\0\0\x01\0\0", 9);
  frame.resize(9 + 65536, 'x');
  std::size_t sent = 0;
  for (int i = 0; i < 4000 && sent < (1u << 30); ++i) {
    const ssize_t n = send(socket.get(), frame.data() + sent % frame.size(),
                           frame.size() - sent % frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0) sent += static_cast<std::size_t>(n);
    if (n < 0 && errno != EAGAIN) break;
    echo.serve(n < 0 ? 5 : 0);
  }
  EXPECT_TRUE(echo.until([&] { return ended(socket); }));
  EXPECT_EQ(echo.socket->counts().connections.endless, 1u);
  EXPECT_LT(resident_bytes(), before + (160u << 20)) << sent;
}

TEST(ServerSocket, AClientThatDoesNotReadLosesItsOwnMessages) {
  ServerSocketOptions options;
  options.guard.unsent_bytes = 4 << 20;
  Echo echo(options);
  auto quick = echo.client();
  ASSERT_EQ(echo.ask(*quick, "quick"), "quick");
  const ClientId quick_id = echo.last;
  // ZeroMQ of the slow client reads up to 1000 messages for it: a plain connection reads nothing.
  const Descriptor deaf = greeted(echo.socket->address());
  const std::string hello("\0\x01x", 3);
  ASSERT_GT(send(deaf.get(), hello.data(), hello.size(), 0), 0);
  ASSERT_TRUE(echo.until([&] { return echo.last > quick_id; }));
  const ClientId deaf_id = echo.last;
  const std::string picture(1 << 20, 'p');
  int got = 0, lost = 0;
  for (int i = 0; i < 40; ++i) {
    lost += echo.socket->send(deaf_id, {frame_of(picture)}) ? 0 : 1;
    ASSERT_TRUE(echo.socket->send(quick_id, {frame_of(picture)}));
    for (int k = 0; k < 100; ++k) {
      echo.serve(0);
      if (quick->receive(5)) {
        ++got;
        break;
      }
    }
  }
  EXPECT_EQ(got, 40);
  EXPECT_GT(lost, 20);
  EXPECT_EQ(echo.socket->counts().lost, static_cast<std::uint64_t>(lost));
}

TEST(ServerSocket, AClientThatAsksTooFastIsNotHeard) {
  Echo echo({.messages_per_s = 100});
  echo.answers = false;
  auto client = echo.client();
  for (int i = 0; i < 900; ++i) client->send({frame_of("x")});
  ASSERT_TRUE(echo.until([&] { return echo.socket->counts().messages == 900; }));
  EXPECT_LT(echo.names.size(), 300u);
  EXPECT_GE(echo.names.size(), 100u);
  EXPECT_EQ(echo.socket->counts().too_fast, 900 - echo.names.size());
}

TEST(ServerSocket, MoreClientsThanItTakesAreCut) {
  Echo echo({.clients = 3});
  std::vector<std::unique_ptr<ClientSocket>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(echo.client());
    EXPECT_EQ(echo.ask(*clients.back(), "hello"), "hello");
  }
  auto fourth = echo.client();
  EXPECT_EQ(echo.ask(*fourth, "hello", 200ms), std::nullopt);
  EXPECT_GE(echo.socket->counts().too_many, 1u);
  EXPECT_EQ(echo.ask(*clients.front(), "again"), "again");
}

}  // namespace
}  // namespace neritic::net
