#include "engine/net/socket.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "engine/core/clock.hpp"

namespace neritic::net {
namespace {

constexpr std::size_t kBatch = 64, kStreamRead = 64 << 10;
constexpr int kWait_ms = 1000, kProbes = 3, kMostCallers = 16;
constexpr TimeNs kRetry_ns = 1'000'000'000;
// A stamp that is older says that the clock was set.
constexpr TimeNs kMostWaited_ns = 1'000'000'000;
constexpr std::size_t kControl = 64;  // bytes: the count of drops, and a stamp

TimeNs ns_of(const timespec& time) {
  return TimeNs{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// On the clock of the kernel's stamps.
TimeNs wall_ns() {
  timespec time{};
  (void)::clock_gettime(CLOCK_REALTIME, &time);
  return ns_of(time);
}

// Takes what the kernel says of a datagram; the rest stays as it is.
void read_control(msghdr& message, std::uint64_t& drops, TimeNs& stamp_ns) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t count = 0;
      std::memcpy(&count, CMSG_DATA(c), sizeof count);
      drops = count;
    } else if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      stamp_ns = ns_of(stamp);
    }
  }
}

sockaddr_in system_address(const Address& address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(address.ipv4);
  out.sin_port = htons(address.port);
  return out;
}

Error socket_error(const Address& address, std::string_view what, int error) {
  return failure(ErrorCode::kIo, "{}: {}: {}", to_text(address), what, std::strerror(error));
}

Descriptor new_socket(int type) {
  return Descriptor(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

Status bind_to(const Descriptor& socket, const Address& address) {
  const sockaddr_in to = system_address(address);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    return socket_error(address, "cannot listen there", errno);
  return {};
}

void set(const Descriptor& socket, int level, int option, int value) {
  (void)::setsockopt(socket.get(), level, option, &value, sizeof value);
}

bool wait_for(const Descriptor& socket, short events) {
  pollfd wanted{socket.get(), events, 0};
  return ::poll(&wanted, 1, kWait_ms) == 1;
}

// A peer that is gone without a word is asked after 3 s of silence, three times.
void keep_alive(const Descriptor& socket) {
  set(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(socket, IPPROTO_TCP, TCP_KEEPIDLE, TcpReceiver::kKeepAlive_s - kProbes);
  set(socket, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set(socket, IPPROTO_TCP, TCP_KEEPCNT, kProbes);
}

// Whether a stream is over, by what recv() gave.
bool ended(ssize_t got) {
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

int pending_error(const Descriptor& socket) {
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Result<UdpReceiver> UdpReceiver::bind(const Address& address) {
  Descriptor socket = new_socket(SOCK_DGRAM);
  if (!socket.open()) return socket_error(address, "no socket", errno);
  set(socket, SOL_SOCKET, SO_RCVBUF, kReceiveQueue);
  set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  NERITIC_TRY_STATUS(bind_to(socket, address));
  UdpReceiver out(std::move(socket));
  out.buffer_.resize(kBatch * kMostDatagram);
  return out;
}

std::uint16_t UdpReceiver::port() const {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  (void)::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&at), &size);
  return ntohs(at.sin_port);
}

std::size_t UdpReceiver::receive(const Received& received, std::size_t most) {
  std::array<mmsghdr, kBatch> messages{};
  std::array<iovec, kBatch> parts{};
  std::array<sockaddr_in, kBatch> senders{};
  alignas(cmsghdr) std::array<std::array<char, kControl>, kBatch> control{};
  std::size_t total = 0;
  while (total < most) {
    const std::size_t wanted = std::min(kBatch, most - total);
    for (std::size_t i = 0; i < wanted; ++i) {
      parts[i] = {buffer_.data() + i * kMostDatagram, kMostDatagram};
      messages[i].msg_hdr = {};
      messages[i].msg_hdr.msg_iov = &parts[i];
      messages[i].msg_hdr.msg_iovlen = 1;
      messages[i].msg_hdr.msg_name = &senders[i];
      messages[i].msg_hdr.msg_namelen = sizeof senders[i];
      messages[i].msg_hdr.msg_control = control[i].data();
      messages[i].msg_hdr.msg_controllen = kControl;
    }
    const int got = ::recvmmsg(socket_.get(), messages.data(), static_cast<unsigned>(wanted),
                               MSG_DONTWAIT, nullptr);
    if (got <= 0) break;
    const TimeNs now = wall_ns();
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
      TimeNs stamp_ns = now;
      read_control(messages[i].msg_hdr, overflowed_, stamp_ns);
      waited_ns_ = now - stamp_ns < kMostWaited_ns ? std::max<TimeNs>(now - stamp_ns, 0) : 0;
      from_ = ntohl(senders[i].sin_addr.s_addr);
      received(Bytes(buffer_).subspan(i * kMostDatagram, messages[i].msg_len),
               (messages[i].msg_hdr.msg_flags & MSG_TRUNC) != 0);
    }
    total += static_cast<std::size_t>(got);
    if (static_cast<std::size_t>(got) < wanted) break;
  }
  return total;
}

Result<UdpSender> UdpSender::create(const Address& to) {
  Descriptor socket = new_socket(SOCK_DGRAM);
  if (!socket.open()) return socket_error(to, "no socket", errno);
  return UdpSender(std::move(socket), to);
}

bool UdpSender::send(Bytes bytes) const {
  const sockaddr_in to = system_address(to_);
  return ::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&to),
                  sizeof to) == static_cast<ssize_t>(bytes.size());
}

std::size_t UdpSender::send(std::span<const std::vector<std::byte>> datagrams) const {
  sockaddr_in to = system_address(to_);
  std::array<mmsghdr, kBatch> messages{};
  std::array<iovec, kBatch> parts{};
  std::size_t total = 0;
  while (total < datagrams.size()) {
    const std::size_t wanted = std::min(kBatch, datagrams.size() - total);
    for (std::size_t i = 0; i < wanted; ++i) {
      const auto& bytes = datagrams[total + i];
      parts[i] = {const_cast<std::byte*>(bytes.data()), bytes.size()};
      messages[i].msg_hdr = {};
      messages[i].msg_hdr.msg_name = &to;
      messages[i].msg_hdr.msg_namelen = sizeof to;
      messages[i].msg_hdr.msg_iov = &parts[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
    const int sent = ::sendmmsg(socket_.get(), messages.data(), static_cast<unsigned>(wanted),
                                MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent <= 0) break;
    total += static_cast<std::size_t>(sent);
    if (static_cast<std::size_t>(sent) < wanted) break;
  }
  return total;
}

Result<TcpReceiver> TcpReceiver::open(const Address& address, Way way) {
  TcpReceiver out(address, way);
  out.buffer_.resize(kStreamRead);
  if (way == Way::kConnect) return out;
  out.listener_ = new_socket(SOCK_STREAM);
  if (!out.listener_.open()) return socket_error(address, "no socket", errno);
  set(out.listener_, SOL_SOCKET, SO_REUSEADDR, 1);
  NERITIC_TRY_STATUS(bind_to(out.listener_, address));
  if (::listen(out.listener_.get(), 1) != 0)
    return socket_error(address, "cannot listen there", errno);
  return out;
}

// Takes all who called: the first one is used, the newest other one waits.
void TcpReceiver::accept() {
  for (int i = 0; i < kMostCallers; ++i) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    Descriptor caller(::accept4(listener_.get(), reinterpret_cast<sockaddr*>(&from), &size,
                                SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!caller.open()) return;
    keep_alive(caller);
    waiting_ = std::move(caller);
    if (take_waiting()) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    (void)::inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
    waiting_from_ = text.data();
  }
}

// Bytes of a sender that waits would be old when it is used.
void TcpReceiver::drop_waiting() {
  if (!waiting_.open()) return;
  const ssize_t got = ::recv(waiting_.get(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (ended(got)) waiting_ = Descriptor();
}

// Whether the sender that waited is used from now on.
bool TcpReceiver::take_waiting() {
  if (stream_.open() || !waiting_.open()) return false;
  stream_ = std::exchange(waiting_, Descriptor());
  heard_ns_ = now_ns();
  return true;
}

void TcpReceiver::connect_again() {
  if (now_ns() < next_attempt_ns_) return;
  heard_ns_ = now_ns();
  next_attempt_ns_ = heard_ns_ + kRetry_ns;
  stream_ = new_socket(SOCK_STREAM);
  keep_alive(stream_);
  const sockaddr_in to = system_address(address_);
  const int status = ::connect(stream_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to);
  connecting_ = status != 0 && errno == EINPROGRESS;
  if (status != 0 && !connecting_) stream_ = Descriptor();
}

// Whether there is a stream that can be read.
bool TcpReceiver::attempt() {
  if (!stream_.open()) {
    if (way_ == Way::kListen) return take_waiting();
    connect_again();
    return connected();
  }
  if (!connecting_) return true;
  pollfd wanted{stream_.get(), POLLOUT, 0};
  if (::poll(&wanted, 1, 0) != 1) {
    if (now_ns() - heard_ns_ < kReconnect_ns) return false;
  } else if (pending_error(stream_) == 0) {
    connecting_ = false;
    heard_ns_ = now_ns();
    return true;
  }
  connecting_ = false;
  stream_ = Descriptor();
  return false;
}

// False: the stream ended, or another one has to take its place.
bool TcpReceiver::read(const Received& received) {
  const ssize_t got = ::recv(stream_.get(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (got > 0) {
    heard_ns_ = now_ns();
    received(Bytes(buffer_).first(static_cast<std::size_t>(got)), false);
    return true;
  }
  const bool over = ended(got);
  const TimeNs silent_ns = now_ns() - heard_ns_;
  const bool stalled = way_ == Way::kListen ? waiting_.open() && silent_ns >= kReplaced_ns
                                            : silent_ns >= kReconnect_ns;
  if (!over && !stalled) return true;
  stream_ = Descriptor();
  received({}, true);
  return false;
}

void TcpReceiver::receive(const Received& received) {
  if (way_ == Way::kListen) accept();
  if (!attempt()) return;
  if (!read(received) && attempt()) (void)read(received);
  drop_waiting();
}

Result<TcpSender> TcpSender::connect(const Address& to) {
  Descriptor socket = new_socket(SOCK_STREAM);
  if (!socket.open()) return socket_error(to, "no socket", errno);
  const sockaddr_in at = system_address(to);
  int error = 0;
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    error = errno != EINPROGRESS        ? errno
            : wait_for(socket, POLLOUT) ? pending_error(socket)
                                        : ETIMEDOUT;
  if (error != 0) return socket_error(to, "cannot connect", error);
  set(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  return TcpSender(std::move(socket));
}

bool TcpSender::send(Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t sent =
        ::send(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0)
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    else if ((errno != EAGAIN && errno != EWOULDBLOCK) || !wait_for(socket_, POLLOUT))
      return false;
  }
  return true;
}

}  // namespace neritic::net
