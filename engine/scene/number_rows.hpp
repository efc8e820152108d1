// Rows of numbers from .csv files: copies, tracks, tables of two columns. Pure functions of the
// text; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::scene {

// The values that rows may hold. columns: the accepted form, in words, for messages.
struct RowFormat {
  std::size_t min_columns = 2, max_columns = 2;
  double max_number = 4e7;  // absolute
  std::size_t max_rows = 100000;
  const char* columns = "two numbers";
};

struct NumberRow {
  int line = 0;  // from 1
  std::vector<double> values;
};

// Commas between numbers; '#' starts a comment, and a first line of words is a heading. kBadInput
// names file and line. At least one row.
Result<std::vector<NumberRow>> parse_rows(std::string_view text, const std::string& name,
                                          const RowFormat& format);
Result<std::vector<NumberRow>> read_rows(const std::filesystem::path& path,
                                         const RowFormat& format);

}  // namespace neritic::scene
