#include "testbed/devices/feed.hpp"

#include <poll.h>

#include <chrono>
#include <thread>

namespace neritic::testbed {
namespace {

// Datagrams at once, so that counts and ticks keep up in a flood.
constexpr std::size_t kPortion = 1024;

void wait_for(int descriptor, short events, int wait_ms) {
  if (wait_ms <= 0) return;
  if (descriptor < 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    return;
  }
  pollfd wanted{descriptor, events, 0};
  (void)::poll(&wanted, 1, wait_ms);
}

class UdpFeed final : public Feed {
 public:
  explicit UdpFeed(net::UdpReceiver receiver) : receiver_(std::move(receiver)) {}
  void receive(const net::Received& received, int wait_ms) override {
    wait_for(receiver_.descriptor(), POLLIN, wait_ms);
    (void)receiver_.receive(received, kPortion);
  }
  std::uint64_t overflowed() const override { return receiver_.overflowed(); }
  TimeNs waited_ns() const override { return receiver_.waited_ns(); }
  std::optional<std::uint32_t> from() const override { return receiver_.from(); }

 private:
  net::UdpReceiver receiver_;
};

class TcpFeed final : public Feed {
 public:
  explicit TcpFeed(net::TcpReceiver receiver) : receiver_(std::move(receiver)) {}
  void receive(const net::Received& received, int wait_ms) override {
    wait_for(receiver_.descriptor(), receiver_.connecting() ? POLLOUT : POLLIN, wait_ms);
    receiver_.receive(received);
  }
  std::string trouble() const override {
    if (!receiver_.connected()) return "not connected";
    if (receiver_.waiting().empty()) return "";
    return fmt::format("a second sender, at {}, waits until the first one is silent for a second",
                       receiver_.waiting());
  }

 private:
  net::TcpReceiver receiver_;
};

}  // namespace

Result<std::unique_ptr<Feed>> open_feed(const scene::DeviceSource& source) {
  const auto named = [&](const Error& error) {
    return Error{error.code, fmt::format("source {}: {}", source.name, error.message)};
  };
  const auto kept = [&](Result<std::unique_ptr<Feed>> feed) -> Result<std::unique_ptr<Feed>> {
    if (!feed.ok()) return named(feed.error());
    return feed;
  };
  if (source.by == "alsa") return kept(open_alsa(source));
  if (source.by == "bluetooth") return kept(open_bluetooth(source));
  if (source.by == "lsl") return kept(open_lsl(source));
  if (source.by == "wav") return kept(open_wav(source));
  if (source.by == "udp") {
    auto receiver = net::UdpReceiver::bind(source.address);
    if (!receiver.ok()) return named(receiver.error());
    return std::unique_ptr<Feed>(std::make_unique<UdpFeed>(std::move(receiver).value()));
  }
  using Way = net::TcpReceiver::Way;
  auto receiver =
      net::TcpReceiver::open(source.address, source.by == "tcp" ? Way::kListen : Way::kConnect);
  if (!receiver.ok()) return named(receiver.error());
  return std::unique_ptr<Feed>(std::make_unique<TcpFeed>(std::move(receiver).value()));
}

}  // namespace neritic::testbed
