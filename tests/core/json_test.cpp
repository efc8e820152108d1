#include "engine/core/json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

TEST(Json, NumbersAreWrittenAsAPersonWouldWriteThem) {
  const nlohmann::json value{{"float", 0.1f},
                             {"double", 0.1},
                             {"sum", 0.1 + 0.2},
                             {"third", 1.0 / 3.0},
                             {"list", {1.5f, 28.64789f}}};
  EXPECT_EQ(
      json_text(value, -1),
      R"({"double":0.1,"float":0.1,"list":[1.5,28.64789],"sum":0.3,"third":0.333333333333333})");
}

TEST(Json, AFloatReadsBackAsTheSameFloat) {
  for (const float value : {0.1f, 1e-30f, 16777217.0f, 3.4028235e38f, 1e-45f, -123.456f})
    EXPECT_EQ(static_cast<float>(tidy_number(value)), value);
}

TEST(Json, ADoubleKeepsFifteenDigits) {
  for (const double value : {100000.123456789, 6378137.000000125, 1e-300, -2.0 / 3.0})
    EXPECT_NEAR(tidy_number(value) / value, 1.0, 1e-14);
}

TEST(Json, WhatIsNotFiniteBecomesNullAndWhatIsNotTextIsReplaced) {
  const nlohmann::json value{{"depth_m", std::numeric_limits<double>::infinity()},
                             {"path", "a\xff"}};
  EXPECT_EQ(json_text(value, -1), "{\"depth_m\":null,\"path\":\"a\xef\xbf\xbd\"}");
}

TEST(Json, ErrorsSayWhere) {
  const auto parsed = parse_json("{\"a\": 1,\n \"b\" 2}");
  ASSERT_FALSE(parsed.ok());
  EXPECT_NE(parsed.error().message.find("line 2"), std::string::npos) << parsed.error().message;
  EXPECT_EQ(parsed.error().message.find("json.exception"), std::string::npos);
}

TEST(Json, NestingIsBounded) {
  const auto nested = [](int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']');
  };
  EXPECT_TRUE(parse_json(nested(kMaxJsonNesting)).ok());
  const auto deeper = parse_json(nested(kMaxJsonNesting + 1));
  ASSERT_FALSE(deeper.ok());
  EXPECT_NE(deeper.error().message.find("129"), std::string::npos) << deeper.error().message;
  EXPECT_TRUE(parse_json("\"" + std::string(500, '[') + "\"").ok()) << "brackets in a string";
}

TEST(Json, AFileEndsWithANewline) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_json(folder / "a.json", {{"a", 1}}).ok());
  EXPECT_EQ(read_text(folder / "a.json").value(), "{\n  \"a\": 1\n}\n");
}

}  // namespace
}  // namespace neritic
