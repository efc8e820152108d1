// A client of a server in C++: requests and answers of PROTOCOL.md. Python's is
// tools/python/neritic/remote.py. One thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "engine/net/client_socket.hpp"
#include "testbed/world/world.hpp"

namespace neritic::testbed {

struct RemoteOptions {
  net::ClientSocketOptions socket;
  std::string name;       // under which it sends; empty: "client", or its key's
  double patience_s = 5;  // for an answer, beside what a request itself may last
};

class Remote {
 public:
  struct Reply;
  // kIo where no server answers, or not to this key; kBadInput for another protocol.
  static Result<std::unique_ptr<Remote>> connect(const RemoteOptions& options);
  ~Remote();

  // The server's first words about itself.
  const nlohmann::json& hello() const;
  // map: with "op"; its number is added. The server's own line where it refuses.
  Result<Reply> call(nlohmann::json map, const std::vector<net::Bytes>& arrays = {},
                     double lasts_s = 0.0);
  // Wants no answer. False: too much waits to be sent.
  bool send(nlohmann::json map);

 private:
  struct Parts;
  explicit Remote(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

// The readings of an array of rows in an answer: of its key "newest" or "arrived"; none without.
// kBadInput where the answer is not as it should be.
Result<std::vector<Reading>> readings_in(const Remote::Reply& reply, const char* key);
// The truths of all agents in the answer to "poses".
Result<std::vector<Truth>> poses_in(const Remote::Reply& reply);

}  // namespace neritic::testbed
