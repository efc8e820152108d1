#include "engine/net/client_socket.hpp"

#include <algorithm>
#include <chrono>

#include "engine/core/refusal.hpp"
#include "engine/net/zmq_parts.hpp"

namespace neritic::net {

struct ClientSocket::Parts {
  void read_monitor();

  // In the order in which they are made: each ends before what it uses.
  ZmqContext context{zmq_ctx_new()};
  ZmqSocket monitor, dealer;
  bool there = false;  // the connection
  std::uint64_t closures = 0;
};

void ClientSocket::Parts::read_monitor() {
  for (;;) {
    ZmqMessage event, where;  // 16 bits of event, 32 of value; the address
    if (!event.receive(monitor.get())) return;
    if (event.more()) (void)where.receive(monitor.get());
    std::uint16_t number = 0;
    if (event.bytes().size() < sizeof number) continue;
    std::memcpy(&number, event.bytes().data(), sizeof number);
    if (number != ZMQ_EVENT_HANDSHAKE_SUCCEEDED && there) ++closures;
    there = number == ZMQ_EVENT_HANDSHAKE_SUCCEEDED;
  }
}

ClientSocket::ClientSocket(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ClientSocket::~ClientSocket() = default;

Result<std::unique_ptr<ClientSocket>> ClientSocket::connect(const ClientSocketOptions& options) {
  constexpr int kQueued = 1000, kReconnect_ms = 100, kReconnectMost_ms = 2000;
  constexpr int kHeartbeat_ms = 5000, kDead_ms = 15000;
  // A server in a crowd drops the first packet of connections. The kernel would send it again after
  // 1, 3, 7 and 15 s; a new attempt begins at once.
  constexpr int kConnect_ms = 2000;
  constexpr const char* kMonitor = "inproc://neritic.client.monitor";
  auto parts = std::make_unique<Parts>();
  parts->dealer.reset(zmq_socket(parts->context.get(), ZMQ_DEALER));
  void* const socket = parts->dealer.get();
  set_option(socket, ZMQ_LINGER, 0);
  set_option(socket, ZMQ_SNDHWM, kQueued);
  set_option(socket, ZMQ_RCVHWM, kQueued);
  set_option(socket, ZMQ_RECONNECT_IVL, kReconnect_ms);
  set_option(socket, ZMQ_RECONNECT_IVL_MAX, kReconnectMost_ms);
  set_option(socket, ZMQ_CONNECT_TIMEOUT, kConnect_ms);
  set_option(socket, ZMQ_HEARTBEAT_IVL, kHeartbeat_ms);
  set_option(socket, ZMQ_HEARTBEAT_TIMEOUT, kDead_ms);
  if (zmq_socket_monitor(socket, kMonitor,
                         ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_DISCONNECTED) != 0)
    return failure(ErrorCode::kInternal, "{}: {}", kMonitor, zmq_strerror(errno));
  parts->monitor.reset(zmq_socket(parts->context.get(), ZMQ_PAIR));
  set_option(parts->monitor.get(), ZMQ_LINGER, 0);
  if (zmq_connect(parts->monitor.get(), kMonitor) != 0)
    return failure(ErrorCode::kInternal, "{}: {}", kMonitor, zmq_strerror(errno));
  if (options.keys) {
    if (!is_key(options.server_z85))
      return refusal("the server's key", fmt::format("'{}'", options.server_z85), "40 characters");
    set_option(socket, ZMQ_CURVE_SERVERKEY, options.server_z85);
    set_option(socket, ZMQ_CURVE_PUBLICKEY, options.keys->public_z85);
    set_option(socket, ZMQ_CURVE_SECRETKEY, options.keys->secret_z85);
  }
  const std::string where = to_text(options.address);
  if (zmq_connect(socket, where.c_str()) != 0)
    return failure(ErrorCode::kIo, "{}: {}", where, zmq_strerror(errno));
  return std::unique_ptr<ClientSocket>(new ClientSocket(std::move(parts)));
}

std::uint64_t ClientSocket::closures() {
  parts_->read_monitor();
  return parts_->closures;
}

bool ClientSocket::closed() {
  parts_->read_monitor();
  return parts_->closures > 0 && !parts_->there;
}

bool ClientSocket::send(const std::vector<Bytes>& frames) {
  return send_frames(parts_->dealer.get(), frames);
}

std::optional<std::vector<std::vector<std::byte>>> ClientSocket::receive(int wait_ms) {
  void* const socket = parts_->dealer.get();
  zmq_pollitem_t items[] = {{socket, 0, ZMQ_POLLIN, 0}, {parts_->monitor.get(), 0, ZMQ_POLLIN, 0}};
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait_ms);
  do {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (zmq_poll(items, 2, std::max<long>(left.count(), 0)) <= 0) return std::nullopt;
    const std::uint64_t before = parts_->closures;
    parts_->read_monitor();
    if (!(items[0].revents & ZMQ_POLLIN) && parts_->closures > before) return std::nullopt;
  } while (!(items[0].revents & ZMQ_POLLIN));
  std::vector<std::vector<std::byte>> frames;
  for (bool more = true; more;) {
    ZmqMessage frame;
    if (!frame.receive(socket)) return std::nullopt;
    const Bytes bytes = frame.bytes();
    frames.emplace_back(bytes.begin(), bytes.end());
    more = frame.more();
  }
  return frames;
}

}  // namespace neritic::net
