#include "engine/scene/number_rows.hpp"

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::scene {
namespace {

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The text up to the separator, which is taken off the rest as well.
std::string_view take(std::string_view& rest, char separator) {
  const auto at = rest.find(separator);
  const std::string_view head = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view() : rest.substr(at + 1);
  return head;
}

bool is_heading(std::string_view row) {
  return !parse_number(trim(row.substr(0, row.find(','))));
}

Result<std::vector<double>> parse_row(std::string_view row, const std::string& place,
                                      const RowFormat& format) {
  std::vector<double> values;
  while (!row.empty() && values.size() <= format.max_columns) {
    const std::string_view word = trim(take(row, ','));
    const auto value = parse_number(word);
    if (!value || !(std::abs(*value) <= format.max_number))
      return refusal(place, fmt::format("'{}'", printable(word)),
                     fmt::format("a number of at most {:g}", format.max_number));
    values.push_back(*value);
  }
  const std::size_t n = values.size();
  if (n < format.min_columns || n > format.max_columns)
    return refusal(place,
                   fmt::format("{} numbers", n > format.max_columns
                                                 ? fmt::format("more than {}", format.max_columns)
                                                 : std::to_string(n)),
                   fmt::format("{}", format.columns));
  return values;
}

}  // namespace

Result<std::vector<NumberRow>> parse_rows(std::string_view text, const std::string& name,
                                          const RowFormat& format) {
  std::vector<NumberRow> rows;
  bool first = true;
  for (int line = 1; !text.empty(); ++line) {
    std::string_view rest = take(text, '\n');
    const std::string_view row = trim(take(rest, '#'));
    if (row.empty()) continue;
    const bool heading = first && is_heading(row);
    first = false;
    if (heading) continue;
    NERITIC_TRY(auto values, parse_row(row, fmt::format("{}:{}", name, line), format));
    if (rows.size() == format.max_rows)
      return refusal(fmt::format("{}:{}", name, line), "another row",
                     fmt::format("at most {} rows", format.max_rows));
    rows.push_back({line, std::move(values)});
  }
  if (rows.empty()) return refusal(name, "no row", fmt::format("rows of {}", format.columns));
  return rows;
}

Result<std::vector<NumberRow>> read_rows(const std::filesystem::path& path,
                                         const RowFormat& format) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_rows(text, path.string(), format);
}

}  // namespace neritic::scene
