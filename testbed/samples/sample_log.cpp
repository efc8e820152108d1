#include "testbed/samples/sample_log.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/core/files.hpp"
#include "engine/sim/fields.hpp"
#include "engine/sim/run_log.hpp"

namespace neritic::testbed {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr std::string_view kMagic = "NRTCLOG2", kOldMagic = "NRTCLOG1";
constexpr std::size_t kMaxStreams = 1'000'000, kMaxFields = 4096, kMaxName = 255;
// The size of a sample without its payload, and that of the shortest stream and source.
constexpr std::size_t kHeaderBytes = 8 + 4 + 4 + 8 + 8 + 8, kLeastName = 2;

// Sums of two such times do not overflow: 36 years.
constexpr TimeNs kMostTime_ns = TimeNs{1} << 60;
bool plausible(TimeNs time_ns) {
  return time_ns >= -kMostTime_ns && time_ns <= kMostTime_ns;
}

struct Field {
  char type = 'd';
  std::string name;
  bool operator==(const Field&) const = default;
};

template <sim::Scalar T>
constexpr char type_of() {
  if constexpr (std::same_as<T, double>) return 'd';
  if constexpr (std::same_as<T, float>) return 'f';
  if constexpr (std::same_as<T, std::int32_t>) return 'i';
  if constexpr (std::same_as<T, std::uint32_t>) return 'I';
  if constexpr (std::same_as<T, std::int64_t>) return 'q';
  return 'Q';
}

std::vector<Field> fields_of(PayloadKind kind) {
  std::vector<Field> fields;
  const Payload payload = empty_payload(kind);
  std::visit(
      [&](const auto& value) {
        sim::for_each_named_scalar(value, [&](const std::string& name, const auto& scalar) {
          fields.push_back({type_of<std::remove_cvref_t<decltype(scalar)>>(), name});
        });
      },
      payload);
  return fields;
}

class Writer {
 public:
  template <class T>
  void number(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  void text(std::string_view text) {
    for (const char c : text) number(c);
  }
  void name(std::string_view name) {
    NERITIC_CHECK(!name.empty() && name.size() <= kMaxName, "name '{}'", name);
    number(static_cast<std::uint8_t>(name.size()));
    text(name);
  }
  std::vector<std::byte> take() { return std::move(out_); }

 private:
  std::vector<std::byte> out_;
};

// Reads forward; after the end every number is 0 and whole() is false.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

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
  std::string name() {
    const auto bytes = take(number<std::uint8_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  bool whole() const { return whole_; }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
  bool whole_ = true;
};

bool printable(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
}

// The kind of that name whose fields are these.
Result<PayloadKind> read_kind(Cursor& cursor, std::size_t index, const std::string& name) {
  const std::string kind_name = cursor.name();
  const auto count = cursor.number<std::uint32_t>();
  if (!cursor.whole() || count > kMaxFields)
    return bad_input("{}: kind {} is cut off or has more than {} fields", name, index, kMaxFields);
  std::vector<Field> fields;
  for (std::uint32_t i = 0; i < count; ++i) {
    const char type = static_cast<char>(cursor.number<std::uint8_t>());
    fields.push_back({type, cursor.name()});
  }
  if (!cursor.whole() || !printable(kind_name))
    return bad_input("{}: kind {} is cut off or has no name in printable text", name, index);
  for (std::size_t i = 0; i < kPayloadKinds; ++i) {
    const auto kind = static_cast<PayloadKind>(i);
    if (name_of(kind) != kind_name) continue;
    if (fields_of(kind) != fields)
      return bad_input("{}: samples of kind {} with other fields than this version's", name,
                       kind_name);
    return kind;
  }
  return bad_input("{}: kind {} is '{}'; accepted: a kind of sample of this version", name, index,
                   kind_name);
}

Status read_tables(Cursor& cursor, std::uint32_t kinds, std::uint32_t streams,
                   std::uint32_t sources, SampleLog& log, const std::string& name) {
  if (kinds > kPayloadKinds)
    return bad_input("{}: {} kinds of samples; accepted: up to {}", name, kinds, kPayloadKinds);
  std::vector<PayloadKind> kind_of;
  for (std::uint32_t i = 0; i < kinds; ++i) {
    NERITIC_TRY(const PayloadKind kind, read_kind(cursor, i, name));
    kind_of.push_back(kind);
  }
  if (streams > kMaxStreams || streams > cursor.left() / kLeastName ||
      sources > cursor.left() / kLeastName)
    return bad_input("{}: {} streams and {} sources named, the file is shorter", name, streams,
                     sources);
  for (std::uint32_t i = 0; i < streams; ++i) {
    SampleLog::LoggedStream stream{cursor.name(), {}};
    const auto kind = cursor.number<std::uint32_t>();
    if (!cursor.whole() || kind >= kinds || !printable(stream.name))
      return bad_input("{}: stream {} is cut off, or has no name or kind", name, i);
    stream.kind = kind_of[kind];
    log.streams.push_back(std::move(stream));
  }
  for (std::uint32_t i = 0; i < sources; ++i) {
    log.sources.push_back(cursor.name());
    if (!cursor.whole() || !printable(log.sources.back()))
      return bad_input("{}: source {} is cut off, or has no name", name, i);
  }
  return {};
}

Status read_samples(Cursor& cursor, std::uint64_t samples, std::uint64_t steps, SampleLog& log,
                    const std::string& name) {
  if (samples > cursor.left() / kHeaderBytes)
    return bad_input("{}: {} samples named, the file has room for {}", name, samples,
                     cursor.left() / kHeaderBytes);
  std::uint64_t last_step = 0;
  for (std::uint64_t i = 0; i < samples; ++i) {
    SampleLog::Entry entry;
    entry.step = cursor.number<std::uint64_t>();
    sim::for_each_scalar(entry.sample.header, [&](auto& scalar) {
      scalar = cursor.number<std::remove_cvref_t<decltype(scalar)>>();
    });
    const SampleHeader& header = entry.sample.header;
    if (!cursor.whole() || header.stream >= log.streams.size() ||
        header.source >= log.sources.size())
      return bad_input("{}: sample {} is cut off, or of no stream or source of the file", name, i);
    if (entry.step < last_step || entry.step >= steps)
      return bad_input("{}: sample {} is of step {}; accepted: {} to {}", name, i, entry.step,
                       last_step, steps == 0 ? 0 : steps - 1);
    last_step = entry.step;
    if (!plausible(header.captured_ns) || !plausible(header.arrived_ns))
      return bad_input("{}: sample {} is of {} and {} ns; accepted: up to {} from 0", name, i,
                       header.captured_ns, header.arrived_ns, kMostTime_ns);
    entry.sample.payload = empty_payload(log.streams[header.stream].kind);
    std::visit(
        [&](auto& value) {
          sim::for_each_scalar(value, [&](auto& scalar) {
            scalar = cursor.number<std::remove_cvref_t<decltype(scalar)>>();
          });
        },
        entry.sample.payload);
    if (!cursor.whole()) return bad_input("{}: sample {} is cut off", name, i);
    if (!all_finite(entry.sample.payload))
      return bad_input("{}: sample {}, of {} at step {}, is not finite", name, i,
                       log.streams[header.stream].name, entry.step);
    log.entries.push_back(entry);
  }
  return {};
}

}  // namespace

std::vector<SampleLog::LoggedStream> logged_streams(const StreamTable& table) {
  std::vector<SampleLog::LoggedStream> streams;
  for (const Stream& stream : table.streams()) streams.push_back({stream.name, stream.kind});
  return streams;
}

std::vector<std::byte> encode_sample_log(const SampleLog& log) {
  NERITIC_CHECK(!log.hashes.empty(), "a log has at least the hash of its start");
  std::vector<PayloadKind> kinds;  // of the streams, in their order
  const auto place_of = [&](PayloadKind kind) {
    return static_cast<std::uint32_t>(std::ranges::find(kinds, kind) - kinds.begin());
  };
  for (const auto& stream : log.streams)
    if (place_of(stream.kind) == kinds.size()) kinds.push_back(stream.kind);
  Writer out;
  out.text(kMagic);
  out.number(log.step_s);
  out.number(log.seed);
  out.number(log.steps());
  out.number(static_cast<std::uint64_t>(log.entries.size()));
  for (const std::size_t count : {kinds.size(), log.streams.size(), log.sources.size()})
    out.number(static_cast<std::uint32_t>(count));
  for (const PayloadKind kind : kinds) {
    const auto fields = fields_of(kind);
    out.name(name_of(kind));
    out.number(static_cast<std::uint32_t>(fields.size()));
    for (const Field& field : fields) {
      out.number(field.type);
      out.name(field.name);
    }
  }
  for (const auto& stream : log.streams) {
    out.name(stream.name);
    out.number(place_of(stream.kind));
  }
  for (const std::string& source : log.sources) out.name(source);
  for (const SampleLog::Entry& entry : log.entries) {
    const auto write = [&](const auto& scalar) { out.number(scalar); };
    out.number(entry.step);
    sim::for_each_scalar(entry.sample.header, write);
    std::visit([&](const auto& value) { sim::for_each_scalar(value, write); },
               entry.sample.payload);
  }
  for (const std::uint64_t hash : log.hashes) out.number(hash);
  return out.take();
}

Result<SampleLog> parse_sample_log(std::span<const std::byte> bytes, const std::string& name) {
  Cursor cursor(bytes);
  const auto magic = cursor.take(kMagic.size());
  const std::string_view found(reinterpret_cast<const char*>(magic.data()), magic.size());
  if (found == kOldMagic)
    return bad_input("{}: a log of inputs of an older version ({}); accepted: {}", name, kOldMagic,
                     kMagic);
  if (found != kMagic)
    return bad_input("{}: not a log of samples (its first bytes are not {})", name, kMagic);
  SampleLog log;
  log.step_s = cursor.number<double>();
  log.seed = cursor.number<std::uint64_t>();
  const auto steps = cursor.number<std::uint64_t>();
  const auto samples = cursor.number<std::uint64_t>();
  const auto kinds = cursor.number<std::uint32_t>();
  const auto streams = cursor.number<std::uint32_t>();
  const auto sources = cursor.number<std::uint32_t>();
  if (!cursor.whole()) return bad_input("{}: the log's head is cut off", name);
  if (!(log.step_s > 0.0 && log.step_s <= sim::kMaxStep_s))
    return bad_input("{}: a step of {} s; accepted: over 0 to {} s", name, log.step_s,
                     sim::kMaxStep_s);
  NERITIC_TRY_STATUS(read_tables(cursor, kinds, streams, sources, log, name));
  NERITIC_TRY_STATUS(read_samples(cursor, samples, steps, log, name));
  if (cursor.left() % 8 != 0 || cursor.left() / 8 == 0 || cursor.left() / 8 - 1 != steps)
    return bad_input("{}: {} bytes of hashes; {} steps need 8 each and 8 for the start", name,
                     cursor.left(), steps);
  while (cursor.left() > 0) log.hashes.push_back(cursor.number<std::uint64_t>());
  return log;
}

Status check_streams(const SampleLog& log, const StreamTable& table, const std::string& name) {
  std::vector<bool> used(log.streams.size());
  for (const SampleLog::Entry& entry : log.entries) used[entry.sample.header.stream] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const auto found = table.find(log.streams[i].name);
    if (!found || table[*found].kind != log.streams[i].kind)
      return bad_input("{}: samples of {} found; accepted: of the scene's streams", name,
                       log.streams[i].name);
  }
  return {};
}

Status write_sample_log(const std::filesystem::path& path, const SampleLog& log) {
  return write_file(path, encode_sample_log(log));
}

Result<SampleLog> read_sample_log(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_sample_log(bytes, path.string());
}

}  // namespace neritic::testbed
