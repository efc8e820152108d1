// A TOML file as a plain tree in which every key and value knows its file and line, so that an
// error can name them after includes were merged. Only toml.cpp knows the TOML library. Pure
// values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic {

struct TomlWhere {
  int file = 0;  // as parse_toml() was told
  int line = 0;  // from 1
};

struct TomlEntry;

struct TomlValue {
  enum class Kind { kBool, kInteger, kNumber, kString, kDate, kArray, kTable };
  Kind kind = Kind::kTable;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0.0;             // of kInteger too
  std::string text;                // of kString
  std::vector<TomlValue> items;    // of kArray
  std::vector<TomlEntry> entries;  // of kTable, by name
  TomlWhere where;

  bool is_table() const { return kind == Kind::kTable; }
  bool is_number() const { return kind == Kind::kNumber || kind == Kind::kInteger; }
  // An array of one table or more, and of nothing else.
  bool is_table_array() const;
  const TomlEntry* find(std::string_view key) const;
  TomlEntry* find(std::string_view key);
};

struct TomlEntry {
  std::string key;
  TomlWhere where;
  TomlValue value;
};

// The value on one short line, for messages.
std::string describe(const TomlValue& value);

// file_name stands in messages, file in every TomlWhere. Errors: "file:line: not TOML: ...". How
// long a text may be is the caller's to check; how deep it nests is bounded here.
Result<TomlValue> parse_toml(std::string_view text, const std::string& file_name, int file);

}  // namespace neritic
