#include "engine/scene/scene_reader.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::scene {
namespace {

constexpr std::size_t kMaxTextBytes = 1000;

std::string counts_text(const std::vector<std::size_t>& counts) {
  std::string out;
  for (std::size_t i = 0; i < counts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == counts.size() ? " or " : ", ") + std::to_string(counts[i]);
  return out;
}

// The key that an unknown key may stand for: the same a table deeper, else one that begins with it,
// else the one spelt most alike.
std::string meant_key(std::string_view key, KeyList keys) {
  const auto has = [](KeyList list, Key wanted) {
    return std::ranges::find(list, wanted) != list.end();
  };
  for (const KeyTable& table : kSonarTables)
    if (has(keys, table.name) && has(table.keys, key)) return fmt::format("{}.{}", table.name, key);
  constexpr std::size_t kBeginning = 3;
  if (key.size() >= kBeginning)
    for (const Key known : keys)
      if (std::string_view(known).starts_with(key)) return std::string(std::string_view(known));
  return std::string(nearest(key, keys));
}

}  // namespace

bool Interval::holds(double value) const {
  return std::isfinite(value) && (min_open ? value > min : value >= min) &&
         (max_open ? value < max : value <= max);
}

std::string Interval::text() const {
  return fmt::format("{}{}, {}{}{}{}", min_open ? '(' : '[', min, max, max_open ? ')' : ']',
                     *unit ? " " : "", unit);
}

TableReader::TableReader(const SceneSource& source, const TomlValue& table, std::string path,
                         KeyList keys)
    : source_(&source), table_(&table), path_(std::move(path)), keys_(keys) {
  for (const TomlEntry& entry : table.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    fail(bad_input("{}: {}: unknown key; nearest known key: {}", source.place(entry.where),
                   this->path(printable(entry.key)), meant_key(entry.key, keys)));
    return;
  }
}

const TomlValue* TableReader::find(Key key) const {
  NERITIC_CHECK(std::find(keys_.begin(), keys_.end(), key) != keys_.end(), "key {}", key);
  const TomlEntry* entry = table_->find(key);
  return entry ? &entry->value : nullptr;
}

TomlWhere TableReader::where(Key key) const {
  const TomlEntry* entry = table_->find(key);
  return entry ? entry->where : table_->where;
}

std::string TableReader::path(Key key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

std::string TableReader::place(Key key) const {
  return source_->place(where(key)) + ": " + path(key);
}

void TableReader::fail(Error error) {
  if (!error_) error_ = std::move(error);
}

void TableReader::refuse(Key key, std::string_view accepted) {
  const TomlValue* value = find(key);
  fail(refusal(place(key), value ? describe(*value) : "nothing", accepted));
}

void TableReader::refuse_table(std::string_view found, std::string_view accepted) {
  const std::string file_line = source_->place(table_->where);
  fail(refusal(path_.empty() ? file_line : file_line + ": " + path_, found, accepted));
}

Status TableReader::status() const {
  if (error_) return *error_;
  return {};
}

bool TableReader::flag(Key key, bool otherwise) {
  const TomlValue* value = find(key);
  if (!value) return otherwise;
  if (value->kind == TomlValue::Kind::kBool) return value->boolean;
  refuse(key, "true or false");
  return otherwise;
}

double TableReader::number(Key key, double otherwise, const Interval& interval) {
  const TomlValue* value = find(key);
  if (!value) return otherwise;
  if (value->is_number() && interval.holds(value->number)) return value->number;
  refuse(key, "a number in " + interval.text());
  return otherwise;
}

std::uint64_t TableReader::whole(Key key, std::uint64_t otherwise, std::uint64_t min,
                                 std::uint64_t max) {
  const TomlValue* value = find(key);
  if (!value) return otherwise;
  if (value->kind == TomlValue::Kind::kInteger && value->integer >= 0) {
    const auto whole = static_cast<std::uint64_t>(value->integer);
    if (whole >= min && whole <= max) return whole;
  }
  refuse(key, fmt::format("a whole number from {} to {}", min, max));
  return otherwise;
}

std::string TableReader::text(Key key, std::string otherwise) {
  const TomlValue* value = find(key);
  if (!value) return otherwise;
  const bool plain = value->kind == TomlValue::Kind::kString &&
                     value->text.size() <= kMaxTextBytes && !value->text.empty() &&
                     printable(value->text, kMaxTextBytes) == value->text;
  if (plain) return value->text;
  refuse(key, "text on one line, in quotes");
  return otherwise;
}

std::string TableReader::choice(Key key, std::string otherwise, KeyList options) {
  const TomlValue* value = find(key);
  if (!value) return otherwise;
  if (value->kind == TomlValue::Kind::kString &&
      std::find(options.begin(), options.end(), value->text) != options.end())
    return value->text;
  refuse(key, "one of " + join(options));
  return otherwise;
}

std::filesystem::path TableReader::file(Key key) {
  const std::string written = text(key, "");
  if (written.empty()) return {};
  const std::filesystem::path path = source_->resolve(find(key)->where, written);
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return path;
  refuse(key, fmt::format("a file; {} is none", path.string()));
  return {};
}

bool TableReader::check_numbers(Key key, const TomlValue& value,
                                const std::vector<std::size_t>& counts, const Interval& interval,
                                std::vector<double>& out) {
  bool good = value.kind == TomlValue::Kind::kArray &&
              std::find(counts.begin(), counts.end(), value.items.size()) != counts.end();
  for (const TomlValue& item : value.items)
    good = good && item.is_number() && interval.holds(item.number);
  if (!good) {
    fail(refusal(
        fmt::format("{}: {}", source_->place(value.where), path(key)), describe(value),
        fmt::format("a list of {} numbers, each in {}", counts_text(counts), interval.text())));
    return false;
  }
  out.reserve(value.items.size());
  for (const TomlValue& item : value.items) out.push_back(item.number);
  return true;
}

std::vector<double> TableReader::numbers(Key key, std::vector<std::size_t> counts,
                                         const Interval& interval) {
  std::vector<double> out;
  if (const TomlValue* value = find(key)) check_numbers(key, *value, counts, interval, out);
  return out;
}

Vec3 TableReader::vector3(Key key, const Vec3& otherwise, const Interval& interval) {
  const std::vector<double> values = numbers(key, {3}, interval);
  return values.size() == 3 ? Vec3(values[0], values[1], values[2]) : otherwise;
}

std::vector<std::vector<double>> TableReader::rows(Key key, std::vector<std::size_t> counts,
                                                   const Interval& interval) {
  std::vector<std::vector<double>> out;
  const TomlValue* value = find(key);
  if (!value) return out;
  if (value->kind != TomlValue::Kind::kArray) {
    refuse(key, fmt::format("a list of lists of {} numbers", counts_text(counts)));
    return out;
  }
  out.resize(value->items.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!check_numbers(key, value->items[i], counts, interval, out[i])) return {};
  return out;
}

const std::vector<TomlValue>& TableReader::tables(Key key) {
  static const std::vector<TomlValue> kNone;
  const TomlValue* value = find(key);
  if (!value) return kNone;
  if (value->is_table_array()) return value->items;
  if (value->kind != TomlValue::Kind::kArray || !value->items.empty())
    refuse(key, fmt::format("tables, each under [[{}]]", key));
  return kNone;
}

const TomlValue* TableReader::table(Key key) {
  const TomlValue* value = find(key);
  if (!value || value->is_table()) return value;
  refuse(key, fmt::format("a table, under [{}]", key));
  return nullptr;
}

}  // namespace neritic::scene
