// A client's end of a server (server_socket.hpp): a ZeroMQ DEALER. One thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/address.hpp"
#include "engine/net/curve_keys.hpp"
#include "engine/net/socket.hpp"

namespace neritic::net {

struct ClientSocketOptions {
  Address address{Transport::kTcp, 0x7f000001, 47910};
  // Both or none: its own pair, and the server's public key.
  std::optional<KeyPair> keys;
  std::string server_z85;
};

class ClientSocket {
 public:
  // Returns at once; the library connects, and connects again, by itself.
  static Result<std::unique_ptr<ClientSocket>> connect(const ClientSocketOptions& options);
  ~ClientSocket();

  // How often a connection was closed after it stood. closed(): one stood, and none stands now.
  std::uint64_t closures();
  bool closed();

  // False: too much waits to be sent.
  bool send(const std::vector<Bytes>& frames);
  // The frames of the next message; nothing if none came for so long, or the connection
  // ended meanwhile.
  std::optional<std::vector<std::vector<std::byte>>> receive(int wait_ms);

 private:
  struct Parts;
  explicit ClientSocket(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace neritic::net
