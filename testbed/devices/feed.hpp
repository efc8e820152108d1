// Where a device's bytes come from: a socket, a sound card, a Bluetooth strap, a file, a stream of
// Lab Streaming Layer. Each gives them in the form that the adapter decodes. One thread, that of
// the device.
#pragma once

#include <memory>
#include <optional>

#include "engine/net/socket.hpp"
#include "engine/scene/source_settings.hpp"

namespace neritic::testbed {

class DeviceAdapter;

class Feed {
 public:
  virtual ~Feed() = default;
  // Waits for bytes, at most so long, and gives those that came, in bounded portions.
  virtual void receive(const net::Received& received, int wait_ms) = 0;
  // Before a receive() in simulated time: what plays by itself goes by that.
  virtual void at_simulated(TimeNs) {}
  // Datagrams that a full queue dropped so far.
  virtual std::uint64_t overflowed() const { return 0; }
  // While `received` has bytes: for how long they lay here before, as far as known.
  virtual TimeNs waited_ns() const { return 0; }
  // While `received` has bytes: the IPv4 address that they came from; none: of one sender alone.
  virtual std::optional<std::uint32_t> from() const { return {}; }
  // Whether the other end is there, in words; empty: nothing to say.
  virtual std::string trouble() const { return {}; }
  // For feeds whose protocol asks for the device's time.
  virtual void exchange_times(DeviceAdapter&) {}
};

// The feed of a scene's source. An Error names the source and what is in the way: a port that is
// taken, a library or a device that is not there.
Result<std::unique_ptr<Feed>> open_feed(const scene::DeviceSource& source);

// feed_alsa.cpp, feed_bluetooth.cpp, feed_lsl.cpp, feed_wav.cpp
Result<std::unique_ptr<Feed>> open_alsa(const scene::DeviceSource& source);
Result<std::unique_ptr<Feed>> open_bluetooth(const scene::DeviceSource& source);
Result<std::unique_ptr<Feed>> open_lsl(const scene::DeviceSource& source);
Result<std::unique_ptr<Feed>> open_wav(const scene::DeviceSource& source);

}  // namespace neritic::testbed
