// The file of a run's inputs: bytes in and out.
#include "engine/sim/input_log.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "engine/core/files.hpp"

namespace neritic::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr std::string_view kLogMagic = "NRTCLOG1";
constexpr std::size_t kMaxLogFields = 1'000'000;
constexpr std::size_t kMaxFieldName = 255;

std::size_t size_of_type(char type) {
  return type == 'd' || type == 'q' || type == 'Q' ? 8 : 4;
}

template <class T>
void append(std::vector<std::byte>& out, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

// Reads forward; after the end everything is 0 and whole() is false.
class LogCursor {
 public:
  explicit LogCursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::span<const std::byte> take(std::size_t size) {
    if (size > rest_.size()) {
      whole_ = false;
      rest_ = {};
      return {};
    }
    const auto taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }
  template <class T>
  T number() {
    T value{};
    const auto bytes = take(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  bool whole() const { return whole_; }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
  bool whole_ = true;
};

Result<LogField> read_field(LogCursor& cursor, std::size_t index, const std::string& name) {
  LogField field;
  field.type = static_cast<char>(cursor.number<std::uint8_t>());
  const auto text = cursor.take(cursor.number<std::uint8_t>());
  field.name.assign(reinterpret_cast<const char*>(text.data()), text.size());
  if (!cursor.whole()) return bad_input("{}: field {} is cut off", name, index);
  if (std::string_view("dfiIqQ").find(field.type) == std::string_view::npos)
    return bad_input("{}: field {} has type number {}; accepted: one of d f i I q Q", name, index,
                     static_cast<unsigned char>(field.type));
  if (field.name.empty() || !std::all_of(field.name.begin(), field.name.end(),
                                         [](char c) { return c > ' ' && c <= '~'; }))
    return bad_input("{}: field {} has a name that is not printable text", name, index);
  return field;
}

Status check_finite(const RawInputLog& log, const RawInputLog::Entry& entry,
                    const std::string& name) {
  LogCursor cursor(entry.numbers);
  for (const LogField& field : log.fields) {
    const auto bytes = cursor.take(size_of_type(field.type));
    double value = 0.0;
    if (field.type == 'd') std::memcpy(&value, bytes.data(), 8);
    if (field.type == 'f') {
      float narrow = 0.0f;
      std::memcpy(&narrow, bytes.data(), 4);
      value = narrow;
    }
    if (!std::isfinite(value))
      return bad_input("{}: step {}: {} is not finite", name, entry.step, field.name);
  }
  return {};
}

Status read_entries(LogCursor& cursor, std::uint64_t entries, std::uint64_t steps, RawInputLog& log,
                    const std::string& name) {
  std::size_t width = 0;
  for (const LogField& field : log.fields) width += size_of_type(field.type);
  if (entries > cursor.left() / (8 + width))
    return bad_input("{}: {} entries named, the file has room for {}", name, entries,
                     cursor.left() / (8 + width));
  for (std::uint64_t i = 0; i < entries; ++i) {
    auto& entry = log.entries.emplace_back();
    entry.step = cursor.number<std::uint64_t>();
    const auto numbers = cursor.take(width);
    entry.numbers.assign(numbers.begin(), numbers.end());
    const bool in_order =
        i == 0 ? entry.step == 0 : entry.step > log.entries[log.entries.size() - 2].step;
    if (!in_order || entry.step > steps)
      return bad_input("{}: entry {} is of step {}; accepted: ascending from 0 to {}", name, i,
                       entry.step, steps);
    NERITIC_TRY_STATUS(check_finite(log, entry, name));
  }
  return {};
}

}  // namespace

std::vector<std::byte> encode_input_log(const RawInputLog& log) {
  NERITIC_CHECK(!log.hashes.empty(), "a log has at least the hash of its start");
  std::vector<std::byte> out;
  for (const char c : kLogMagic) append(out, c);
  append(out, log.step_s);
  append(out, log.seed);
  append(out, static_cast<std::uint64_t>(log.hashes.size() - 1));
  append(out, static_cast<std::uint64_t>(log.entries.size()));
  append(out, static_cast<std::uint32_t>(log.fields.size()));
  for (const LogField& field : log.fields) {
    NERITIC_CHECK(field.name.size() <= kMaxFieldName, "field name '{}'", field.name);
    append(out, field.type);
    append(out, static_cast<std::uint8_t>(field.name.size()));
    for (const char c : field.name) append(out, c);
  }
  for (const RawInputLog::Entry& entry : log.entries) {
    append(out, entry.step);
    out.insert(out.end(), entry.numbers.begin(), entry.numbers.end());
  }
  for (const std::uint64_t hash : log.hashes) append(out, hash);
  return out;
}

Result<RawInputLog> parse_input_log(std::span<const std::byte> bytes, const std::string& name) {
  LogCursor cursor(bytes);
  const auto magic = cursor.take(kLogMagic.size());
  if (magic.empty() || std::memcmp(magic.data(), kLogMagic.data(), magic.size()) != 0)
    return bad_input("{}: not a log of inputs (its first bytes are not {})", name, kLogMagic);
  RawInputLog log;
  log.step_s = cursor.number<double>();
  log.seed = cursor.number<std::uint64_t>();
  const auto steps = cursor.number<std::uint64_t>();
  const auto entries = cursor.number<std::uint64_t>();
  const auto fields = cursor.number<std::uint32_t>();
  if (!cursor.whole()) return bad_input("{}: the log's head is cut off", name);
  if (!(log.step_s > 0.0 && log.step_s <= kMaxStep_s))
    return bad_input("{}: a step of {} s; accepted: over 0 to {} s", name, log.step_s, kMaxStep_s);
  if (fields == 0 || fields > kMaxLogFields)
    return bad_input("{}: {} fields; accepted: 1 to {}", name, fields, kMaxLogFields);
  for (std::uint32_t i = 0; i < fields; ++i) {
    NERITIC_TRY(LogField field, read_field(cursor, i, name));
    log.fields.push_back(std::move(field));
  }
  if (entries == 0) return bad_input("{}: no entries; accepted: one for step 0 and more", name);
  NERITIC_TRY_STATUS(read_entries(cursor, entries, steps, log, name));
  if (cursor.left() % 8 != 0 || cursor.left() / 8 == 0 || cursor.left() / 8 - 1 != steps)
    return bad_input("{}: {} bytes of hashes; {} steps need 8 each and 8 for the start", name,
                     cursor.left(), steps);
  while (cursor.left() > 0) log.hashes.push_back(cursor.number<std::uint64_t>());
  return log;
}

Status check_log_fields(const RawInputLog& log, std::span<const LogField> expected,
                        const std::string& name) {
  for (std::size_t i = 0; i < std::min(log.fields.size(), expected.size()); ++i)
    if (log.fields[i] != expected[i])
      return bad_input("{}: field {} is '{}' of type {}; accepted: '{}' of type {}", name, i,
                       log.fields[i].name, log.fields[i].type, expected[i].name, expected[i].type);
  if (log.fields.size() != expected.size())
    return bad_input("{}: {} fields; accepted: {}", name, log.fields.size(), expected.size());
  return {};
}

Status write_raw_input_log(const std::filesystem::path& path, const RawInputLog& log) {
  return write_file(path, encode_input_log(log));
}

Result<RawInputLog> read_raw_input_log(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_input_log(bytes, path.string());
}

}  // namespace neritic::sim
