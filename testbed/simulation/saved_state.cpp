#include "testbed/simulation/saved_state.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"

namespace neritic::testbed {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr std::string_view kMagic = "NRTCSAVE";
constexpr std::uint32_t kVersion = 7;

struct Header {
  char magic[8];
  std::uint32_t version, sources;
  std::uint64_t scene_hash, seed, layout_hash, step;
  double time_s;
  std::uint64_t state_bytes, input_bytes;
};
static_assert(sizeof(Header) == 72);

std::uint64_t checksum(std::span<const std::byte> bytes) {
  Hash64 hash;
  hash.add_span(bytes);
  return hash.value();
}

template <class T>
void append(std::vector<std::byte>& out, const T& value) {
  const auto bytes = sim::bytes_of(value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class Block>
void fill(Block& block, std::span<const std::byte> bytes) {
  if (!bytes.empty()) std::memcpy(block.bytes().data(), bytes.data(), bytes.size());
}

template <class T>
void add_fields(Hash64& hash, const T& like) {
  sim::for_each_named_scalar(like, [&](const std::string& name, const auto& scalar) {
    using Scalar = std::remove_cvref_t<decltype(scalar)>;
    hash.add(std::is_floating_point_v<Scalar> ? 'f' : std::is_signed_v<Scalar> ? 'i' : 'u');
    hash.add(static_cast<std::uint64_t>(sizeof scalar));
    hash.add_span(std::span<const char>(name.data(), name.size()));
  });
}

// Calls act with every number of a source.
template <class State, class Inputs, class Act>
void for_each_source(State& state, Inputs& inputs, const Act& act) {
  const auto each = [&](auto&& participants, auto groups) {
    for (auto& participant : participants)
      for (auto& group : participant.*groups) act(group.source), act(group.unheeded_source);
  };
  each(state.vehicles(), &VehicleState::groups);
  each(state.humans(), &HumanPhysics::groups);
  each(state.objects(), &ObjectState::groups);
  each(inputs.vehicles(), &VehicleInputs::control);
  each(inputs.humans(), &DiverInputs::control);
  each(inputs.objects(), &ObjectInputs::control);
}

Status check_header(const Header& header, const StateFormat& format, std::size_t size,
                    const std::string& name) {
  if (header.version != kVersion)
    return bad_input("{}: a saved state of version {}; accepted: {}", name, header.version,
                     kVersion);
  if (header.seed != format.seed)
    return bad_input("{}: a state of seed {}; accepted: one of seed {}, as here", name, header.seed,
                     format.seed);
  if (header.scene_hash != format.scene_hash)
    return bad_input("{}: a state of another scene, whose hash is {:016x}; accepted: {:016x}", name,
                     header.scene_hash, format.scene_hash);
  const std::uint64_t layout = format.layout_hash();
  if (header.layout_hash != layout)
    return bad_input("{}: a state of another layout, whose hash is {:016x}; accepted: {:016x}",
                     name, header.layout_hash, layout);
  if (header.state_bytes != format.state.bytes().size() ||
      header.input_bytes != format.inputs.bytes().size())
    return bad_input("{}: {} bytes of state and {} of inputs; accepted: {} and {}", name,
                     header.state_bytes, header.input_bytes, format.state.bytes().size(),
                     format.inputs.bytes().size());
  const std::size_t least = sizeof(Header) + header.state_bytes + header.input_bytes +
                            header.sources + sizeof(std::uint64_t);
  if (size < least)
    return bad_input("{}: {} bytes; accepted: {} or more, as its head says", name, size, least);
  if (header.sources < format.sources.size() || header.sources > SampleInbox::kMaxSources)
    return bad_input("{}: {} sources; accepted: {} to {}", name, header.sources,
                     format.sources.size(), SampleInbox::kMaxSources);
  return {};
}

// The names that fill bytes.
Result<std::vector<std::string>> parse_names(std::span<const std::byte> bytes, std::size_t count,
                                             const std::vector<std::string>& first,
                                             const std::string& name) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < bytes.size();) {
    const auto length = std::to_integer<std::size_t>(bytes[at++]);
    if (length > bytes.size() - at) return bad_input("{}: cut off in the name of a source", name);
    std::string source(length, ' ');
    std::memcpy(source.data(), bytes.data() + at, length);
    at += length;
    if (!out.empty())
      NERITIC_TRY_STATUS(check_source_name(fmt::format("{}: source {}", name, out.size()), source));
    if (std::ranges::find(out, source) != out.end())
      return refusal(fmt::format("{}: source {}", name, out.size()), source + " again",
                     "each name once");
    if (out.size() < first.size() && source != first[out.size()])
      return bad_input("{}: source {}: found '{}'; accepted: '{}', as in the scene", name,
                       out.size(), source, first[out.size()]);
    out.push_back(std::move(source));
  }
  if (out.size() != count)
    return bad_input("{}: {} names of sources; accepted: {}, as its head says", name, out.size(),
                     count);
  return out;
}

}  // namespace

std::uint64_t StateFormat::layout_hash() const {
  Hash64 hash;
  add_fields(hash, PhysicsState::example());
  add_fields(hash, PhysicsInputs(1, 1, 1, 1, 1, 1, 1));
  for (const std::uint64_t count : state.counts()) hash.add(count);
  for (const std::uint64_t count : inputs.counts()) hash.add(count);
  return hash.value();
}

std::vector<std::byte> encode_state(const StateFormat& format, const SavedState& saved) {
  NERITIC_CHECK(saved.state.counts() == format.state.counts() &&
                    saved.inputs.counts() == format.inputs.counts(),
                "{} and {} bytes", saved.state.bytes().size(), saved.inputs.bytes().size());
  Header header{{},
                kVersion,
                static_cast<std::uint32_t>(saved.sources.size()),
                format.scene_hash,
                format.seed,
                format.layout_hash(),
                saved.step,
                sim::StepTime{saved.step, format.step_s}.time_s(),
                saved.state.bytes().size(),
                saved.inputs.bytes().size()};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  std::vector<std::byte> out;
  append(out, header);
  append(out, saved.state);
  append(out, saved.inputs);
  for (const std::string& source : saved.sources) {
    NERITIC_CHECK(source.size() <= kLongestSourceName, "a source's name of {} bytes",
                  source.size());
    out.push_back(static_cast<std::byte>(source.size()));
    const auto bytes = std::as_bytes(std::span(source));
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  append(out, checksum(out));
  return out;
}

Result<SavedState> parse_state(const StateFormat& format, std::span<const std::byte> bytes,
                               const std::string& name) {
  if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return bad_input("{}: found no saved state; accepted: bytes that begin with {}", name, kMagic);
  if (bytes.size() < sizeof(Header))
    return bad_input("{}: {} bytes, cut off in its head of {}", name, bytes.size(), sizeof(Header));
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  NERITIC_TRY_STATUS(check_header(header, format, bytes.size(), name));
  const auto body = bytes.first(bytes.size() - sizeof(std::uint64_t));
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + body.size(), sizeof sum);
  if (sum != checksum(body))
    return bad_input("{}: damaged: its bytes have the hash {:016x}, its end says {:016x}", name,
                     checksum(body), sum);
  const std::size_t blocks = sizeof header + header.state_bytes + header.input_bytes;
  SavedState out{header.step, format.state, format.inputs, {}};
  NERITIC_TRY(out.sources, parse_names(body.subspan(blocks), header.sources, format.sources, name));
  fill(out.state, body.subspan(sizeof header, header.state_bytes));
  fill(out.inputs, body.subspan(sizeof header + header.state_bytes, header.input_bytes));
  const double time_s = sim::StepTime{header.step, format.step_s}.time_s();
  if (header.time_s != time_s)
    return bad_input("{}: step {} at {} s; accepted: {} s", name, header.step, header.time_s,
                     time_s);
  if (!sim::all_finite(out.state) || !sim::all_finite(out.inputs))
    return bad_input("{}: a number in it is not finite; accepted: finite numbers", name);
  return out;
}

Status write_state(const std::filesystem::path& path, const StateFormat& format,
                   const SavedState& saved) {
  return write_file(path, encode_state(format, saved));
}

Result<SavedState> read_state(const std::filesystem::path& path, const StateFormat& format) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_state(format, bytes, path.string());
}

SavedState saved_state(const PhysicsSimulation& simulation, const StateFormat& format) {
  const PhysicsInputs& inputs = simulation.inputs();
  const PhysicsState& state = simulation.newest().state;
  // Sources that were opened and never used stay out, so that the bytes do not depend on who looks.
  std::size_t named = format.sources.size();
  for_each_source(state, inputs, [&](std::uint64_t source) {
    named = std::max(named, static_cast<std::size_t>(source) + 1);
  });
  std::vector<std::string> names = simulation.inbox().source_names();
  names.resize(std::min(named, names.size()));
  return {simulation.newest().step, state, inputs, std::move(names)};
}

Result<std::vector<SourceId>> open_sources(SampleInbox& inbox, const SavedState& saved) {
  std::vector<SourceId> out;
  for (const std::string& name : saved.sources) {
    auto id = inbox.find(name);
    if (!id) {
      NERITIC_TRY(id, inbox.open(name));
    }
    out.push_back(*id);
  }
  return out;
}

void restore_state(PhysicsSimulation& simulation, const SavedState& saved,
                   std::span<const SourceId> sources) {
  SavedState here = saved;
  for_each_source(here.state, here.inputs, [&](std::uint64_t& source) {
    if (source < sources.size()) source = sources[source];
  });
  simulation.restore(here.step, here.state, here.inputs);
  simulation.inbox().begin_anew();
}

void restore_state(PhysicsSimulation& simulation, const SavedState& saved) {
  const auto sources = open_sources(simulation.inbox(), saved);
  NERITIC_CHECK(sources.ok(), "{}", sources.ok() ? "" : sources.error().message);
  restore_state(simulation, saved, *sources);
}

}  // namespace neritic::testbed
