// The tree that TOML text becomes: kinds, lines, and what is no TOML.
#include "engine/core/toml.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace neritic {
namespace {

std::string fault(std::string_view text) {
  const auto parsed = parse_toml(text, "f.toml", 0);
  return parsed.ok() ? "parsed" : parsed.error().message;
}

TEST(Toml, ValuesKeepTheirKindAndLine) {
  const auto parsed = parse_toml(
      "a = 1\nb = -0.5\nc = 'x'\nd = true\ne = 1979-05-27\nf = [1,\n 2]\n[g.h]\ni = inf\n", "f", 3);
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  using Kind = TomlValue::Kind;
  const std::vector<std::pair<std::string, Kind>> kinds{
      {"a", Kind::kInteger}, {"b", Kind::kNumber}, {"c", Kind::kString}, {"d", Kind::kBool},
      {"e", Kind::kDate},    {"f", Kind::kArray},  {"g", Kind::kTable}};
  ASSERT_EQ(parsed->entries.size(), kinds.size());
  for (int i = 0; i < 6; ++i) {
    const TomlEntry* entry = parsed->find(kinds[i].first);
    ASSERT_NE(entry, nullptr) << kinds[i].first;
    EXPECT_EQ(entry->value.kind, kinds[i].second) << entry->key;
    EXPECT_EQ(entry->where.line, i + 1) << entry->key;
    EXPECT_EQ(entry->where.file, 3);
  }
  EXPECT_EQ(parsed->find("a")->value.integer, 1);
  EXPECT_EQ(parsed->find("a")->value.number, 1.0);
  EXPECT_EQ(parsed->find("b")->value.number, -0.5);
  EXPECT_EQ(parsed->find("c")->value.text, "x");
  EXPECT_TRUE(parsed->find("d")->value.boolean);
  EXPECT_EQ(parsed->find("f")->value.items[1].where.line, 7);
  const TomlValue& inner = parsed->find("g")->value.find("h")->value;
  EXPECT_TRUE(std::isinf(inner.find("i")->value.number));
  EXPECT_EQ(inner.find("i")->where.line, 9);
  EXPECT_EQ(parsed->find("z"), nullptr);
}

TEST(Toml, WhatTheParserHasNoErrorForNamesItsLineToo) {
  const std::string expected = "not TOML: a key, a value or a table's name in brackets is expected";
  EXPECT_EQ(fault("a = 1\n[=]\nb = 2\n"), "f.toml:2: " + expected);
  for (const char* letter : {"\xc3\xb8", "\xe4\xb8\xad", "\xf0\x9f\x90\x9f", "\xc2\xa0"})
    EXPECT_EQ(fault("a = 1\nb = 1" + std::string(letter)).substr(0, 18), "f.toml:2: not TOML")
        << letter;
}

TEST(Toml, LettersBeyondAsciiAreTextInQuotesAndComments) {
  const auto parsed = parse_toml("a = 'h\xc3\xb8y' # \xe4\xb8\xad\n'\xc3\xb8' = 1\n", "f", 0);
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->find("a")->value.text, "h\xc3\xb8y");
  EXPECT_NE(parsed->find("\xc3\xb8"), nullptr);
}

}  // namespace
}  // namespace neritic
