// A stand-in for BlueZ and the system's D-Bus around it: a Polar strap that is paired, at a Unix
// socket that DBUS_SYSTEM_BUS_ADDRESS names while this lives. One client. Any thread.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/net/socket.hpp"
#include "tests/support/support.hpp"

namespace neritic::test {

class FakeBluez {
 public:
  enum class Characteristic { kRate, kControl, kEcg };

  // connected: the strap's services are known from the start, as after Connect.
  explicit FakeBluez(bool connected);
  ~FakeBluez();
  FakeBluez(const FakeBluez&) = delete;
  FakeBluez& operator=(const FakeBluez&) = delete;

  // The strap goes out of reach: its services are unknown until somebody calls Connect.
  void leave();
  // The same, but nobody is told, as of an adapter that is pulled out.
  void vanish() { connected_ = false; }
  void notify(Characteristic characteristic, net::Bytes value);
  // What was called, in order: "Connect", "StartNotify rate", "WriteValue control 0200...".
  std::vector<std::string> calls();

 private:
  struct Call;
  void serve();
  bool read(char* to, std::size_t size);
  bool greet();
  bool answer();
  std::string objects() const;
  void send(char type, const std::string& fields, const std::string& body);
  void changed(const std::string& path, const std::string& interface, const std::string& property);

  ScratchFolder folder_;
  net::Descriptor listener_, client_;
  std::atomic<bool> stop_{false}, connected_, there_{false};
  std::mutex mutex_;  // of what is below, and of writes to the client
  std::vector<std::string> calls_;
  std::uint32_t serial_ = 0;
  std::thread thread_;  // last: it uses what is above
};

}  // namespace neritic::test
