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

constexpr std::string_view kMagic = "NRTCLOG3", kOldMagics[] = {"NRTCLOG1", "NRTCLOG2"};
constexpr char kSource = 'N', kHash = 'H', kSample = 'S', kEnd = 'E';
constexpr std::size_t kMaxStreams = 1'000'000, kMaxFields = 4096, kMaxName = 255;
constexpr std::size_t kLeastName = 2;  // of the shortest stream

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

template <class T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void put_name(std::string& out, std::string_view name) {
  NERITIC_CHECK(!name.empty() && name.size() <= kMaxName, "name '{}'", name);
  put(out, static_cast<std::uint8_t>(name.size()));
  out += name;
}

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

Status read_tables(Cursor& cursor, SampleLog& log, const std::string& name) {
  const auto kinds = cursor.number<std::uint32_t>(), streams = cursor.number<std::uint32_t>();
  if (!cursor.whole()) return bad_input("{}: the log's head is cut off", name);
  if (kinds > kPayloadKinds)
    return bad_input("{}: {} kinds of samples; accepted: up to {}", name, kinds, kPayloadKinds);
  std::vector<PayloadKind> kind_of;
  for (std::uint32_t i = 0; i < kinds; ++i) {
    NERITIC_TRY(const PayloadKind kind, read_kind(cursor, i, name));
    kind_of.push_back(kind);
  }
  if (streams > kMaxStreams || streams > cursor.left() / kLeastName)
    return bad_input("{}: {} streams named, the file is shorter", name, streams);
  for (std::uint32_t i = 0; i < streams; ++i) {
    SampleLog::LoggedStream stream{cursor.name(), {}};
    const auto kind = cursor.number<std::uint32_t>();
    if (!cursor.whole() || kind >= kinds || !printable(stream.name))
      return bad_input("{}: stream {} is cut off, or has no name or kind", name, i);
    stream.kind = kind_of[kind];
    log.streams.push_back(std::move(stream));
  }
  return {};
}

Status read_source(Cursor& cursor, SampleLog& log, const std::string& name) {
  std::string source = cursor.name();
  if (cursor.whole() && !printable(source))
    return bad_input("{}: source {} has no name in printable text", name, log.sources.size());
  if (cursor.whole()) log.sources.push_back(std::move(source));
  return {};
}

Status read_sample(Cursor& cursor, SampleLog& log, const std::string& name) {
  const std::size_t index = log.entries.size();
  SampleLog::Entry entry;
  sim::for_each_scalar(entry.sample.header, [&](auto& scalar) {
    scalar = cursor.number<std::remove_cvref_t<decltype(scalar)>>();
  });
  const SampleHeader& header = entry.sample.header;
  if (!cursor.whole()) return {};
  if (log.hashes.empty())
    return bad_input("{}: sample {} comes before the hash of the start", name, index);
  if (header.stream >= log.streams.size() || header.source >= log.sources.size())
    return bad_input("{}: sample {} is of no stream or source of the file", name, index);
  if (!plausible(header.captured_ns) || !plausible(header.arrived_ns))
    return bad_input("{}: sample {} is of {} and {} ns; accepted: up to {} from 0", name, index,
                     header.captured_ns, header.arrived_ns, kMostTime_ns);
  entry.step = log.steps();
  entry.sample.payload = empty_payload(log.streams[header.stream].kind);
  std::visit(
      [&](auto& value) {
        sim::for_each_scalar(value, [&](auto& scalar) {
          scalar = cursor.number<std::remove_cvref_t<decltype(scalar)>>();
        });
      },
      entry.sample.payload);
  if (!cursor.whole()) return {};
  if (!all_finite(entry.sample.payload))
    return bad_input("{}: sample {}, of {} at step {}, is not finite", name, index,
                     log.streams[header.stream].name, entry.step);
  log.entries.push_back(entry);
  return {};
}

Status read_end(Cursor& cursor, const SampleLog& log, const std::string& name) {
  const auto steps = cursor.number<std::uint64_t>(), samples = cursor.number<std::uint64_t>();
  if (!cursor.whole()) return {};
  const auto used = std::ranges::count_if(
      log.entries, [&](const SampleLog::Entry& entry) { return entry.step < log.steps(); });
  if (log.hashes.empty() || steps != log.steps() || samples != static_cast<std::uint64_t>(used))
    return bad_input("{}: its end names {} steps and {} samples; found: {} and {}", name, steps,
                     samples, log.steps(), used);
  if (cursor.left() > 0) return bad_input("{}: {} bytes after its end", name, cursor.left());
  return {};
}

// Up to the end, or to where the log was cut off.
Status read_records(Cursor& cursor, SampleLog& log, const std::string& name) {
  while (cursor.left() > 0) {
    const char sort = cursor.number<char>();
    if (sort == kEnd) {
      NERITIC_TRY_STATUS(read_end(cursor, log, name));
      log.whole = cursor.whole();
      return {};
    }
    if (sort == kHash) {
      const auto hash = cursor.number<std::uint64_t>();
      if (cursor.whole()) log.hashes.push_back(hash);
    } else if (sort == kSource) {
      NERITIC_TRY_STATUS(read_source(cursor, log, name));
    } else if (sort == kSample) {
      NERITIC_TRY_STATUS(read_sample(cursor, log, name));
    } else {
      return bad_input("{}: a record of sort {:#x} found; accepted: N, H, S, E", name,
                       static_cast<unsigned char>(sort));
    }
  }
  log.whole = false;
  return {};
}

}  // namespace

std::vector<SampleLog::LoggedStream> logged_streams(const StreamTable& table) {
  std::vector<SampleLog::LoggedStream> streams;
  for (const Stream& stream : table.streams()) streams.push_back({stream.name, stream.kind});
  return streams;
}

SampleLogWriter::SampleLogWriter(double step_s, std::uint64_t seed,
                                 const std::vector<SampleLog::LoggedStream>& streams) {
  std::vector<PayloadKind> kinds;  // of the streams, in their order
  const auto place_of = [&](PayloadKind kind) {
    return static_cast<std::uint32_t>(std::ranges::find(kinds, kind) - kinds.begin());
  };
  for (const auto& stream : streams)
    if (place_of(stream.kind) == kinds.size()) kinds.push_back(stream.kind);
  bytes_ = kMagic;
  put(bytes_, step_s);
  put(bytes_, seed);
  put(bytes_, static_cast<std::uint32_t>(kinds.size()));
  put(bytes_, static_cast<std::uint32_t>(streams.size()));
  for (const PayloadKind kind : kinds) {
    const auto fields = fields_of(kind);
    put_name(bytes_, name_of(kind));
    put(bytes_, static_cast<std::uint32_t>(fields.size()));
    for (const Field& field : fields) {
      put(bytes_, field.type);
      put_name(bytes_, field.name);
    }
  }
  for (const auto& stream : streams) {
    put_name(bytes_, stream.name);
    put(bytes_, place_of(stream.kind));
  }
}

void SampleLogWriter::source(std::string_view name) {
  put(bytes_, kSource);
  put_name(bytes_, name);
  ++sources_;
}

void SampleLogWriter::sample(const Sample& sample) {
  NERITIC_CHECK(sample.header.source < sources_ && hashes_ > 0, "source {} of {}, {} hashes",
                sample.header.source, sources_, hashes_);
  const auto write = [&](const auto& scalar) { put(bytes_, scalar); };
  put(bytes_, kSample);
  sim::for_each_scalar(sample.header, write);
  std::visit([&](const auto& value) { sim::for_each_scalar(value, write); }, sample.payload);
  ++samples_;
}

void SampleLogWriter::hash(std::uint64_t hash) {
  put(bytes_, kHash);
  put(bytes_, hash);
  ++hashes_;
  used_ = samples_;
}

void SampleLogWriter::end() {
  NERITIC_CHECK(hashes_ > 0, "a log has at least the hash of its start");
  put(bytes_, kEnd);
  put(bytes_, hashes_ - 1);
  put(bytes_, used_);
}

std::string encode_sample_log(const SampleLog& log) {
  SampleLogWriter out(log.step_s, log.seed, log.streams);
  for (const std::string& source : log.sources) out.source(source);
  std::size_t next = 0;
  for (std::uint64_t step = 0; step < log.hashes.size(); ++step) {
    out.hash(log.hashes[step]);
    for (; next < log.entries.size() && log.entries[next].step == step; ++next)
      out.sample(log.entries[next].sample);
  }
  NERITIC_CHECK(next == log.entries.size(), "entry {} is of step {} of {}", next,
                log.entries[next].step, log.steps());
  out.end();
  return out.take();
}

Result<SampleLog> parse_sample_log(std::span<const std::byte> bytes, const std::string& name) {
  Cursor cursor(bytes);
  const auto magic = cursor.take(kMagic.size());
  const std::string_view found(reinterpret_cast<const char*>(magic.data()), magic.size());
  if (std::ranges::find(kOldMagics, found) != std::end(kOldMagics))
    return bad_input("{}: a log of inputs of an older version ({}); accepted: {}", name, found,
                     kMagic);
  if (found != kMagic)
    return bad_input("{}: not a log of samples (its first bytes are not {})", name, kMagic);
  SampleLog log;
  log.step_s = cursor.number<double>();
  log.seed = cursor.number<std::uint64_t>();
  if (!cursor.whole()) return bad_input("{}: the log's head is cut off", name);
  if (!(log.step_s > 0.0 && log.step_s <= sim::kMaxStep_s))
    return bad_input("{}: a step of {} s; accepted: over 0 to {} s", name, log.step_s,
                     sim::kMaxStep_s);
  NERITIC_TRY_STATUS(read_tables(cursor, log, name));
  NERITIC_TRY_STATUS(read_records(cursor, log, name));
  if (log.hashes.empty()) return bad_input("{}: ends before the hash of its start", name);
  // Of a step that did not end.
  while (!log.entries.empty() && log.entries.back().step >= log.steps()) log.entries.pop_back();
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
  return write_text(path, encode_sample_log(log));
}

Result<SampleLog> read_sample_log(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_sample_log(bytes, path.string());
}

}  // namespace neritic::testbed
