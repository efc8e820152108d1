// Keys of a server and its clients (CURVE: Curve25519, as ZeroMQ has it), each as 40 characters of
// Z85, in small files. A folder of keys has
//
//   server.secret server.public   of the server
//   clients/NAME.public           of each client that may connect; NAME is what the server calls it
//   NAME.secret                   of a client: goes to its machine with server.public, then away
//
// A secret file is its owner's alone (mode 0600) and is refused where others may read it. Any
// thread.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic::net {

struct KeyPair {
  std::string public_z85, secret_z85;
};

// kUnsupported where the ZeroMQ library has no CURVE.
Result<KeyPair> make_key_pair();
// 40 characters of Z85's alphabet.
bool is_key(std::string_view text);

// Makes what the folder lacks: the server's keys, and those of the client if its name is not empty.
// kBadInput for a client that is there already and for a name that is no plain word.
Status make_keys(const std::filesystem::path& folder, const std::string& client);

// The pair of a secret file.
Result<KeyPair> read_secret(const std::filesystem::path& file);
Result<std::string> read_public(const std::filesystem::path& file);

struct ServerKeys {
  KeyPair server;
  std::map<std::string, std::string> clients;  // name by public key
};
// kBadInput names the file. At least one client.
Result<ServerKeys> read_server_keys(const std::filesystem::path& folder);

}  // namespace neritic::net
