// Reads the keys of one TOML table with type and range checks. The first fault sticks: later reads
// give defaults, and status() returns it as one line (file:line: key: found; accepted). One
// thread, while a scene loads.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/scene_includes.hpp"
#include "engine/scene/scene_keys.hpp"

namespace neritic::scene {

// An interval of numbers that a key accepts.
struct Interval {
  double min, max;
  bool min_open = false, max_open = false;
  const char* unit = "";
  bool holds(double value) const;
  std::string text() const;  // "[0, 90] degrees"
};

inline constexpr Interval kAnyMetres{-kFarthest_m, kFarthest_m, false, false, "metres"};
// Keys that cameras and sonars share.
inline constexpr Interval kRate{0, 1000, true, false, "hertz"};
inline constexpr Interval kNear{0, 10, true, false, "metres"};
inline constexpr Interval kAnyTurn{-360.0, 360.0, false, false, "degrees"};

class TableReader {
 public:
  // path: where the table stands in the scene, "sonars[0]"; empty for the scene itself. A key that
  // is none of keys is the first fault.
  TableReader(const SceneSource& source, const TomlValue& table, std::string path, KeyList keys);

  bool has(Key key) const { return find(key) != nullptr; }
  const TomlValue* find(Key key) const;

  bool flag(Key key, bool otherwise);
  double number(Key key, double otherwise, const Interval& interval);
  std::uint64_t whole(Key key, std::uint64_t otherwise, std::uint64_t min, std::uint64_t max);
  std::string text(Key key, std::string otherwise);
  std::string choice(Key key, std::string otherwise, KeyList options);
  // A file beside the file that names it; empty where the key is absent. The file must exist.
  std::filesystem::path file(Key key);
  // counts: the accepted numbers of elements, e.g. {3} or {3, 4, 5}. Empty where the key is absent.
  std::vector<double> numbers(Key key, std::vector<std::size_t> counts, const Interval& interval);
  Vec3 vector3(Key key, const Vec3& otherwise, const Interval& interval);
  // Rows of numbers, as numbers() each.
  std::vector<std::vector<double>> rows(Key key, std::vector<std::size_t> counts,
                                        const Interval& interval);
  // Entries of an array of tables, or an empty list.
  const std::vector<TomlValue>& tables(Key key);
  // A table, or nullptr where the key is absent.
  const TomlValue* table(Key key);

  // Faults. found and accepted complete "found ...; accepted: ...".
  void refuse(Key key, std::string_view accepted);
  void refuse_table(std::string_view found, std::string_view accepted);
  void fail(Error error);

  Status status() const;
  bool ok() const { return !error_; }
  TomlWhere where() const { return table_->where; }
  TomlWhere where(Key key) const;
  std::string path(Key key) const;
  // "scene.toml:12: sonars[0].range_m"
  std::string place(Key key) const;
  const SceneSource& source() const { return *source_; }

 private:
  bool check_numbers(Key key, const TomlValue& value, const std::vector<std::size_t>& counts,
                     const Interval& interval, std::vector<double>& out);

  const SceneSource* source_;
  const TomlValue* table_;
  std::string path_;
  KeyList keys_;
  std::optional<Error> error_;
};

// [sun] and [ambient] (scene_read_light.cpp).
Result<Sun> read_sun(const SceneSource& source, const TomlValue& table);
Result<Ambient> read_ambient(const SceneSource& source, const TomlValue& table);
// The terms under [water] (scene_water.hpp), and, when all objects are known, those of their
// places.
void read_water_terms(TableReader& reader, Water& water);
Status resolve_water_sources(Scene& scene);
// Gives the water's layers to the sonars and modems that name no water of their own.
Status resolve_water_column(Scene& scene);

// The term of the table under key, where there is one; its fault becomes the parent's.
template <class Term, class Read>
std::optional<Term> read_term(TableReader& parent, Key key, KeyList keys, Read read) {
  const TomlValue* table = parent.table(key);
  if (!table) return std::nullopt;
  TableReader reader(parent.source(), *table, parent.path(key), keys);
  Term term = read(reader);
  if (!reader.ok()) parent.fail(reader.status().error());
  return term;
}

}  // namespace neritic::scene
