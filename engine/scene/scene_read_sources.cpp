// Reads [sources], the devices that feed a diver's inputs, a line each; and gives each group that
// nothing else was chosen for to the device that feeds it.
#include <algorithm>

#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr double kSound_hz = 16'000.0;
constexpr Interval kSoundRate{4000, 192'000, false, false, "hertz"};
constexpr std::size_t kMostSources = 64;

std::string_view take_word(std::string_view& text) {
  const std::size_t from = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t to = std::min(text.find(' ', from), text.size());
  const std::string_view word = text.substr(from, to - from);
  text.remove_prefix(std::min(text.find_first_not_of(' ', to), text.size()));
  return word;
}

std::string names_of_kinds() {
  std::string names;
  for (const DeviceKind& kind : kDeviceKinds)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
  return names;
}
std::string ways_of(const DeviceKind& kind) {
  std::string ways;
  for (const std::string_view way : kind.ways)
    if (!way.empty()) ways += fmt::format("{}{}", ways.empty() ? "" : ", ", way);
  return ways;
}

// "9763", "0.0.0.0:9763" or nothing.
Result<Address> address_of(std::string_view way, std::string_view word, std::uint16_t port) {
  const char* scheme = way == "udp" ? "udp" : "tcp";
  std::string text = word.empty()                  ? fmt::format("{}://127.0.0.1:{}", scheme, port)
                     : word.find(':') == word.npos ? fmt::format("{}://127.0.0.1:{}", scheme, word)
                                                   : fmt::format("{}://{}", scheme, word);
  const auto address = parse_address(text);
  if (!address.ok())
    return refusal("", fmt::format("'{}'", printable(word)),
                   "a port from 1 to 65535, or an IPv4 address and a port, as 0.0.0.0:9763");
  return address;
}

class SourceReader {
 public:
  SourceReader(SceneDraft& draft, TableReader& table) : draft_(draft), table_(table) {}

  void read(const TomlEntry& entry) {
    const Key key = entry.key;
    DeviceSource source;
    if (entry.value.is_table()) {
      TableReader reader(table_.source(), entry.value, table_.path(key), kSourceKeys);
      if (!reader.has("device")) reader.refuse("device", "\"DEVICE WAY PLACE\"");
      source = parsed(reader, "device");
      source.diver = reader.text("diver", "");
      source.character = static_cast<int>(reader.whole("character", 0, 0, 255));
      source.rate_hz = reader.number("rate_hz", kSound_hz, kSoundRate);
      for (const auto& [name, device] :
           {std::pair<Key, Key>{"character", "mxtp"}, {"rate_hz", "microphone"}})
        if (reader.has(name) && source.device != device)
          reader.refuse(name, fmt::format("no such key of a {}", source.device));
      if (!reader.ok()) return table_.fail(reader.status().error());
    } else {
      source = parsed(table_, key);
      source.rate_hz = kSound_hz;
    }
    if (!table_.ok()) return;
    source.name = entry.key;
    if (source.by == "wav")
      source.port = table_.source().resolve(entry.where, source.port).string();
    give(key, source);
  }

 private:
  static DeviceSource parsed(TableReader& reader, Key key) {
    const auto source = parse_device(reader.text(key, "mxtp udp"));
    if (!source.ok()) {
      if (reader.ok()) reader.fail(bad_input("{}: {}", reader.place(key), source.error().message));
      return {};
    }
    return *source;
  }

  // The diver that is named, else the first one.
  ObjectDraft* diver_of(const DeviceSource& source) {
    const auto at = std::ranges::find_if(draft_.objects, [&](const ObjectDraft& object) {
      return object.object.human && (source.diver.empty() || object.object.name == source.diver);
    });
    return at == draft_.objects.end() ? nullptr : &*at;
  }

  void give(Key key, DeviceSource& source) {
    ObjectDraft* diver = diver_of(source);
    if (!diver) {
      table_.fail(refusal(table_.place(key),
                          source.diver.empty()
                              ? "a device in a scene without a diver"
                              : fmt::format("no diver '{}'", printable(source.diver)),
                          "an object with human, whom the device is worn by"));
      return;
    }
    source.diver = diver->object.name;
    auto& inputs = diver->object.human->inputs;
    for (const std::string_view group : device_kind(source.device)->groups)
      if (!group.empty() && std::ranges::find(inputs, group, &InputChoice::group) == inputs.end())
        inputs.push_back({std::string(group), source.name, {}, "autopilot"});
    draft_.scene.sources.push_back(std::move(source));
  }

  SceneDraft& draft_;
  TableReader& table_;
};

}  // namespace

const DeviceKind* device_kind(std::string_view name) {
  const auto at = std::ranges::find(kDeviceKinds, name, &DeviceKind::name);
  return at == std::end(kDeviceKinds) ? nullptr : at;
}

Result<DeviceSource> parse_device(std::string_view text) {
  std::string_view left = text;
  DeviceSource source;
  source.device = take_word(left);
  const DeviceKind* kind = device_kind(source.device);
  if (!kind)
    return refusal("", fmt::format("device '{}'", printable(source.device)), names_of_kinds());
  source.by = take_word(left);
  if (source.by.empty() || std::ranges::find(kind->ways, source.by) == kind->ways.end())
    return refusal("", fmt::format("'{}' after {}", printable(source.by), kind->name),
                   ways_of(*kind));
  if (source.by == "udp" || source.by.starts_with("tcp")) {
    NERITIC_TRY(source.address, address_of(source.by, left, kind->port));
    return source;
  }
  while (left.ends_with(' ')) left.remove_suffix(1);
  source.port = left;
  if (source.port.empty() && source.by == "alsa") source.port = "default";
  if (source.port.empty())
    return refusal("", fmt::format("nothing after '{}'", source.by),
                   source.by == "bluetooth" ? "the strap's address or name, as Polar H10"
                   : source.by == "wav"     ? "a .wav file"
                                            : "the stream's name");
  return source;
}

Status read_sources(SceneDraft& draft, const SceneSource& source, const TomlValue* sources) {
  if (!sources) return {};
  const std::string place = fmt::format("{}: sources", source.place(sources->where));
  if (!draft.scene.physics)
    return refusal(place, "a table", "no such key in a scene without [physics]");
  if (sources->entries.size() > kMostSources)
    return refusal(place, fmt::format("{} sources", sources->entries.size()),
                   fmt::format("up to {}", kMostSources));
  std::vector<Key> names;
  for (const TomlEntry& entry : sources->entries) names.push_back(entry.key);
  TableReader table(source, *sources, "sources", names);
  SourceReader reader(draft, table);
  for (const TomlEntry& entry : sources->entries) {
    NERITIC_TRY_STATUS(
        check_source_name(fmt::format("{}: sources", source.place(entry.where)), entry.key));
    reader.read(entry);
  }
  return table.status();
}

}  // namespace neritic::scene
