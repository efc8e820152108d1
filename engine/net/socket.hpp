// Non-blocking UDP and TCP sockets of Linux. Receive queues are the kernel's, of a bounded size;
// what they drop is counted. No name is looked up. Each object is one thread's; they are move-only
// and close their socket.
#pragma once

#include <functional>
#include <utility>

#include "engine/core/address.hpp"
#include "engine/core/clock.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

// A file descriptor; closes it.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();
  int get() const { return fd_; }
  bool open() const { return fd_ >= 0; }

 private:
  int fd_;
};

// Gets the bytes of one datagram; cut: it was longer than a packet of a device may be.
using Received = std::function<void(Bytes bytes, bool cut)>;
// The longest datagram that is received whole.
inline constexpr std::size_t kMostDatagram = 4096;
// Bytes that wait in the kernel for a receiver, some 2000 frames of a suit.
inline constexpr int kReceiveQueue = 4 << 20;

class UdpReceiver {
 public:
  // kIo names the address and the reason: the port is taken.
  static Result<UdpReceiver> bind(const Address& address);
  // All that waits, at most `most` datagrams; the number of them. Never waits.
  std::size_t receive(const Received& received, std::size_t most);
  // Datagrams that the full queue dropped so far.
  std::uint64_t overflowed() const { return overflowed_; }
  // While `received` has a datagram: how long that one waited in the kernel, by its own stamps.
  TimeNs waited_ns() const { return waited_ns_; }
  // While `received` has a datagram: the IPv4 address that it came from, in the host's order.
  std::uint32_t from() const { return from_; }
  int descriptor() const { return socket_.get(); }
  // Where port 0 was asked for, the port that the system chose.
  std::uint16_t port() const;

 private:
  explicit UdpReceiver(Descriptor socket) : socket_(std::move(socket)) {}

  Descriptor socket_;
  std::vector<std::byte> buffer_;
  std::uint64_t overflowed_ = 0;
  TimeNs waited_ns_ = 0;
  std::uint32_t from_ = 0;
};

class UdpSender {
 public:
  static Result<UdpSender> create(const Address& to);
  // False: the system did not take it (nobody listens, or its queue is full). Never waits.
  bool send(Bytes bytes) const;
  // Several at once; how many of the first ones the system took.
  std::size_t send(std::span<const std::vector<std::byte>> datagrams) const;

 private:
  UdpSender(Descriptor socket, const Address& to) : socket_(std::move(socket)), to_(to) {}

  Descriptor socket_;
  Address to_;
};

// The receiving end of one TCP stream at a time: waits for senders (listen), or goes to one
// (connect). A listener uses the first sender. A later one waits, its bytes dropped, and replaces
// the first as soon as that one ends or was silent for kReplaced_ns; of several that wait the
// newest does, and the others are closed. A stream that was connected to and is silent for
// kReconnect_ns is closed and connected again, at most once a second. A peer that does not answer
// the kernel any more is found by keepalives within kKeepAlive_s.
class TcpReceiver {
 public:
  enum class Way { kListen, kConnect };
  // kIo names the address and the reason.
  static Result<TcpReceiver> open(const Address& address, Way way);
  // Gives all bytes that wait, at most 64 KiB at a time, in order. An end of the stream, or its
  // replacement by another, gives no bytes and `cut`. Never waits.
  void receive(const Received& received);
  bool connected() const { return stream_.open() && !connecting_; }
  // The sender that waits while another one is used, as "192.168.1.20"; empty: none does.
  std::string_view waiting() const { return waiting_.open() ? waiting_from_ : std::string_view(); }
  // The socket that says next that something came; -1: none before the next attempt.
  int descriptor() const { return stream_.open() ? stream_.get() : listener_.get(); }
  // Whether it waits for a connection to become writable.
  bool connecting() const { return connecting_; }

  static constexpr TimeNs kReplaced_ns = 1'000'000'000, kReconnect_ns = 3'000'000'000;
  static constexpr int kKeepAlive_s = 6;

 private:
  TcpReceiver(const Address& address, Way way) : address_(address), way_(way) {}
  void accept();
  bool attempt();
  bool take_waiting();
  void connect_again();
  bool read(const Received& received);
  void drop_waiting();

  Address address_;
  Way way_;
  Descriptor listener_, stream_, waiting_;
  std::string waiting_from_;
  TimeNs heard_ns_ = 0;  // the newest bytes of the stream, or its beginning
  bool connecting_ = false;
  std::int64_t next_attempt_ns_ = 0;
  std::vector<std::byte> buffer_;
};

// The sending end of one TCP stream.
class TcpSender {
 public:
  // Connects, at most a second long. kIo names the address and the reason.
  static Result<TcpSender> connect(const Address& to);
  // False: the stream broke, maybe within these bytes, and is of no more use. Waits while the
  // receiver does not read, at most a second.
  bool send(Bytes bytes);

 private:
  explicit TcpSender(Descriptor socket) : socket_(std::move(socket)) {}

  Descriptor socket_;
};

}  // namespace neritic::net
