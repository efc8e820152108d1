// The network's side of a server: a thread of its own that listens, checks every request, answers
// those that need no simulation, and hands the others over. It never waits for the simulation nor
// lets the simulation wait. PROTOCOL.md has the messages.
//
//   HandOff hand_off;
//   NERITIC_TRY(auto server, Server::start(facts_of(world, false), hand_off, {}));
//   WorldServer(world, hand_off, {}).run(stop);   // the simulation's thread
#pragma once

#include <memory>

#include "engine/net/server_socket.hpp"
#include "testbed/server/hand_off.hpp"

namespace neritic::testbed {

struct ServerOptions {
  net::ServerSocketOptions socket;
  bool shared_memory = true;  // for clients of this machine and user
};

class Server {
 public:
  struct Counts {
    net::ServerSocket::Counts socket;
    std::uint64_t clients = 0, requests = 0;
    std::uint64_t refused = 0;  // requests that were not good
    std::uint64_t busy = 0;     // requests beyond what may wait
  };

  // Errors as net::ServerSocket::bind. Borrows the hand-off.
  static Result<std::unique_ptr<Server>> start(ServedFacts facts, HandOff& hand_off,
                                               const ServerOptions& options);
  // Stops the thread; answers that wait are lost.
  ~Server();

  Address address() const;
  // Any thread; at most some 100 ms old.
  Counts counts() const;

 private:
  class Network;
  explicit Server(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace neritic::testbed
