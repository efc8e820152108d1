#include "engine/net/curve_keys.hpp"

#include <sys/stat.h>
#include <zmq.h>

#include <algorithm>
#include <vector>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"

namespace neritic::net {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeyLength = 40;
constexpr std::string_view kZ85 =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";

bool is_word(const std::string& name) {
  const auto good = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, good);
}

// "public KEY\nsecret KEY\n": each line a word and a key; "#" begins a line that is left out.
Result<std::string> key_in(const std::string& text, const fs::path& file, std::string_view word) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    if (!line.starts_with(word) || line.size() <= word.size() || line[word.size()] != ' ') continue;
    const std::string_view key = line.substr(word.size() + 1);
    if (is_key(key)) return std::string(key);
    break;
  }
  return refusal(file.string(), fmt::format("no line \"{} KEY\"", word),
                 "a key file of neritic keys (KEY: 40 characters)");
}

Status write_secret(const fs::path& file, const KeyPair& keys) {
  const std::string text = fmt::format("# Secret: keep it on one machine.\npublic {}\nsecret {}\n",
                                       keys.public_z85, keys.secret_z85);
  // No moment in which others may read it.
  const mode_t before = umask(077);
  const Status written = write_text(file, text);
  umask(before);
  return written;
}

Status write_public(const fs::path& file, const KeyPair& keys) {
  return write_text(file, fmt::format("public {}\n", keys.public_z85));
}

}  // namespace

Result<KeyPair> make_key_pair() {
  char open[kKeyLength + 1], secret[kKeyLength + 1];
  if (zmq_curve_keypair(open, secret) != 0)
    return failure(ErrorCode::kUnsupported, "keys: this ZeroMQ library has no CURVE");
  return KeyPair{open, secret};
}

bool is_key(std::string_view text) {
  return text.size() == kKeyLength &&
         std::ranges::all_of(text, [](char c) { return kZ85.find(c) != kZ85.npos; });
}

Status make_keys(const fs::path& folder, const std::string& client) {
  const fs::path clients = folder / "clients", of_client = clients / (client + ".public");
  if (!client.empty() && (!is_word(client) || !names_a_source(client) || client == "server"))
    return refusal(
        "--client", "'" + client + "'",
        "letters, digits, - and _, but autopilot, nobody, recording, server, simulation");
  // A link that leads nowhere or round in a loop is there too: nothing is written through it.
  const auto there = [](const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
  };
  if (!client.empty() && (there(of_client) || there(folder / (client + ".secret"))))
    return refusal(of_client.string(), "a client that has its keys", "a new name");
  NERITIC_TRY_STATUS(make_folder(clients));
  const auto make = [&](const fs::path& secret, const fs::path& open) -> Status {
    NERITIC_TRY(const KeyPair keys, make_key_pair());
    NERITIC_TRY_STATUS(write_secret(secret, keys));
    return write_public(open, keys);
  };
  if (there(folder / "server.secret"))
    NERITIC_TRY_STATUS(read_secret(folder / "server.secret"));
  else
    NERITIC_TRY_STATUS(make(folder / "server.secret", folder / "server.public"));
  return client.empty() ? Status() : make(folder / (client + ".secret"), of_client);
}

Result<KeyPair> read_secret(const fs::path& file) {
  NERITIC_TRY(const std::string text, read_text(file));
  struct stat facts {};
  if (stat(file.c_str(), &facts) == 0 && (facts.st_mode & 077) != 0)
    return refusal(file.string(), fmt::format("mode {:04o}", facts.st_mode & 07777),
                   "a secret that its owner alone may read (chmod 600)");
  NERITIC_TRY(std::string open, key_in(text, file, "public"));
  NERITIC_TRY(std::string secret, key_in(text, file, "secret"));
  char derived[kKeyLength + 1];
  if (zmq_curve_public(derived, secret.c_str()) != 0 || open != derived)
    return refusal(file.string(), "a public key of another secret", "the two keys of one pair");
  return KeyPair{std::move(open), std::move(secret)};
}

Result<std::string> read_public(const fs::path& file) {
  NERITIC_TRY(const std::string text, read_text(file));
  return key_in(text, file, "public");
}

Result<ServerKeys> read_server_keys(const fs::path& folder) {
  ServerKeys keys;
  NERITIC_TRY(keys.server, read_secret(folder / "server.secret"));
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder / "clients", error), end; !error && at != end;
       at.increment(error))
    if (at->path().extension() == ".public") files.push_back(at->path());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    // A client's samples and commands enter under that name.
    NERITIC_TRY_STATUS(check_source_name(file.string(), file.stem().string()));
    NERITIC_TRY(const std::string key, read_public(file));
    keys.clients[key] = file.stem().string();
  }
  if (keys.clients.empty())
    return refusal((folder / "clients").string(), "no client's key",
                   "NAME.public of each client (neritic keys FOLDER --client NAME)");
  return keys;
}

}  // namespace neritic::net
