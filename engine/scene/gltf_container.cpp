// See gltf_container.hpp.
#include "engine/scene/gltf_container.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/gltf_json.hpp"

namespace neritic::scene::gltf {
namespace {
namespace fs = std::filesystem;

// glTF 2.0 section 4.4: magic "glTF", chunk types "JSON" and "BIN\0", all little-endian.
constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, 4);
  return word;
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// RFC 3986 section 2.1. A '%' without two hex digits stays as it is, as browsers do.
std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
        hex_digit(text[i + 2]) >= 0) {
      out += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

constexpr std::array<std::int8_t, 256> make_base64_table() {
  std::array<std::int8_t, 256> table{};
  for (auto& entry : table) entry = -1;
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (int i = 0; i < 64; ++i) table[static_cast<unsigned char>(kAlphabet[i])] = std::int8_t(i);
  table['-'] = 62, table['_'] = 63;  // the URL-safe alphabet, RFC 4648 section 5
  return table;
}

Result<std::vector<std::byte>> base64_decode(std::string_view text) {
  static constexpr auto kTable = make_base64_table();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int n_bits = 0;
  for (const char c : text) {
    const int value = kTable[static_cast<unsigned char>(c)];
    if (value < 0) return refusal("", "a data URI with other characters than base64's", "base64");
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    n_bits += 6;
    if (n_bits >= 8) {
      n_bits -= 8;
      out.push_back(static_cast<std::byte>((bits >> n_bits) & 0xff));
    }
  }
  return out;
}

Result<std::vector<std::byte>> read_data_uri(std::string_view uri) {
  const auto comma = uri.find(',');
  if (comma == uri.npos) return refusal("", "a data URI without a comma", "data:TYPE;base64,DATA");
  const std::string_view head = uri.substr(0, comma), payload = uri.substr(comma + 1);
  if (head.ends_with(";base64")) return base64_decode(payload);
  const std::string text = percent_decode(payload);
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

// "http:", "file:", also "C:": letters, digits, + - . up to a colon (RFC 3986 section 3.1).
bool has_scheme(std::string_view uri) {
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const char c = uri[i];
    if (c == ':') return i > 0;
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool other = (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    if (!letter && !(other && i > 0)) return false;
  }
  return false;
}

}  // namespace

Result<Container> open_container(std::span<const std::byte> bytes) {
  if (bytes.size() < 4 || word_at(bytes, 0) != kMagic) return Container{as_text(bytes), {}, false};
  if (bytes.size() < kHeaderBytes)
    return refusal("", "a .glb that ends within its header", "a whole file");
  if (const auto version = word_at(bytes, 4); version != 2)
    return refusal("", fmt::format(".glb version {}", version), "2");
  const std::size_t length = word_at(bytes, 8);
  if (length < kHeaderBytes || length > bytes.size())
    return refusal("", fmt::format("a .glb whose header states {} bytes", length),
                   fmt::format("at most the file's {}", bytes.size()));
  bytes = bytes.first(length);  // what follows is not part of the asset

  Container out;
  out.binary = true;
  std::size_t n_chunks = 0;
  for (std::size_t at = kHeaderBytes; at < length; ++n_chunks) {
    if (length - at < kChunkHeaderBytes)
      return refusal("", fmt::format("a .glb that ends within the header of chunk {}", n_chunks),
                     "a whole file");
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (size > length - at)
      return refusal("", fmt::format(".glb chunk {} of {} bytes", n_chunks, size),
                     fmt::format("at most the {} that are left", length - at));
    const auto chunk = bytes.subspan(at, size);
    if (n_chunks == 0 && type != kJsonChunk)
      return refusal("", "another first chunk than JSON", "a .glb that begins with its JSON chunk");
    if (n_chunks > 0 && type == kJsonChunk)
      return refusal("", "a second JSON chunk", "one in a .glb");
    if (n_chunks > 1 && type == kBinChunk)
      return refusal("", "a BIN chunk in another place", "the second chunk of a .glb");
    if (n_chunks == 0) out.json = as_text(chunk);
    if (type == kBinChunk) out.bin = chunk;
    // Chunks start on multiples of four; a last chunk without its padding is forgiven.
    at = std::min(length, at + size + (4 - size % 4) % 4);
  }
  if (n_chunks == 0) return refusal("", "a .glb without chunks", "one with a JSON chunk");
  return out;
}

Result<std::vector<std::byte>> read_uri(std::string_view uri, const fs::path& folder) {
  if (uri.starts_with("data:")) return read_data_uri(uri);
  const std::string shown = one_line(uri, 80);
  if (has_scheme(uri))
    return refusal("", fmt::format("\"{}\"", shown), "a data URI or a relative path");
  const std::string decoded = percent_decode(uri);
  const fs::path relative = fs::path(decoded).lexically_normal();
  const fs::path literal = fs::path(uri).lexically_normal();
  const auto below = [](const fs::path& path) {
    return !path.empty() && path.is_relative() && *path.begin() != "..";
  };
  const bool inside = decoded.find_first_of(std::string_view("\\\0", 2)) == decoded.npos &&
                      below(relative) && below(literal);
  if (!inside) return refusal("", fmt::format("\"{}\"", shown), "a path below the model's folder");
  if (folder.empty())
    return refusal("", fmt::format("\"{}\"", shown),
                   "data URIs only, since the model is not read from a folder");
  // Some exporters leave a literal "%20" in the file's name.
  std::error_code ignored;
  if (decoded != uri && !fs::exists(folder / relative, ignored) &&
      fs::exists(folder / literal, ignored))
    return read_file(folder / literal);
  return read_file(folder / relative);
}

}  // namespace neritic::scene::gltf
