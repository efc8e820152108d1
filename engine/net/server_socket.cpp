#include "engine/net/server_socket.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "engine/core/refusal.hpp"
#include "engine/core/thread_urgency.hpp"
#include "engine/net/rate.hpp"
#include "engine/net/zmq_parts.hpp"

namespace neritic::net {
namespace {

constexpr int kMessagesAtOnce = 256;  // of one serve()
constexpr int kQueuedMessages = 64;   // of each client, each way; bytes are the guard's
// Connections that wait for the library: as many as the kernel allows (net.core.somaxconn, 4096),
// since it drops the first packet of any more, and a client's next one comes seconds later.
constexpr int kBacklog = 65535;
constexpr int kHeartbeat_ms = 5000, kDead_ms = 15000;
constexpr TimeNs kLook_ns = 100'000'000;  // between two looks of the guard
constexpr const char* kMonitor = "inproc://neritic.monitor";
constexpr const char* kZap = "inproc://zeromq.zap.01";

// A whole message's frames. False: there is none.
bool receive_all(void* socket, std::size_t most, std::vector<std::unique_ptr<ZmqMessage>>& frames,
                 bool& too_many) {
  frames.clear();
  too_many = false;
  for (;;) {
    auto frame = std::make_unique<ZmqMessage>();
    if (!frame->receive(socket)) return false;  // the frames of a message come together
    const bool more = frame->more();
    if (frames.size() < most)
      frames.push_back(std::move(frame));
    else
      too_many = true;
    if (!more) return true;
  }
}

std::string routing_name(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

struct ServerSocket::Parts {
  explicit Parts(const ServerSocketOptions& wanted) : options(wanted), guard(wanted.guard) {}

  struct Client {
    std::string routing, name;
    int fd = -1;
    Rate messages, bytes;
  };

  Status open();
  void configure();
  void read_monitor(const Events& events);
  void answer_zap();
  bool hear(const Events& events);
  ClientId client_of(int fd, const std::string& routing, std::string_view name,
                     const Events& events);
  void forget(int fd, const Events& events);

  ServerSocketOptions options;
  ConnectionGuard guard;
  Descriptor wakeup{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  // In the order in which they are made: each ends before what it uses.
  ZmqContext context{zmq_ctx_new()};
  ZmqSocket zap, monitor, router;
  std::map<ClientId, Client> clients;
  std::map<int, ClientId> by_fd;
  ClientId next = 1;
  TimeNs looked_ns = 0;
  Counts counts;
  std::vector<std::unique_ptr<ZmqMessage>> frames;
};

void ServerSocket::Parts::configure() {
  void* socket = router.get();
  set_option(socket, ZMQ_LINGER, 0);
  set_option(socket, ZMQ_ROUTER_MANDATORY, 1);
  set_option(socket, ZMQ_RCVHWM, kQueuedMessages);
  set_option(socket, ZMQ_SNDHWM, kQueuedMessages);
  set_option(socket, ZMQ_BACKLOG, kBacklog);
  set_option(socket, ZMQ_HANDSHAKE_IVL, options.handshake_ms);
  set_option(socket, ZMQ_HEARTBEAT_IVL, kHeartbeat_ms);
  set_option(socket, ZMQ_HEARTBEAT_TIMEOUT, kDead_ms);
  NERITIC_CHECK(
      zmq_setsockopt(socket, ZMQ_MAXMSGSIZE, &options.frame_bytes, sizeof options.frame_bytes) == 0,
      "longest frame");
  if (!options.keys) return;
  set_option(socket, ZMQ_CURVE_SERVER, 1);
  set_option(socket, ZMQ_CURVE_SECRETKEY, options.keys->server.secret_z85);
  set_option(socket, ZMQ_ZAP_DOMAIN, std::string("neritic"));
}

Status ServerSocket::Parts::open() {
  // On the thread that calls this: those of the library inherit its priority and give way to the
  // dive's, which keeps its steps under a flood of strangers.
  set_urgency(ThreadUrgency::kInput);
  if (options.keys) {
    zap.reset(zmq_socket(context.get(), ZMQ_REP));
    if (zmq_bind(zap.get(), kZap) != 0)
      return failure(ErrorCode::kInternal, "{}: {}", kZap, zmq_strerror(errno));
  }
  router.reset(zmq_socket(context.get(), ZMQ_ROUTER));
  configure();
  if (zmq_socket_monitor(
          router.get(), kMonitor,
          ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
              ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) != 0)
    return failure(ErrorCode::kInternal, "{}: {}", kMonitor, zmq_strerror(errno));
  monitor.reset(zmq_socket(context.get(), ZMQ_PAIR));
  set_option(monitor.get(), ZMQ_LINGER, 0);
  if (zmq_connect(monitor.get(), kMonitor) != 0)
    return failure(ErrorCode::kInternal, "{}: {}", kMonitor, zmq_strerror(errno));
  const std::string where = to_text(options.address);
  if (zmq_bind(router.get(), where.c_str()) != 0)
    return failure(ErrorCode::kIo, "{}: {}", where, zmq_strerror(errno));
  return {};
}

ServerSocket::ServerSocket(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ServerSocket::~ServerSocket() = default;

Result<std::unique_ptr<ServerSocket>> ServerSocket::bind(const ServerSocketOptions& options) {
  if (!options.keys && !options.address.loopback())
    return refusal(to_text(options.address), "an address beyond this machine without keys",
                   "127.x.x.x, or keys (neritic keys FOLDER)");
  auto parts = std::make_unique<Parts>(options);
  Status opened;
  std::thread([&] { opened = parts->open(); }).join();
  if (!opened.ok()) return opened.error();
  char text[64] = {};
  std::size_t size = sizeof text;
  NERITIC_CHECK(zmq_getsockopt(parts->router.get(), ZMQ_LAST_ENDPOINT, text, &size) == 0,
                "endpoint");
  NERITIC_TRY(const Address address, parse_address(text));
  std::unique_ptr<ServerSocket> server(new ServerSocket(std::move(parts)));
  server->address_ = address;
  return server;
}

void ServerSocket::wake() {
  const std::uint64_t one = 1;
  (void)!::write(parts_->wakeup.get(), &one, sizeof one);
}

std::size_t ServerSocket::clients() const {
  return parts_->clients.size();
}

ServerSocket::Counts ServerSocket::counts() const {
  Counts counts = parts_->counts;
  counts.connections = parts_->guard.counts();
  return counts;
}

void ServerSocket::Parts::forget(int fd, const Events& events) {
  guard.closed(fd);
  const auto at = by_fd.find(fd);
  if (at == by_fd.end()) return;
  const ClientId client = at->second;
  by_fd.erase(at);
  clients.erase(client);
  events.gone(client);
}

void ServerSocket::Parts::read_monitor(const Events& events) {
  bool too_many = false;
  std::vector<std::unique_ptr<ZmqMessage>> parts;
  while (receive_all(monitor.get(), 2, parts, too_many)) {
    const Bytes bytes = parts.front()->bytes();
    if (bytes.size() < 6) continue;
    // In the byte order of this machine.
    std::uint16_t event = 0;
    std::int32_t value = 0;
    std::memcpy(&event, bytes.data(), sizeof event);
    std::memcpy(&value, bytes.data() + sizeof event, sizeof value);
    if (event == ZMQ_EVENT_ACCEPTED) {
      forget(value, events);  // whose end was not told yet
      guard.accepted(value);
    } else if (event == ZMQ_EVENT_DISCONNECTED) {
      forget(value, events);
    } else {
      ++counts.no_greeting;
    }
  }
}

// RFC 27: version, request, domain, address, identity, mechanism, key.
void ServerSocket::Parts::answer_zap() {
  bool too_many = false;
  std::vector<std::unique_ptr<ZmqMessage>> asked;
  while (receive_all(zap.get(), 7, asked, too_many)) {
    std::string name;
    if (asked.size() == 7 && !too_many && asked[5]->text() == "CURVE" &&
        asked[6]->bytes().size() == 32) {
      char key[41];
      zmq_z85_encode(key, static_cast<const std::uint8_t*>(zmq_msg_data(asked[6]->get())), 32);
      if (const auto at = options.keys->clients.find(key); at != options.keys->clients.end())
        name = at->second;
    }
    counts.not_known += name.empty() ? 1 : 0;
    const std::string request(asked.size() > 1 ? asked[1]->text() : std::string_view());
    const std::string_view answer[] = {
        "1.0", request, name.empty() ? "400" : "200", name.empty() ? "this key is not known" : "OK",
        name,  ""};
    for (std::size_t i = 0; i < std::size(answer); ++i)
      (void)zmq_send(zap.get(), answer[i].data(), answer[i].size(),
                     i + 1 < std::size(answer) ? ZMQ_SNDMORE : 0);
  }
}

ClientId ServerSocket::Parts::client_of(int fd, const std::string& routing, std::string_view name,
                                        const Events& events) {
  if (const auto at = by_fd.find(fd); at != by_fd.end()) {
    if (clients.at(at->second).routing == routing) return at->second;
    forget(fd, events);
    guard.accepted(fd);
  }
  if (clients.size() >= options.clients) return 0;
  const ClientId client = next++;
  clients.emplace(client, Client{routing, std::string(name), fd, Rate(options.messages_per_s),
                                 Rate(options.bytes_per_s)});
  by_fd[fd] = client;
  return client;
}

bool ServerSocket::Parts::hear(const Events& events) {
  bool too_many = false;
  if (!receive_all(router.get(), options.frames + 1, frames, too_many)) return false;
  ++counts.messages;
  zmq_msg_t* const first = frames.back()->get();
  const int fd = zmq_msg_get(first, ZMQ_SRCFD);
  read_monitor(events);             // the connection was accepted before its message came
  if (!guard.has(fd)) return true;  // it ended meanwhile
  guard.heard(fd);
  if (too_many || frames.size() < 2) {
    ++counts.too_many;
    return true;
  }
  const char* name = options.keys ? zmq_msg_gets(first, "User-Id") : nullptr;
  const ClientId id =
      client_of(fd, routing_name(frames.front()->bytes()), name ? name : "", events);
  if (id == 0) {
    ++counts.too_many;
    guard.cut(fd);
    return true;
  }
  Client& client = clients.at(id);
  ClientMessage message{id, client.name, {}};
  double bytes = 0.0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    message.frames.push_back(frames[i]->bytes());
    bytes += static_cast<double>(message.frames.back().size());
  }
  const TimeNs now = now_ns();
  if (!client.messages.take(1.0, now) || !client.bytes.take(bytes, now)) {
    ++counts.too_fast;
    return true;
  }
  events.heard(message);
  return true;
}

void ServerSocket::serve(int wait_ms, const Events& events) {
  Parts& parts = *parts_;
  zmq_pollitem_t items[] = {{parts.router.get(), 0, ZMQ_POLLIN, 0},
                            {parts.monitor.get(), 0, ZMQ_POLLIN, 0},
                            {nullptr, parts.wakeup.get(), ZMQ_POLLIN, 0},
                            {parts.zap.get(), 0, ZMQ_POLLIN, 0}};
  (void)zmq_poll(items, parts.zap ? 4 : 3, wait_ms);
  std::uint64_t wakes = 0;
  (void)!::read(parts.wakeup.get(), &wakes, sizeof wakes);
  parts.read_monitor(events);
  if (parts.zap) parts.answer_zap();
  for (int i = 0; i < kMessagesAtOnce && parts.hear(events); ++i) {
  }
  const TimeNs now = now_ns();
  if (now - parts.looked_ns < kLook_ns) return;
  parts.looked_ns = now;
  parts.guard.look();
}

bool ServerSocket::send(ClientId id, const std::vector<Bytes>& frames) {
  Parts& parts = *parts_;
  const auto at = parts.clients.find(id);
  if (at == parts.clients.end() || frames.empty()) return false;
  std::uint64_t bytes = 0;
  for (const Bytes frame : frames) bytes += frame.size();
  void* const socket = parts.router.get();
  const std::string& routing = at->second.routing;
  // Only the first part can fail: the library takes or leaves a message as a whole.
  if (!parts.guard.send(at->second.fd, bytes) ||
      zmq_send(socket, routing.data(), routing.size(), ZMQ_SNDMORE | ZMQ_DONTWAIT) < 0) {
    ++parts.counts.lost;
    return false;
  }
  return send_frames(socket, frames);
}

void ServerSocket::cut(ClientId id) {
  const auto at = parts_->clients.find(id);
  if (at != parts_->clients.end()) parts_->guard.cut(at->second.fd);
}

}  // namespace neritic::net
