// Compares the names on a page of columns and keys with a program's output.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

namespace neritic {

using Words = std::set<std::string>;

// The words in backticks in a table's rows, from one heading of the page to the next; of their
// first cells alone where so asked.
inline Words words_of(const std::string& page, const std::string& from, const std::string& to,
                      bool first_cells) {
  const std::size_t begin = page.find(from), end = page.find(to, begin);
  EXPECT_NE(begin, page.npos) << from;
  std::istringstream lines(page.substr(begin, end - begin));
  Words words;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    if (first_cells) line.resize(line.find('|', 2));
    for (std::size_t at = 0; (at = line.find('`', at)) != line.npos;) {
      const std::size_t close = line.find('`', at + 1);
      words.insert(line.substr(at + 1, close - at - 1));
      at = close + 1;
    }
  }
  return words;
}

inline void gather_keys(const nlohmann::json& json, Words& keys) {
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) keys.insert(key);
    if (value.is_structured()) gather_keys(value, keys);
  }
}

}  // namespace neritic
