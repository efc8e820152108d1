#include "engine/net/client_socket.hpp"

#include "engine/core/refusal.hpp"
#include "engine/net/zmq_parts.hpp"

namespace neritic::net {

struct ClientSocket::Parts {
  ZmqContext context{zmq_ctx_new()};
  ZmqSocket dealer;
};

ClientSocket::ClientSocket(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ClientSocket::~ClientSocket() = default;

Result<std::unique_ptr<ClientSocket>> ClientSocket::connect(const ClientSocketOptions& options) {
  constexpr int kQueued = 1000, kReconnect_ms = 100, kReconnectMost_ms = 2000;
  auto parts = std::make_unique<Parts>();
  parts->dealer.reset(zmq_socket(parts->context.get(), ZMQ_DEALER));
  void* const socket = parts->dealer.get();
  set_option(socket, ZMQ_LINGER, 0);
  set_option(socket, ZMQ_SNDHWM, kQueued);
  set_option(socket, ZMQ_RCVHWM, kQueued);
  set_option(socket, ZMQ_RECONNECT_IVL, kReconnect_ms);
  set_option(socket, ZMQ_RECONNECT_IVL_MAX, kReconnectMost_ms);
  if (options.keys) {
    if (!is_key(options.server_z85))
      return refusal("the server's key", "\"" + options.server_z85 + "\"", "40 characters");
    set_option(socket, ZMQ_CURVE_SERVERKEY, options.server_z85);
    set_option(socket, ZMQ_CURVE_PUBLICKEY, options.keys->public_z85);
    set_option(socket, ZMQ_CURVE_SECRETKEY, options.keys->secret_z85);
  }
  const std::string where = to_text(options.address);
  if (zmq_connect(socket, where.c_str()) != 0)
    return failure(ErrorCode::kIo, "{}: {}", where, zmq_strerror(errno));
  return std::unique_ptr<ClientSocket>(new ClientSocket(std::move(parts)));
}

bool ClientSocket::send(const std::vector<Bytes>& frames) {
  return send_frames(parts_->dealer.get(), frames);
}

std::optional<std::vector<std::vector<std::byte>>> ClientSocket::receive(int wait_ms) {
  void* const socket = parts_->dealer.get();
  zmq_pollitem_t item{socket, 0, ZMQ_POLLIN, 0};
  if (zmq_poll(&item, 1, wait_ms) <= 0) return std::nullopt;
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
