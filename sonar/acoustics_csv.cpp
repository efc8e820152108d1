#include "sonar/acoustics_csv.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/scene/scene_text.hpp"

namespace neritic::sonar {
namespace {

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The next line without its comment; text loses it.
std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  return trim(line.substr(0, line.find('#')));
}

Status check_number(const std::string& place, const char* column, double value, double low,
                    double high) {
  if (value >= low && value <= high) return {};
  return bad_input("{}: {} is {}; accepted: a number in [{:g}, {:g}]", place, column, value, low,
                   high);
}

Status check_row(const std::string& place, const TableFormat& format, const TableRow& row,
                 const TableRow* previous) {
  NERITIC_TRY_STATUS(check_number(place, format.x_name, row.x, format.x_min, format.x_max));
  NERITIC_TRY_STATUS(check_number(place, format.y_name, row.y, format.y_min, format.y_max));
  if (previous && !(row.x > previous->x))
    return bad_input("{}: {} is {} after {}; accepted: rising values", place, format.x_name, row.x,
                     previous->x);
  return {};
}

Result<TableRow> parse_row(std::string_view line, const std::string& place,
                           const TableFormat& format) {
  const auto comma = line.find(',');
  const auto x = scene::parse_number(trim(line.substr(0, comma)));
  const auto y = comma == std::string_view::npos
                     ? std::nullopt
                     : scene::parse_number(trim(line.substr(comma + 1)));
  if (!x || !y)
    return bad_input("{}: found '{}'; accepted: {},{}", place, scene::printable(line),
                     format.x_name, format.y_name);
  return TableRow{*x, *y};
}

bool is_heading(std::string_view line) {
  return !scene::parse_number(trim(line.substr(0, line.find(','))));
}

}  // namespace

Result<Table> parse_table(std::string_view text, const std::string& name,
                          const TableFormat& format) {
  Table table;
  bool first = true;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (line.empty()) continue;
    const bool heading = first && is_heading(line);
    first = false;
    if (heading) continue;
    const std::string place = name + ":" + std::to_string(number);
    NERITIC_TRY(const TableRow row, parse_row(line, place, format));
    NERITIC_TRY_STATUS(check_row(place, format, row, table.empty() ? nullptr : &table.back()));
    if (table.size() == kMaxTableRows)
      return bad_input("{}: more than {} rows", place, kMaxTableRows);
    table.push_back(row);
  }
  if (table.empty())
    return bad_input("{}: no row; accepted: rows of {},{}", name, format.x_name, format.y_name);
  return table;
}

Result<Table> read_table(const std::filesystem::path& path, const TableFormat& format) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_table(text, path.string(), format);
}

Status validate(std::span<const TableRow> rows, const std::string& name,
                const TableFormat& format) {
  if (rows.empty() || rows.size() > kMaxTableRows)
    return bad_input("{}: {} rows; accepted: 1 to {}", name, rows.size(), kMaxTableRows);
  for (std::size_t i = 0; i < rows.size(); ++i)
    NERITIC_TRY_STATUS(check_row(fmt::format("{}: row {}", name, i + 1), format, rows[i],
                                 i > 0 ? &rows[i - 1] : nullptr));
  return {};
}

double interpolate(std::span<const TableRow> rows, double x) {
  NERITIC_CHECK(!rows.empty(), "interpolating in a table without rows");
  if (std::isnan(x)) return x;
  const auto above = std::upper_bound(rows.begin(), rows.end(), x,
                                      [](double v, const TableRow& row) { return v < row.x; });
  if (above == rows.begin()) return rows.front().y;
  if (above == rows.end()) return rows.back().y;
  const TableRow &a = *(above - 1), &b = *above;
  return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

}  // namespace neritic::sonar
