// Tables of two columns of numbers from .csv files: gain over range, response over angle, sound
// speed over depth. Pure functions of the file; any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::sonar {

struct TableRow {
  double x = 0.0, y = 0.0;
};
using Table = std::vector<TableRow>;

// What a table's columns are called and may hold, for reading and for messages.
struct TableFormat {
  const char* x_name = "x";
  const char* y_name = "y";
  double x_min = -1e9, x_max = 1e9, y_min = -1e9, y_max = 1e9;
};

inline constexpr std::size_t kMaxTableRows = 100000;

// "x,y" a line; '#' starts a comment, a heading (a first row that is no number) is skipped. name
// stands in messages. kBadInput with name and line: not two numbers, out of range, x not rising,
// no row, too many rows.
Result<Table> parse_table(std::string_view text, const std::string& name,
                          const TableFormat& format);
Result<Table> read_table(const std::filesystem::path& path, const TableFormat& format);
// The same checks for rows that a caller already has (errors say "row 3").
Status validate(std::span<const TableRow> rows, const std::string& name, const TableFormat& format);

// Linear between rows, the end rows' values beyond them. NaN for NaN. At least one row.
double interpolate(std::span<const TableRow> rows, double x);

}  // namespace neritic::sonar
