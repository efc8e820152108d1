// Reading .npz: the arrays of a ZIP archive, stored or deflated. Source: PKWARE's APPNOTE 6.3.10.
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "engine/core/files.hpp"
#include "engine/core/npz.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::size_t kLocalBytes = 30, kCentralBytes = 46, kEndBytes = 22, kMostComment = 65535;
// More cannot come out of deflate (zlib's technical notes: 1032 to 1).
constexpr std::size_t kMostDeflated = 1032;
constexpr std::uint32_t kElsewhere = 0xffffffff;  // a size that stands in the ZIP64 field

struct Member {
  std::string name;  // without .npy
  std::uint32_t method = 0, crc = 0;
  std::uint64_t packed = 0, size = 0, header = 0;
};

std::string shown(const Member& m) {
  return printable(m.name, 40);
}

class Archive {
 public:
  Archive(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<std::vector<Member>> members() const {
    const auto end = end_record();
    if (!end) return broken("no end of a ZIP archive");
    const std::size_t n = number(*end + 10, 2);
    std::size_t at = number(*end + 16, 4);
    std::vector<Member> out;
    for (std::size_t i = 0; i < n; ++i) {
      if (!has(at, kCentralBytes) || number(at, 4) != kCentral)
        return broken(fmt::format("an archive whose list ends at entry {} of {}", i, n));
      const std::size_t name_bytes = number(at + 28, 2), extra_bytes = number(at + 30, 2);
      if (!has(at + kCentralBytes, name_bytes + extra_bytes)) return broken("a name that is cut");
      Member m{text(at + kCentralBytes, name_bytes),
               std::uint32_t(number(at + 10, 2)),
               std::uint32_t(number(at + 16, 4)),
               number(at + 20, 4),
               number(at + 24, 4),
               number(at + 42, 4)};
      read_zip64(at + kCentralBytes + name_bytes, extra_bytes, m);
      if (m.name.ends_with(".npy")) {
        m.name.resize(m.name.size() - 4);
        out.push_back(std::move(m));
      }
      at += kCentralBytes + name_bytes + extra_bytes + number(at + 32, 2);
    }
    return out;
  }

  Result<std::vector<std::byte>> content(const Member& m) const {
    if (!has(m.header, kLocalBytes) || number(m.header, 4) != kLocal)
      return broken(fmt::format("no array {} where the list has it", shown(m)));
    const std::size_t from =
        m.header + kLocalBytes + number(m.header + 26, 2) + number(m.header + 28, 2);
    if (!has(from, m.packed)) return broken(fmt::format("an array {} that is cut", shown(m)));
    const auto packed = bytes_.subspan(from, m.packed);
    if (m.method == 0 && m.packed == m.size)
      return checked(m, std::vector<std::byte>(packed.begin(), packed.end()));
    if (m.method != 8)
      return refusal(name_, fmt::format("array {} by ZIP method {}", shown(m), m.method),
                     "stored (0) or deflated (8)");
    if (m.size > m.packed * kMostDeflated)
      return broken(fmt::format("an array {} of {} bytes in {}", shown(m), m.size, m.packed));
    std::vector<std::byte> out(m.size);
    if (!inflate_into(packed, out))
      return broken(fmt::format("an array {} that is damaged", shown(m)));
    return checked(m, std::move(out));
  }

 private:
  Result<std::vector<std::byte>> checked(const Member& m, std::vector<std::byte> bytes) const {
    if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != m.crc)
      return broken(fmt::format("an array {} with another checksum", shown(m)));
    return bytes;
  }
  Error broken(std::string_view found) const { return refusal(name_, found, "a whole .npz"); }
  bool has(std::uint64_t at, std::uint64_t n) const {
    return at <= bytes_.size() && n <= bytes_.size() - at;
  }
  std::uint64_t number(std::size_t at, std::size_t n) const {
    std::uint64_t out = 0;
    std::memcpy(&out, bytes_.data() + at, n);
    return out;
  }
  std::string text(std::size_t at, std::size_t n) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + at, n};
  }

  std::optional<std::size_t> end_record() const {
    if (bytes_.size() < kEndBytes) return std::nullopt;
    const std::size_t last = bytes_.size() - kEndBytes;
    for (std::size_t back = 0; back <= std::min(last, kMostComment); ++back)
      if (number(last - back, 4) == kEnd) return last - back;
    return std::nullopt;
  }

  // The extra field 1 has, in this order, those of size, packed size and place that do not fit 32
  // bits.
  void read_zip64(std::size_t at, std::size_t length, Member& m) const {
    const std::size_t end = at + length;
    while (at + 4 <= end) {
      const std::size_t id = number(at, 2), n = number(at + 2, 2);
      at += 4;
      if (n > end - at) return;
      std::size_t field = at;
      if (id == 1)
        for (std::uint64_t* value : {&m.size, &m.packed, &m.header})
          if (*value == kElsewhere && field + 8 <= at + n) *value = number(field, 8), field += 8;
      at += n;
    }
  }

  static bool inflate_into(std::span<const std::byte> packed, std::span<std::byte> out) {
    z_stream stream{};
    constexpr int kRaw = -15;
    if (inflateInit2(&stream, kRaw) != Z_OK) return false;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    std::size_t in_left = packed.size(), out_left = out.size();
    int status = Z_OK;
    while (status == Z_OK) {  // zlib counts in 32 bits
      if (stream.avail_in == 0)
        in_left -= stream.avail_in = static_cast<uInt>(std::min<std::size_t>(in_left, 1 << 30));
      if (stream.avail_out == 0)
        out_left -= stream.avail_out = static_cast<uInt>(std::min<std::size_t>(out_left, 1 << 30));
      status = inflate(&stream, Z_NO_FLUSH);
    }
    const bool whole = status == Z_STREAM_END && out_left == 0 && stream.avail_out == 0;
    inflateEnd(&stream);
    return whole;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
};

}  // namespace

Result<NpyArray> parse_npz(std::span<const std::byte> bytes, const std::string& name,
                           std::span<const std::string_view> wanted) {
  const Archive archive(bytes, name);
  NERITIC_TRY(const auto members, archive.members());
  const Member* chosen = members.size() == 1 ? &members.front() : nullptr;
  std::string names;
  for (const Member& m : members) names += (names.empty() ? "" : ", ") + shown(m);
  for (const std::string_view key : wanted)
    for (const Member& m : members)
      if (chosen == nullptr && m.name == key) chosen = &m;
  if (chosen == nullptr)
    return refusal(name, fmt::format("arrays: {}", names.empty() ? "none" : printable(names, 200)),
                   fmt::format("one array, or one named {}", fmt::join(wanted, ", ")));
  NERITIC_TRY(const auto content, archive.content(*chosen));
  return parse_npy(content, fmt::format("{}: {}", name, shown(*chosen)));
}

Result<NpyArray> read_npz(const std::filesystem::path& path,
                          std::span<const std::string_view> wanted) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_npz(bytes, path.string(), wanted);
}

}  // namespace neritic
