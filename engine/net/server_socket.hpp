// The listening end of a server: messages of many clients over ZeroMQ (ROUTER; the clients are
// DEALERs), each a list of frames. Beyond this machine only with CURVE keys. Every bound is here
// and in ConnectionGuard: what a stranger sends costs no more than these, and a client that does
// not read loses its own messages. One thread, but for wake().
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/address.hpp"
#include "engine/net/connection_guard.hpp"
#include "engine/net/curve_keys.hpp"

namespace neritic::net {

struct ServerSocketOptions {
  Address address{Transport::kTcp, 0x7f000001, 47910};  // port 0: the system chooses one
  std::optional<ServerKeys> keys;                       // nullopt: without, on this machine only
  std::size_t clients = 64;
  std::int64_t frame_bytes = std::int64_t{4} << 20;  // longest frame of a client
  std::size_t frames = 8;                            // most frames of a client's message
  double messages_per_s = 20e3, bytes_per_s = 64e6;  // of each client; beyond: not heard
  int handshake_ms = 3000;
  GuardLimits guard;
};

using ClientId = std::uint64_t;  // never the same twice

// Frames of a client's message. Valid while the receiver is called.
struct ClientMessage {
  ClientId client = 0;
  std::string_view name;  // of its key; empty without keys
  std::vector<Bytes> frames;
};

class ServerSocket {
 public:
  struct Counts {
    std::uint64_t messages = 0;
    std::uint64_t too_fast = 0;     // not heard: over the rate
    std::uint64_t too_many = 0;     // not heard: over the number of frames, or of clients
    std::uint64_t lost = 0;         // not sent: the client does not read
    std::uint64_t not_known = 0;    // keys that are not the list's
    std::uint64_t no_greeting = 0;  // handshakes that failed
    ConnectionGuard::Counts connections;
  };
  struct Events {
    std::function<void(const ClientMessage&)> heard;
    std::function<void(ClientId)> gone;
  };

  // kBadInput for an address beyond this machine without keys, kIo for a port that is taken.
  static Result<std::unique_ptr<ServerSocket>> bind(const ServerSocketOptions& options);
  ~ServerSocket();

  // Waits for messages, at most so long, or until wake(); gives at most some hundreds.
  void serve(int wait_ms, const Events& events);
  // Any thread: serve() returns soon.
  void wake();

  // False: lost and counted, as the client is gone or does not read. Never waits.
  bool send(ClientId client, const std::vector<Bytes>& frames);
  // Ends the connection of a client.
  void cut(ClientId client);

  Address address() const { return address_; }
  std::size_t clients() const;
  Counts counts() const;

 private:
  struct Parts;
  explicit ServerSocket(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  Address address_;
};

}  // namespace neritic::net
