#include "engine/net/connection_guard.hpp"

#include <fcntl.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

namespace neritic::net {
namespace {

struct SoFar {
  std::uint64_t received = 0, acknowledged = 0;
};

std::optional<SoFar> bytes_so_far(int fd) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return std::nullopt;
  return SoFar{info.tcpi_bytes_received, info.tcpi_bytes_acked};
}

}  // namespace

void ConnectionGuard::cut(Connection& connection) {
  if (connection.cut) return;
  connection.cut = true;
  // A reset, at once: after a shutdown what the other side goes on sending would still be read.
  sockaddr nobody{};
  nobody.sa_family = AF_UNSPEC;
  (void)connect(connection.own.get(), &nobody, sizeof nobody);
}

void ConnectionGuard::accepted(int fd) {
  closed(fd);  // the notice of its end may be late
  ++counts_.accepted;
  Connection connection{.own = Descriptor(fcntl(fd, F_DUPFD_CLOEXEC, 0)), .number = next_++};
  if (!connection.own.open()) return;  // it ended already
  connections_.emplace(fd, std::move(connection));
  ++half_open_;
  if (half_open_ > limits_.half_open || connections_.size() > limits_.connections) crowd_out();
}

// Those that sent nothing, and those that greeted, have half of the room each. A crowd of the first
// does not cut a client between its greeting and its first message, which would be lost; a crowd of
// the second does not cut one that is about to greet.
void ConnectionGuard::crowd_out() {
  Connection *silent = nullptr, *greeted = nullptr;
  std::size_t silent_ones = 0;
  for (auto& [fd, one] : connections_) {
    if (one.heard || one.cut) continue;
    if (!one.greeted) {
      const auto so_far = bytes_so_far(one.own.get());
      one.greeted = so_far && so_far->received > 0;
    }
    silent_ones += one.greeted ? 0 : 1;
    Connection*& eldest = one.greeted ? greeted : silent;
    if (!eldest || one.number < eldest->number) eldest = &one;
  }
  const bool silent_goes = silent && (!greeted || silent_ones > limits_.half_open / 2);
  Connection* const goes = silent_goes ? silent : greeted;
  if (!goes) return;
  ++counts_.crowded_out;
  cut(*goes);
}

void ConnectionGuard::closed(int fd) {
  const auto at = connections_.find(fd);
  if (at == connections_.end()) return;
  half_open_ -= at->second.heard ? 0 : 1;
  connections_.erase(at);
}

void ConnectionGuard::heard(int fd) {
  const auto at = connections_.find(fd);
  if (at == connections_.end()) return;
  if (!std::exchange(at->second.heard, true)) --half_open_;
  if (const auto bytes = bytes_so_far(at->second.own.get())) at->second.received = bytes->received;
}

bool ConnectionGuard::send(int fd, std::uint64_t bytes) {
  const auto at = connections_.find(fd);
  if (at == connections_.end()) return false;
  Connection& connection = at->second;
  if (const auto so_far = bytes_so_far(connection.own.get())) {
    // The bytes that the transport adds to messages must not make room for more of them.
    connection.sent = std::max(connection.sent, so_far->acknowledged);
    if (connection.sent - so_far->acknowledged + bytes > limits_.unsent_bytes) return false;
  }
  connection.sent += bytes;
  return true;
}

void ConnectionGuard::look() {
  for (auto& [fd, one] : connections_) {
    if (one.cut) continue;
    const auto so_far = bytes_so_far(one.own.get());
    if (!so_far || so_far->received - one.received <= limits_.unfinished_bytes) continue;
    ++counts_.endless;
    cut(one);
  }
}

void ConnectionGuard::cut(int fd) {
  const auto at = connections_.find(fd);
  if (at != connections_.end()) cut(at->second);
}

}  // namespace neritic::net
