// Bounds what the connections of a listening socket cost, by what the kernel says of them: how many
// there are, how many did not finish their handshake, how many bytes came without making a whole
// message, how many were sent and not yet received. ZeroMQ itself bounds messages only: a stranger
// may hold connections open, or send parts of a message without an end.
//
// The guard has its own descriptor of each connection, so that a number which the system gives
// again means no other one. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/net/socket.hpp"

namespace neritic::net {

struct GuardLimits {
  std::size_t connections = 160;
  std::size_t half_open = 64;                    // without a finished handshake
  std::uint64_t unfinished_bytes = 16ull << 20;  // received since the last whole message
  std::uint64_t unsent_bytes = 64ull << 20;      // sent, and not received by the other side
};

class ConnectionGuard {
 public:
  struct Counts {
    std::uint64_t accepted = 0;
    std::uint64_t crowded_out = 0;  // cut, or their elder was, since there were too many
    std::uint64_t endless = 0;      // cut: bytes that made no whole message
  };

  explicit ConnectionGuard(const GuardLimits& limits) : limits_(limits) {}

  // Where there are too many, the eldest without a handshake is cut: of those that sent nothing, if
  // these are more than half of half_open, else of the others.
  void accepted(int fd);
  void closed(int fd);
  // A whole message came from it; with the first its handshake is finished.
  void heard(int fd);
  // Whether these bytes may still be sent to it; counts them as sent if so.
  bool send(int fd, std::uint64_t bytes);
  // Cuts those that send without an end. Some times a second.
  void look();
  void cut(int fd);

  bool has(int fd) const { return connections_.contains(fd); }
  std::size_t connections() const { return connections_.size(); }
  const Counts& counts() const { return counts_; }

 private:
  struct Connection {
    Descriptor own;
    std::uint64_t number = 0;  // rises: the eldest has the lowest
    bool heard = false, cut = false;
    bool greeted = false;        // it sent something, at the last look of crowd_out()
    std::uint64_t received = 0;  // at its last whole message
    std::uint64_t sent = 0;      // by messages, since the start
  };
  void crowd_out();
  static void cut(Connection& connection);

  GuardLimits limits_;
  std::map<int, Connection> connections_;  // by the socket's descriptor
  std::uint64_t next_ = 0;
  std::size_t half_open_ = 0;
  Counts counts_;
};

}  // namespace neritic::net
