#include "engine/core/npy.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {
namespace {

struct TypeRow {
  NpyType type;
  const char* name;
  std::size_t size;
};
constexpr std::array<TypeRow, 10> kTypes{{{NpyType::kFloat16, "<f2", 2},
                                          {NpyType::kFloat32, "<f4", 4},
                                          {NpyType::kFloat64, "<f8", 8},
                                          {NpyType::kUint8, "|u1", 1},
                                          {NpyType::kUint16, "<u2", 2},
                                          {NpyType::kUint32, "<u4", 4},
                                          {NpyType::kInt16, "<i2", 2},
                                          {NpyType::kInt32, "<i4", 4},
                                          {NpyType::kInt64, "<i8", 8},
                                          {NpyType::kBool, "|b1", 1}}};

constexpr const char* kMagic = "\x93NUMPY";
constexpr std::size_t kMaxDimensions = 32;  // NumPy's own limit

// The value text behind 'key': in the header's dictionary; empty where the key is missing.
std::string_view value_of(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string needle = quote + std::string(key) + quote;
    const auto at = header.find(needle);
    if (at == std::string_view::npos) continue;
    auto rest = header.substr(at + needle.size());
    const auto colon = rest.find(':');
    if (colon == std::string_view::npos) return {};
    rest = rest.substr(colon + 1);
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.front())))
      rest.remove_prefix(1);
    return rest;
  }
  return {};
}

// The quoted word that text starts with, without its quotes; else the start of text. Both short.
std::string quoted_start(std::string_view text) {
  constexpr std::size_t kMost = 12;
  const bool quoted = text.front() == '\'' || text.front() == '"';
  const auto end = quoted ? text.find(text.front(), 1) : text.npos;
  return std::string(quoted && end != text.npos ? text.substr(1, end - 1).substr(0, kMost)
                                                : text.substr(0, kMost));
}

Result<std::vector<std::size_t>> parse_shape(std::string_view text, const std::string& name) {
  if (text.empty() || text.front() != '(')
    return refusal(name, "no shape in the .npy header", "one");
  std::vector<std::size_t> shape;
  std::size_t i = 1;
  while (i < text.size() && text[i] != ')') {
    if (std::isspace(static_cast<unsigned char>(text[i])) || text[i] == ',') {
      ++i;
      continue;
    }
    if (!std::isdigit(static_cast<unsigned char>(text[i])))
      return refusal(name, fmt::format("'{}' in the .npy shape", text[i]), "whole numbers");
    std::size_t value = 0;
    while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]))) {
      if (value > kMaxFileBytes)
        return refusal(name, "too large a .npy shape", "one whose size fits 64 bits");
      value = value * 10 + static_cast<std::size_t>(text[i++] - '0');
    }
    shape.push_back(value);
    if (shape.size() > kMaxDimensions)
      return refusal(name, "over 32 axes in the .npy shape", "up to 32");
  }
  if (i >= text.size()) return refusal(name, "no end of the .npy shape", "one in parentheses");
  return shape;
}

// Elements whose first index runs fastest, rearranged so that the last one does.
std::vector<std::byte> to_c_order(std::span<const std::byte> from,
                                  const std::vector<std::size_t>& shape, std::size_t size) {
  std::vector<std::byte> out(from.size());
  std::vector<std::size_t> at(shape.size(), 0), stride(shape.size(), 1);  // of from, in elements
  for (std::size_t k = 1; k < shape.size(); ++k) stride[k] = stride[k - 1] * shape[k - 1];
  std::size_t element = 0;
  for (std::size_t to = 0; to < out.size(); to += size) {
    std::memcpy(out.data() + to, from.data() + element * size, size);
    for (std::size_t k = shape.size(); k-- > 0;) {
      element += stride[k];
      if (++at[k] < shape[k]) break;
      element -= stride[k] * shape[k];
      at[k] = 0;
    }
  }
  return out;
}

template <class T>
void append_as_doubles(std::span<const std::byte> bytes, std::vector<double>& out) {
  for (std::size_t i = 0; i + sizeof(T) <= bytes.size(); i += sizeof(T)) {
    T value;
    std::memcpy(&value, bytes.data() + i, sizeof(T));
    out.push_back(static_cast<double>(value));
  }
}

// IEEE 754 half precision: 1 bit of sign, 5 of exponent (bias 15), 10 of fraction.
double from_half(std::uint16_t bits) {
  const double sign = (bits & 0x8000) != 0 ? -1.0 : 1.0;
  const int exponent = bits >> 10 & 0x1f, fraction = bits & 0x3ff;
  if (exponent == 0x1f)
    return fraction != 0 ? std::numeric_limits<double>::quiet_NaN()
                         : sign * std::numeric_limits<double>::infinity();
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(0x400 + fraction, exponent - 25);
}

void append_halves(std::span<const std::byte> bytes, std::vector<double>& out) {
  for (std::size_t i = 0; i + 2 <= bytes.size(); i += 2)
    out.push_back(from_half(static_cast<std::uint16_t>(
        std::to_integer<unsigned>(bytes[i]) | std::to_integer<unsigned>(bytes[i + 1]) << 8)));
}

}  // namespace

bool is_float(NpyType type) {
  return type == NpyType::kFloat16 || type == NpyType::kFloat32 || type == NpyType::kFloat64;
}

std::size_t npy_type_size(NpyType type) {
  return std::find_if(kTypes.begin(), kTypes.end(),
                      [&](const TypeRow& r) { return r.type == type; })
      ->size;
}

std::string npy_type_name(NpyType type) {
  return std::find_if(kTypes.begin(), kTypes.end(),
                      [&](const TypeRow& r) { return r.type == type; })
      ->name;
}

std::size_t NpyArray::count() const {
  std::size_t n = 1;
  for (const std::size_t extent : shape) n *= extent;
  return n;
}

std::vector<double> NpyArray::to_doubles() const {
  std::vector<double> out;
  out.reserve(count());
  switch (type) {
    case NpyType::kFloat16:
      append_halves(bytes, out);
      break;
    case NpyType::kFloat32:
      append_as_doubles<float>(bytes, out);
      break;
    case NpyType::kFloat64:
      append_as_doubles<double>(bytes, out);
      break;
    case NpyType::kUint8:
    case NpyType::kBool:
      append_as_doubles<std::uint8_t>(bytes, out);
      break;
    case NpyType::kUint16:
      append_as_doubles<std::uint16_t>(bytes, out);
      break;
    case NpyType::kUint32:
      append_as_doubles<std::uint32_t>(bytes, out);
      break;
    case NpyType::kInt16:
      append_as_doubles<std::int16_t>(bytes, out);
      break;
    case NpyType::kInt32:
      append_as_doubles<std::int32_t>(bytes, out);
      break;
    case NpyType::kInt64:
      append_as_doubles<std::int64_t>(bytes, out);
      break;
  }
  return out;
}

Result<NpyArray> parse_npy(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < 10 || std::memcmp(bytes.data(), kMagic, 6) != 0)
    return refusal(name, "no .npy file", "one");
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  const std::size_t major = byte_at(6);
  if (major < 1 || major > 3) return refusal(name, fmt::format(".npy version {}", major), "1 to 3");
  const std::size_t prefix = major == 1 ? 10 : 12;
  if (bytes.size() < prefix) return refusal(name, "a .npy header that is cut off", "a whole file");
  std::size_t length = byte_at(8) | byte_at(9) << 8;
  if (major > 1) length |= byte_at(10) << 16 | byte_at(11) << 24;
  if (length > bytes.size() - prefix)
    return refusal(name, "a .npy header that is cut off", "a whole file");
  const std::string_view header(reinterpret_cast<const char*>(bytes.data()) + prefix, length);

  // Printable ASCII that ends in a newline (NEP 1): what is quoted below then stays on one line.
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (!std::all_of(header.begin(), header.end(),
                   [&](char c) { return printable(c) || c == '\n'; }) ||
      header.substr(0, header.empty() ? 0 : header.size() - 1).find('\n') != header.npos)
    return refusal(name, "a .npy header of another form", "one line of text");

  NpyArray array;
  const std::string_view descr = value_of(header, "descr");
  if (descr.size() < 5) return refusal(name, "no descr in the .npy header", "one");
  std::string type_name(descr.substr(1, 3));
  const bool big_endian = type_name[0] == '>';
  if (big_endian || type_name[0] == '=' || type_name[0] == '|' || type_name[0] == '<') {
    const bool one_byte = type_name[2] == '1';
    type_name[0] = one_byte ? '|' : '<';
  }
  const auto row = std::find_if(kTypes.begin(), kTypes.end(),
                                [&](const TypeRow& r) { return type_name == r.name; });
  if (row == kTypes.end())
    return refusal(name, fmt::format("element type {}", neritic::printable(quoted_start(descr))),
                   "f2 f4 f8 u1 u2 u4 i2 i4 i8 b1");
  array.type = row->type;
  const std::string_view order = value_of(header, "fortran_order");
  const bool fortran = order.starts_with("True");
  if (!fortran && !order.starts_with("False"))
    return refusal(name,
                   fmt::format("fortran_order {}",
                               order.empty() ? "nothing" : neritic::printable(quoted_start(order))),
                   "True or False");
  NERITIC_TRY(array.shape, parse_shape(value_of(header, "shape"), name));

  std::size_t expected = row->size;
  for (const std::size_t extent : array.shape) {
    if (extent != 0 && expected > kMaxFileBytes / extent)
      return refusal(name, "a .npy shape larger than the file", "a whole file");
    expected *= extent;
  }
  const std::size_t present = bytes.size() - prefix - length;
  if (present < expected)
    return refusal(name, fmt::format("{} bytes of elements", present),
                   fmt::format("{}, as the shape needs", expected));
  const auto data = bytes.subspan(prefix + length, expected);
  array.bytes.assign(data.begin(), data.end());
  if (big_endian)
    for (std::size_t i = 0; i < array.bytes.size(); i += row->size)
      std::reverse(array.bytes.begin() + std::ptrdiff_t(i),
                   array.bytes.begin() + std::ptrdiff_t(i + row->size));
  if (fortran) array.bytes = to_c_order(array.bytes, array.shape, row->size);
  return array;
}

Result<NpyArray> read_npy(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_npy(bytes, path.string());
}

std::vector<std::byte> npy_bytes(NpyType type, std::span<const std::size_t> shape,
                                 std::span<const std::byte> bytes) {
  std::string dims;
  for (const std::size_t extent : shape) dims += fmt::format("{}, ", extent);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", npy_type_name(type),
                  shape.size() == 1 ? dims : dims.substr(0, dims.size() - 2));
  // Data starts on a multiple of 64 bytes, as the format asks.
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::vector<std::byte> out(10 + header.size() + bytes.size());
  std::memcpy(out.data(), kMagic, 6);
  out[6] = std::byte{1};
  out[7] = std::byte{0};
  out[8] = static_cast<std::byte>(header.size() & 0xff);
  out[9] = static_cast<std::byte>(header.size() >> 8);
  std::memcpy(out.data() + 10, header.data(), header.size());
  if (!bytes.empty()) std::memcpy(out.data() + 10 + header.size(), bytes.data(), bytes.size());
  return out;
}

Status write_npy(const std::filesystem::path& path, NpyType type,
                 std::span<const std::size_t> shape, std::span<const std::byte> bytes) {
  return write_file(path, npy_bytes(type, shape, bytes));
}

Status write_npy(const std::filesystem::path& path, std::span<const float> values,
                 std::initializer_list<std::size_t> shape) {
  return write_npy(path, NpyType::kFloat32, std::span(shape.begin(), shape.size()),
                   std::as_bytes(values));
}
Status write_npy(const std::filesystem::path& path, std::span<const double> values,
                 std::initializer_list<std::size_t> shape) {
  return write_npy(path, NpyType::kFloat64, std::span(shape.begin(), shape.size()),
                   std::as_bytes(values));
}
Status write_npy(const std::filesystem::path& path, std::span<const std::uint16_t> values,
                 std::initializer_list<std::size_t> shape) {
  return write_npy(path, NpyType::kUint16, std::span(shape.begin(), shape.size()),
                   std::as_bytes(values));
}
Status write_npy(const std::filesystem::path& path, std::span<const std::uint8_t> values,
                 std::initializer_list<std::size_t> shape) {
  return write_npy(path, NpyType::kUint8, std::span(shape.begin(), shape.size()),
                   std::as_bytes(values));
}

}  // namespace neritic
