#include "engine/scene/scene_table.hpp"

#include "engine/core/refusal.hpp"
#include "engine/scene/number_rows.hpp"

namespace neritic::scene {
namespace {

constexpr std::size_t kMaxRows = 100000;
constexpr double kMaxNumber = 1e9;

// The rows as a table, or the first that is refused. place(i): where row i stands.
template <class Rows, class Values, class Place>
Result<SonarTable> make_table(const Rows& rows, const TableFormat& format, Values values,
                              Place place) {
  SonarTable table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double>& v = values(rows[i]);
    if (!format.x.holds(v[0]) || !format.y.holds(v[1]))
      return refusal(
          place(i), fmt::format("{}, {}", v[0], v[1]),
          fmt::format("{} in {} and {}", format.columns, format.x.text(), format.y.text()));
    if (!table.empty() && !(v[0] > table.back().x))
      return refusal(place(i), fmt::format("{} after {}", v[0], table.back().x),
                     fmt::format("{}, the first column rising", format.columns));
    table.push_back({v[0], v[1]});
  }
  return table;
}

Result<SonarTable> read_file(const std::filesystem::path& file, const TableFormat& format) {
  NERITIC_TRY(
      const auto rows,
      read_rows(file, {.max_number = kMaxNumber, .max_rows = kMaxRows, .columns = format.columns}));
  return make_table(
      rows, format, [](const NumberRow& row) -> const auto& { return row.values; },
      [&](std::size_t i) { return fmt::format("{}:{}", file.string(), rows[i].line); });
}

}  // namespace

bool is_table(const TomlValue& value) {
  return value.kind == TomlValue::Kind::kArray ||
         (value.kind == TomlValue::Kind::kString && value.text.ends_with(".csv"));
}

std::string table_text(const TableFormat& format) {
  return fmt::format("rows [{}] or a .csv file of them", format.columns);
}

SonarTable read_table(TableReader& reader, Key key, const TableFormat& format) {
  const TomlValue* value = reader.find(key);
  if (!value) return {};
  if (!is_table(*value) || (value->kind == TomlValue::Kind::kArray && value->items.empty())) {
    reader.refuse(key, table_text(format));
    return {};
  }
  Result<SonarTable> table = SonarTable{};
  if (value->kind == TomlValue::Kind::kArray) {
    const auto rows = reader.rows(key, {2}, {-kMaxNumber, kMaxNumber});
    table = make_table(
        rows, format, [](const std::vector<double>& row) -> const auto& { return row; },
        [](std::size_t i) { return fmt::format("row {}", i + 1); });
  } else if (const auto file = reader.file(key); !file.empty()) {
    table = read_file(file, format);
  }
  if (table.ok()) return std::move(table).value();
  reader.fail({table.error().code, reader.place(key) + ": " + table.error().message});
  return {};
}

}  // namespace neritic::scene
